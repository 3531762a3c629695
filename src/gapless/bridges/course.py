"""The inertial course of the speed: by how much the filter left it, and how well it keeps."""

from __future__ import annotations

import math
from typing import Final, NamedTuple, Self

from gapless.trip.recording import Array

STRETCH: Final = 8.0
"""Corrections are summed over so long [s]."""
PAUSE: Final = 2.0
"""A sum does not go on after a longer pause [s]."""
FORGET: Final = 40.0
"""Stretches after which one counts a third."""
USUAL, AS_MANY = 0.02, 3.0
"""A course is taken to need so much correction [m/s^2] until there are more stretches than this."""
LEAST: Final = 0.0075
"""And no less [m/s^2]."""
IN_SILENCE: Final = 4.0
"""Factor on it: without fixes, tilts go on growing."""


class Course(NamedTuple):
    """What corrections added to the speed.

    Parameters
    ----------
    begun : float
        [s]
    corrected : ndarray, shape (3,)
        Corrections of the velocity up to now, as the filter's trail sums them [m/s].
    time : float
        Up to now [s].
    gained : float
        What those since `begun` added [m/s].
    """

    begun: float
    corrected: Array
    time: float
    gained: float = 0.0

    def to(self, time: float, heading: Array, corrected: Array) -> Self:
        """Followed further.

        Parameters
        ----------
        time : float
            [s]
        heading : ndarray, shape (3,)
            Unit vector of the velocity.
        corrected : ndarray, shape (3,)

        Returns
        -------
        Course
        """
        gained = self.gained + float(heading @ (corrected - self.corrected))
        return self._replace(time=time, corrected=corrected, gained=gained)


class Drift(NamedTuple):
    """How much correction the course needs while GNSS speaks.

    Parameters
    ----------
    course : Course, optional
        The stretch that goes on.
    square, stretches : float
        Sum of squared mean corrections of stretches [m^2/s^4], and how many there were.
    """

    course: Course | None = None
    square: float = 0.0
    stretches: float = 0.0

    @property
    def rate(self) -> float:
        """What the course may gain in silence, as a standard deviation [m/s^2]."""
        mean = (self.square + AS_MANY * USUAL**2) / (self.stretches + AS_MANY)
        return IN_SILENCE * max(math.sqrt(mean), LEAST)

    def after(self, time: float, heading: Array, corrected: Array) -> Self:
        """With what was corrected up to now.

        Parameters
        ----------
        time : float
            [s]
        heading : ndarray, shape (3,)
            Unit vector of the velocity.
        corrected : ndarray, shape (3,)

        Returns
        -------
        Drift
        """
        if self.course is None or time - self.course.time > PAUSE:
            return self._replace(course=Course(time, corrected, time))
        course = self.course.to(time, heading, corrected)
        if time - course.begun < STRETCH:
            return self._replace(course=course)
        keep, mean = math.exp(-1.0 / FORGET), course.gained / (time - course.begun)
        new = Course(time, corrected, time)
        return type(self)(new, keep * self.square + mean**2, keep * self.stretches + 1.0)
