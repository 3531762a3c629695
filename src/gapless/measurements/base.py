"""What every sensor model shares: a reading in, an observation out, and the two roles."""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Protocol, Self

from gapless.inertial.belief import Belief
from gapless.trip.events import Motion, Reading
from gapless.trip.recording import Array


class Observation(NamedTuple):
    """z ~ H dx + v, v ~ N(0, R).

    Parameters
    ----------
    z : ndarray, shape (m,)
        Observed minus predicted.
    H : ndarray, shape (m, n)
    R : ndarray, shape (m, m)
    slow : ndarray, shape (m,), optional
        Standard deviation of the part of the error that many readings share, which R takes for noise.
    """

    z: Array
    H: Array
    R: Array
    slow: Array | None = None


class Sensor(Protocol):
    """Turns readings into observations."""

    def observe(self, belief: Belief, reading: Reading) -> Observation:
        """Observation of a reading that holds for the belief's time.

        Parameters
        ----------
        belief : Belief
        reading : Reading

        Returns
        -------
        Observation
        """
        ...


class Constraint(Protocol):
    """Observes without a reading: what the vehicle cannot do.

    Attributes
    ----------
    needs_heading : bool
        Whether it misleads a filter that may be wrong about its heading by a quarter turn.
    needs_samples : bool
        Whether it judges how the IMU shakes: what bridges a hole does not.
    parameters : tuple of str
        Attributes that may be tuned on the way.
    """

    needs_heading: ClassVar[bool]
    needs_samples: ClassVar[bool] = False
    parameters: ClassVar[tuple[str, ...]]

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Observation at the end of a tick, or None where the constraint does not hold.

        Parameters
        ----------
        belief : Belief
        motion : Motion

        Returns
        -------
        Observation or None
        """
        ...

    def hear(self, reading: Reading) -> None:
        """Learn from what a sensor said (a GNSS speed that tells stops from driving).

        Parameters
        ----------
        reading : Reading
        """
        ...

    def lost(self) -> None:
        """The IMU was silent: what was felt before does not lead up to what follows."""
        return

    def tuned(self, like: Self) -> Self:
        """An independent constraint with the same memory and the parameters of another.

        Parameters
        ----------
        like : Constraint
            Of the same kind.

        Returns
        -------
        Constraint
        """
        new = self.copy()
        for name in self.parameters:
            setattr(new, name, getattr(like, name))
        return new

    def copy(self) -> Self:
        """An independent constraint with the same memory.

        Returns
        -------
        Constraint
        """
        ...
