"""What a filter that takes a wandering error for noise does not know about its own error.

A receiver's error is noise in part only; the rest wanders for a minute (atmosphere, reflections), and
many fixes share it. A filter with a state for it must be told its size and pace exactly, or hangs on
to an offset that is not there. Here the filter weighs fixes as before, and the response of its own
position to the wander is followed beside it: consider covariance analysis (Schmidt 1966; Tapley,
Schutz and Born 2004, sec. 6), for the position that a fix looks at. That is the antenna's, y = H x, and
all that is needed of the filter is its gain there: H K = H P H' (H P H' + R)^-1, with P before the
update, which is H P H' R^-1 with P after it. What it finds is added to the variances that are stated of
the box, never to the covariance that decides gains.

I - H K = R (H P H' + R)^-1 never lengthens a vector in the norm of R^-1, so the response cannot run away,
whatever lies between two updates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from gapless._numba import inline, kernel
from gapless.filters.update import cholesky, solve
from gapless.trip.recording import Array


@inline
def _times(a: Array, b: Array) -> Array:
    """A B', three by three."""
    c = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                c[i, j] += a[i, k] * b[j, k]
    return c


@kernel
def respond(
    p: Array, r: Array, slow: Array, decay: float, response: Array, shared: Array
) -> tuple[Array, Array]:
    """Moments after one update with z = e + slow w + v.

    Parameters
    ----------
    p : ndarray, shape (3, 3)
        H P H', of what is observed after the update: the gain there is p r^-1.
    r : ndarray, shape (3, 3)
        Covariance of the observation, as it counted.
    slow : ndarray, shape (3,)
        Standard deviation of the part that wanders.
    decay : float
        Of w since the last update.
    response, shared : ndarray, shape (3, 3)
        As in `Wander`, before.

    Returns
    -------
    response, shared : ndarray, shape (3, 3)
        With A = I - H K and B = H K diag(slow): A response A' + B B' - A shared B' - B shared' A' and
        A shared - B, shared decayed.
    """
    low, rest, push, turned = cholesky(r), np.zeros((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        gain = p[i].copy()
        solve(low, gain)
        rest[i, i] = 1.0
        for j in range(3):
            rest[i, j] -= gain[j]
            push[i, j] = gain[j] * slow[j]
            turned[j, i] = shared[i, j] * decay
    kept = _times(rest, turned)
    cross = _times(kept, push)
    new = _times(_times(rest, response), rest) + _times(push, push) - cross - cross.T
    return new, kept - push


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
        """Follow the filter through one update.

        Parameters
        ----------
        time : float
            [s]
        p, r, slow
            As for `respond`.
        """
        decay = math.exp(-(time - self.time) / self.tau)
        self.response, self.shared = respond(p, r, slow, decay, self.response, self.shared)
        self.time = time

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place).

        Returns
        -------
        Wander
        """
        return type(self)(self.tau, self.response, self.shared, self.time)
