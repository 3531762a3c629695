"""Columns in time made white, where their errors are noise, a Gauss-Markov process and a random walk."""

from __future__ import annotations

import math

import numpy as np

from gapless._numba import kernel
from gapless.trip.recording import Array


@kernel
def whiten(
    time: Array, noise: Array, wander: float, lasting: float, walk: float, columns: Array
) -> tuple[Array, float]:
    """The product of columns with the inverse of a Cholesky factor, in as many steps as there are rows.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Increasing [s].
    noise : ndarray, shape (n,)
        Variance of the white part.
    wander, lasting : float
        Standard deviation and correlation time [s] of the Gauss-Markov part.
    walk : float
        Density of the random walk, which is zero at first [1/sqrt(s)].
    columns : ndarray, shape (n, m)

    Returns
    -------
    whitened : ndarray, shape (n, m)
        Innovations of a Kalman filter of two states, over their deviations.
    log_det : float
        Logarithm of the determinant of the covariance.
    """
    n, m = columns.shape
    white, mean, log_det = np.empty((n, m)), np.zeros((2, m)), 0.0
    p00, p01, p11 = wander * wander, 0.0, 0.0
    for k in range(n):
        if k:
            dt = time[k] - time[k - 1]
            decay = math.exp(-dt / lasting)
            p00 = p00 * decay * decay + wander * wander * (1.0 - decay * decay)
            p01 *= decay
            p11 += walk * walk * dt
            for j in range(m):
                mean[0, j] *= decay
        g0, g1 = p00 + p01, p01 + p11
        s = g0 + g1 + noise[k]
        log_det += math.log(s)
        root = math.sqrt(s)
        for j in range(m):
            off = columns[k, j] - mean[0, j] - mean[1, j]
            white[k, j] = off / root
            mean[0, j] += g0 / s * off
            mean[1, j] += g1 / s * off
        p00, p01, p11 = p00 - g0 * g0 / s, p01 - g0 * g1 / s, p11 - g1 * g1 / s
    return white, log_det
