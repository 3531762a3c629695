"""A car that stands: what its gyros say is their zero's, and its fixes have their error in common."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless.trip.recording import Array
from gapless.units import DEG
from gapless.witnesses.testimony import INSISTS

ZERO: Final = 0.1 * DEG
"""A gyro's zero that is off by so much has moved [rad/s]."""
LATELY: Final = 5.0
"""What a receiver drifted off by while the car stood shows so soon after it drives off [s]."""
APART: Final = 1.0
"""Words of rest less apart are of one rest [s]."""
SHARED: Final = 2.0
"""Fixes of a standing car less apart are one [s]."""


@dataclass
class Rest:
    """Of the present rest, or the last.

    Parameters
    ----------
    stood : float
        Since when the car has stood [s].
    rested : tuple
        Since when words of rest have come, and the last of them [s], sum and number of rates [rad/s].
    """

    stood: float = math.inf
    rested: tuple[float, float, Array, int] = field(default_factory=lambda: (0.0, -math.inf, np.zeros(3), 0))

    def lately(self, time: float) -> bool:
        """Whether the car stood a moment ago.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        return time - self.rested[1] < LATELY

    def drifts(self, time: float, rate: Array, known: Array, seen: bool) -> Array | None:
        """Mean rate of a car that GNSS sees stand, where it is more than a gyro's zero may be.

        Parameters
        ----------
        time : float
            [s]
        rate : ndarray, shape (3,)
            Left of the gyros' at rest [rad/s].
        known : ndarray, shape (3,)
            Standard deviations of the gyros' zeros [rad/s].
        seen : bool
            Whether GNSS is with the filter.

        Returns
        -------
        ndarray, shape (3,), or None
            [rad/s], once in `INSISTS` seconds.
        """
        if not seen or time - self.rested[1] > APART:
            self.rested = time, time, np.zeros(3), 0
        since, _, total, n = self.rested
        self.rested = since, time, total + rate, n + 1
        if time - since < INSISTS:
            return None
        mean = self.rested[2] / self.rested[3]
        self.rested = time, time, np.zeros(3), 0
        return mean if bool((np.abs(mean) > ZERO + 4.0 * known).any()) else None

    def shared(self, time: float, rests: bool, silenced: bool) -> float:
        """Factor on the variance of a fix: those of a standing car have their error in common.

        Parameters
        ----------
        time : float
            [s]
        rests : bool
            Whether it stands.
        silenced : bool
            Whether fixes are silenced: one that was must fit by its own word.

        Returns
        -------
        float
            1 plus the seconds that it has stood, over `SHARED`: all fixes of a rest together count as a few.
        """
        self.stood = min(self.stood, time) if rests else math.inf
        return 1.0 + (time - self.stood) / SHARED if rests and not silenced else 1.0

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place)."""
        return type(self)(self.stood, self.rested)
