"""Accelerations that are felt as GNSS sees them, but from another side: what is askew, and by how much.

Changes of velocity as a receiver saw and as sensors felt them have one length each, and one angle between
them. Where the lengths agree and the angle stays, no noise and no receiver makes that: either the heading is
wrong, and then the course is not where the car points, or the box was turned on its stand, and then it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless.trip.recording import Array
from gapless.units import DEG

MEMORY: Final = 20.0
"""Time constant with which changes are forgotten [s]."""
ANGLE: Final = 12.0 * DEG
"""Less than this is left to the filter [rad]."""
COHERENT: Final = 0.93
"""Least share of the changes that one angle explains."""
ENOUGH: Final = 25.0
"""Least sum of squares of changes [m^2/s^2]."""
SPAN: Final = (1.4, 3.1)
"""Changes over so long are compared [s]."""
POINTED: Final = 0.5
"""The course lies where the car points if it is off by less than this share of the angle."""


@dataclass
class Askew:
    """Sums over changes of velocity, the recent ones heavier.

    Parameters
    ----------
    sums : ndarray, shape (4,)
        Of felt . said, felt x said, said^2, felt^2 [m^2/s^2]; replaced, never changed.
    time : float
        Of the last change [s].
    """

    sums: Array = field(default_factory=lambda: np.zeros(4))
    time: float = -math.inf

    def hear(self, time: float, said: Array, felt: Array) -> None:
        """Take in a change of velocity.

        Parameters
        ----------
        time : float
            [s]
        said, felt : ndarray, shape (2,)
            North and east, by the receiver and by the sensors [m/s].
        """
        kept = math.exp(-(time - self.time) / MEMORY)
        dot, cross = float(felt @ said), float(felt[0] * said[1] - felt[1] * said[0])
        self.sums = kept * self.sums + np.array([dot, cross, said @ said, felt @ felt])
        self.time = time

    @property
    def angle(self) -> float:
        """By how much what is felt must be turned clockwise [rad]; 0 where that is not clear."""
        dot, cross, said, felt = self.sums.tolist()
        if min(said, felt) < ENOUGH or math.hypot(dot, cross) < COHERENT * math.sqrt(said * felt):
            return 0.0
        if not 0.6 < said / felt < 1.6:
            return 0.0
        found = math.atan2(cross, dot)
        return found if abs(found) > ANGLE else 0.0

    def forget(self) -> None:
        """Start anew."""
        self.sums, self.time = np.zeros(4), -math.inf

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.sums, self.time)


def pointed(course: float, ahead: float, angle: float) -> bool:
    """Whether the car points along its course, so that it is the box and not the heading that is askew.

    Parameters
    ----------
    course, ahead : float
        Direction of the velocity, and of the car by its heading [rad].
    angle : float
        By which accelerations are askew [rad].

    Returns
    -------
    bool
    """
    off = math.remainder(course - ahead, 2.0 * math.pi)
    return abs(off) < POINTED * abs(angle)
