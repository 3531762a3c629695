"""What doubt about a receiver's clock makes of the position.

A clock that is off by theta shows the car where it was, or will be: a fix is wrong by the velocity times
theta, and dead reckoning by velocities of the same clock goes along with that. An offset is constant, so
nothing averages it, and it is no state. As in `gapless.filters.consider`, what one second of it would do to
the position is followed beside the filter; times the deviations that were decided it is added to what is
stated, never to what decides gains.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, NamedTuple, Self

import numpy as np

from gapless._numba import kernel
from gapless.filters.update import cholesky, solve
from gapless.trip.recording import Array

SILENT: Final = 5.0
"""After so long without fixes a change of velocity says nothing of theirs [s]."""


class Doubt(NamedTuple):
    """Standard deviations of stamps against the IMU clock.

    Parameters
    ----------
    common : float
        Of the offset that positions and velocities share [s].
    apart : float
        Of the difference between the two [s].
    wobble : float
        Of what of it changes on the way [s].
    lasting : float
        Correlation time of the wobble [s].
    """

    common: float = 0.0
    apart: float = 0.0
    wobble: float = 0.0
    lasting: float = 10.0


SURE: Final = Doubt()
"""A clock that is known."""


@kernel
def lean(
    p: Array, row: int, r: Array, v: Array, change: Array, decay: float, constant: Array, moved: Array
) -> tuple[Array, Array]:
    """Responses after one fix.

    Parameters
    ----------
    p : ndarray, shape (row * row,)
        Covariance of what was observed after the update, in its first three rows: the gain is p r^-1.
    row : int
    r : ndarray, shape (3, 3)
        Covariance of the observation, as it counted.
    v, change : ndarray, shape (3,)
        Velocity, and by how much it changed since the last fix [m/s].
    decay : float
        Of the wobble since then.
    constant : ndarray, shape (2, 3)
        Metres per second of what is common, and of what sets positions apart.
    moved : ndarray, shape (4, 3)
        E[e e'] of the error that a wobble of unit variance caused so far, then E[e w'].

    Returns
    -------
    constant, moved : ndarray
        With A = I - K: A (g + change) + K v, A g + K v; A E A' + b b' + c b' + b c' and b + c with
        b = K v and c = A E[e w'] decayed.
    """
    low, rest = cholesky(r), np.zeros((3, 3))
    for i in range(3):
        gain = p[i * row : i * row + 3].copy()
        solve(low, gain)
        rest[i, i] = 1.0
        for j in range(3):
            rest[i, j] -= gain[j]
    new, turned = np.zeros((2, 3)), np.zeros((4, 3))
    push, kept = np.empty(3), np.zeros(3)
    for i in range(3):
        push[i] = v[i]
        for j in range(3):
            push[i] -= rest[i, j] * v[j]
            kept[i] += rest[i, j] * moved[3, j] * decay
            new[0, i] += rest[i, j] * (constant[0, j] + change[j])
            new[1, i] += rest[i, j] * constant[1, j]
        new[0, i] += push[i]
        new[1, i] += push[i]
    for i in range(3):
        for j in range(3):
            turned[i, j] = push[i] * push[j] + kept[i] * push[j] + push[i] * kept[j]
            for k in range(3):
                for m in range(3):
                    turned[i, j] += rest[i, k] * moved[k, m] * rest[j, m]
        turned[3, i] = kept[i] + push[i]
    return new, turned


@kernel
def swung(constant: Array, moved: Array, common: float, apart: float, wobble: float) -> Array:
    """Covariance of a position for stamps in doubt.

    Parameters
    ----------
    constant : ndarray, shape (2, 3)
    moved : ndarray, shape (4, 3)
        As of `lean`.
    common, apart, wobble : float
        As of `Doubt` [s].

    Returns
    -------
    ndarray, shape (3, 3)
        [m^2]
    """
    total = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            total[i, j] = common**2 * constant[0, i] * constant[0, j] + wobble**2 * moved[i, j]
            total[i, j] += apart**2 * constant[1, i] * constant[1, j]
    return total


@dataclass
class StampDoubt:
    """Response of the position to stamps that are off.

    Parameters
    ----------
    constant : ndarray, shape (2, 3)
        As in `lean`.
    moved : ndarray, shape (4, 3)
        As in `lean`.
    v_n : ndarray, shape (3,)
        Velocity at the last fix [m/s].
    time : float
        Of the last fix [s].
    """

    constant: Array = field(default_factory=lambda: np.zeros((2, 3)))
    moved: Array = field(default_factory=lambda: np.zeros((4, 3)))
    v_n: Array = field(default_factory=lambda: np.zeros(3))
    time: float = -math.inf

    def hear(self, time: float, p: Array, row: int, r: Array, v_n: Array, lasting: float) -> None:
        """Follow the filter through one fix.

        Parameters
        ----------
        time : float
            [s]
        p, row, r
            As for `lean`.
        v_n : ndarray, shape (3,)
            Velocity [m/s].
        lasting : float
            Correlation time of the wobble [s].
        """
        since = time - self.time
        change = v_n - self.v_n if since < SILENT else np.zeros(3)
        decay = math.exp(-since / lasting)
        self.constant, self.moved = lean(p, row, r, v_n, change, decay, self.constant, self.moved)
        self.v_n, self.time = v_n.copy(), time

    def stated(self, doubt: Doubt) -> Array:
        """Covariance of the position for it.

        Parameters
        ----------
        doubt : Doubt

        Returns
        -------
        ndarray, shape (3, 3)
            [m^2]
        """
        return swung(self.constant, self.moved, doubt.common, doubt.apart, doubt.wobble)

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place).

        Returns
        -------
        StampDoubt
        """
        return type(self)(self.constant, self.moved, self.v_n, self.time)
