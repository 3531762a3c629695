"""Which way wheels roll that count without a sign: a hypothesis, moved by what the filter felt.

A sensor that counts teeth says +2.5 m/s whichever way the car goes. That it reverses is told by the
likelihood of each sign under the filter, summed over readings; it can change only where the wheels stand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from gapless.measurements.base import Observation

PRIOR: Final = -2.0
"""Log odds that a car which stood drives off backwards."""
MOST: Final = 6.0
"""Log odds beyond which nothing is added."""
SHARE: Final = 0.3
"""Readings that follow each other share their errors: so much of each is news."""
STANDS: Final = 0.15
"""Below this the wheels may change their way [m/s]."""
NEGATIVE: Final = -0.2
"""A reading below this is that of a sensor with a sign [m/s]."""


@dataclass
class Sign:
    """Log odds that wheels without a sign roll backwards.

    Parameters
    ----------
    odds : float
    signed : bool
        Whether the sensor was seen to have a sign.
    """

    odds: float = PRIOR
    signed: bool = False

    def settles(self, speed: float, ahead: Observation, back: Observation, hph: float) -> Observation:
        """The observation that both hypotheses make together.

        Parameters
        ----------
        speed : float
            Reading [m/s].
        ahead, back : Observation
            Of the reading, and of the reading with the other sign.
        hph : float
            Variance of the filter's forward speed [m^2/s^2].

        Returns
        -------
        Observation
            One of them where the odds are clear; else the mean of both, and R that holds both.
        """
        self.signed |= speed < NEGATIVE
        if self.signed:
            return ahead
        if speed < STANDS:
            self.odds = PRIOR
            return ahead
        s = float(ahead.R[0, 0]) + hph
        news = SHARE * (float(ahead.z[0]) ** 2 - float(back.z[0]) ** 2) / (2.0 * s)
        self.odds = max(-MOST, min(MOST, self.odds + max(-1.0, min(1.0, news))))
        p = 1.0 / (1.0 + math.exp(-2.0 * self.odds))
        z = (1.0 - p) * ahead.z + p * back.z
        spread = p * (1.0 - p) * float((ahead.z - back.z)[0]) ** 2
        return Observation(z, back.H if p > 0.5 else ahead.H, ahead.R + np.full((1, 1), spread))

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.odds, self.signed)
