"""One outage, and what many of them leave of the fixes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gapless.scenarios.effects import SILENT, Effect
from gapless.trip.recording import Array, Gnss, Recording

Drive = Recording | float
"""A recording, or its duration [s] where no plan has to look into it."""


def duration_of(drive: Drive) -> float:
    """Duration of a drive.

    Parameters
    ----------
    drive : Recording or float

    Returns
    -------
    float
        [s]
    """
    return drive.duration if isinstance(drive, Recording) else drive


@dataclass(frozen=True, order=True)
class Outage:
    """A stretch in which something happens to GNSS.

    Parameters
    ----------
    start, end : float
        [s] after the first IMU sample; epochs whose logged time lies in [start, end) are concerned.
    effect : Effect
        They are withheld if nothing else is said.
    """

    start: float
    end: float
    effect: Effect = SILENT

    @property
    def length(self) -> float:
        """Duration [s]."""
        return self.end - self.start

    @property
    def until(self) -> float:
        """End of what is scored [s]: the fixes after it are as logged."""
        return self.end + self.effect.lasting

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """The outage itself, if it begins within the recording.

        Parameters
        ----------
        drive : Recording or float

        Returns
        -------
        tuple of Outage
        """
        return (self,) if self.start < duration_of(drive) else ()

    def __str__(self) -> str:
        return f"{seconds(self.start)}:{seconds(self.end)}{suffix(self.effect)}"


def seconds(value: float) -> str:
    """A number as a plan writes it: short, and to the microsecond.

    Parameters
    ----------
    value : float

    Returns
    -------
    str
    """
    return f"{round(value, 6):.12g}"


def suffix(effect: Effect) -> str:
    """The end of a plan's text that names its effect.

    Parameters
    ----------
    effect : Effect

    Returns
    -------
    str
        "" for the usual one.
    """
    return "" if effect == SILENT else f",effect={effect}"


def withheld(time: Array, outages: Sequence[Outage], start: float) -> NDArray[np.bool_]:
    """Which logged times lie in an outage.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Logged stamps [s].
    outages : sequence of Outage
    start : float
        Time of the first IMU sample [s].

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    mask = np.zeros(len(time), bool)
    for outage in outages:
        mask |= (time >= start + outage.start) & (time < start + outage.end)
    return mask


def withhold(gnss: Gnss, outages: Sequence[Outage], start: float) -> Gnss:
    """What the receiver would have logged through the outages.

    Parameters
    ----------
    gnss : Gnss
    outages : sequence of Outage
    start : float
        Time of the first IMU sample [s].

    Returns
    -------
    Gnss
        Where the effect is silence the epochs are gone, position and velocity both.
    """
    for outage in sorted(outages):
        gnss = outage.effect.apply(gnss, start + outage.start, start + outage.end)
    return gnss
