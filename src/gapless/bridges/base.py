"""The role of a bridge: a sensor that learns while GNSS speaks and speaks while GNSS is silent."""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Protocol, Self

from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation
from gapless.trip.events import ImuBlock, Motion, Reading
from gapless.trip.exhibits import Exhibit
from gapless.trip.solution import Decision


class Saying(NamedTuple):
    """What a bridge says.

    Parameters
    ----------
    channel : str
        Name of its innovations in the journal.
    observation : Observation
    """

    channel: str
    observation: Observation


class Bridge(Protocol):
    """What a navigator asks of a bridge.

    It is copied with the navigator, often: `copy` must be cheap. It may not look at a clock, or the
    same data would give other bits elsewhere.

    Attributes
    ----------
    reach : float
        Seconds of past velocity that the belief's trail must hold for it.
    """

    reach: ClassVar[float]

    def feel(self, block: ImuBlock) -> None:
        """Take in the samples that were just propagated.

        Parameters
        ----------
        block : ImuBlock
        """
        ...

    def hear(self, belief: Belief, reading: Reading, used: bool) -> None:
        """Learn from a reading.

        Parameters
        ----------
        belief : Belief
            After the update.
        reading : Reading
        used : bool
            False where the filter rejected it: GNSS speaks, and nothing is to be learned from it.
        """
        ...

    def tick(self, belief: Belief, motion: Motion) -> tuple[Saying, ...]:
        """What it has to say at the end of a tick; nothing while GNSS speaks, nothing untrained.

        Parameters
        ----------
        belief : Belief
        motion : Motion

        Returns
        -------
        tuple of Saying
        """
        ...

    def begin_with(self, other: Self) -> None:
        """Know from the start what another has learned of the same drive: for post-processing only.

        Parameters
        ----------
        other : Bridge
            Of the same kind.
        """
        ...

    def lost(self) -> None:
        """The IMU was silent, or the filter far astray: what went before does not lead up to what follows."""
        ...

    def decisions(self, start: float) -> tuple[Decision, ...]:
        """What it learned and when, for the summary.

        Parameters
        ----------
        start : float
            Time of the first IMU sample [s].

        Returns
        -------
        tuple of Decision
        """
        ...

    def exhibit(self) -> Exhibit | None:
        """What it has to show besides, for the report; None where that is nothing.

        Returns
        -------
        Exhibit or None
        """
        ...

    def learned(self) -> object | None:
        """What it has learned last, to be saved; None where that is nothing.

        Returns
        -------
        object or None
            A fitted estimator.
        """
        ...

    def copy(self) -> Self:
        """An independent bridge with the same memory.

        Returns
        -------
        Bridge
        """
        ...
