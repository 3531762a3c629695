"""What standing still says: no velocity, no rotation but the earth's."""

from __future__ import annotations

import numpy as np

from gapless import earth
from gapless._numba import kernel
from gapless.attitude import matrix_rows
from gapless.trip.recording import Array


@kernel
def zero_velocity(x: Array, n: int, rate: Array, sd: float, sd_rate: float) -> tuple[Array, Array, Array]:
    """Velocity and angular rate of a vehicle at rest.

    Parameters
    ----------
    x : ndarray
        Nominal state.
    n : int
        Number of error states.
    rate : ndarray, shape (3,)
        Mean corrected body rate since the last update [rad/s].
    sd, sd_rate : float
        Standard deviation of velocity [m/s] and of rate [rad/s].

    Returns
    -------
    z : ndarray, shape (6,)
        -v; the rate left after earth rate, which is the gyro bias's error.
    H : ndarray, shape (6, n)
    R : ndarray, shape (6, 6)
        Groves (2013), sec. 15.3.
    """
    c = np.array(matrix_rows((x[6], x[7], x[8], x[9]))).reshape(3, 3)
    north, down = earth.RATE * np.cos(x[0]), -earth.RATE * np.sin(x[0])
    z, h, r = np.empty(6), np.zeros((6, n)), np.zeros((6, 6))
    for i in range(3):
        z[i] = -x[3 + i]
        z[3 + i] = rate[i] - (c[0, i] * north + c[2, i] * down)
        h[i, 3 + i] = 1.0
        h[3 + i, 9 + i] = 1.0
        r[i, i] = sd * sd
        r[3 + i, 3 + i] = sd_rate * sd_rate
    return z, h, r
