"""What a filter that takes a wandering error for noise does not know about its own error.

A receiver's error is noise in part only; the rest wanders for a minute (atmosphere, reflections), and
many fixes share it. A filter with a state for it must be told its size and pace exactly, or hangs on
to an offset that is not there. Here the filter weighs fixes as before, and the response of its own
position to the wander is followed beside it: consider covariance analysis (Schmidt 1966; Tapley,
Schutz and Born 2004, sec. 6), for the three states that a fix looks at. What it finds is added to the
variances that are stated, never to the covariance that decides gains.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from gapless.recording import Array


@dataclass
class Wander:
    """Response of an estimate to a first-order Gauss-Markov error of its observations.

    Parameters
    ----------
    tau : float
        Correlation time of the error [s].
    response : ndarray, shape (3, 3)
        E[e e'] of the error e that the wander w caused so far [m^2].
    shared : ndarray, shape (3, 3)
        E[e w'], w of unit variance in each axis [m].
    time : float
        Of the last observation [s].
    """

    tau: float = 60.0
    response: Array = field(default_factory=lambda: np.zeros((3, 3)))
    shared: Array = field(default_factory=lambda: np.zeros((3, 3)))
    time: float = -math.inf

    def hear(self, time: float, p: Array, r: Array, slow: Array) -> None:
        """Follow the filter through one update with z = e + slow w + v.

        Parameters
        ----------
        time : float
            [s]
        p : ndarray, shape (3, 3)
            Covariance of what is observed, after the update; the gain is then p r^-1.
        r : ndarray, shape (3, 3)
            Covariance of the observation, as it counted.
        slow : ndarray, shape (3,)
            Standard deviation of the part that wanders.
        """
        shared = self.shared * math.exp(-(time - self.time) / self.tau)
        gain = p @ np.linalg.inv(r)
        rest, push = np.eye(3) - gain, gain * slow
        both = rest @ shared @ push.T
        self.response = rest @ self.response @ rest.T + push @ push.T - both - both.T
        self.shared, self.time = rest @ shared - push, time

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place).

        Returns
        -------
        Wander
        """
        return type(self)(self.tau, self.response, self.shared, self.time)
