"""The strapdown alone: a nominal state carried on by increments, without covariance or correction."""

from __future__ import annotations

import numpy as np

from gapless._numba import kernel
from gapless.attitude import matrix_rows
from gapless.inertial.mechanise import local_earth, mechanise
from gapless.trip.recording import Array

STATE = 10
"""Latitude, longitude [rad], height [m], v_n(3) [m/s], q_nb(4)."""


@kernel
def coast(x: Array, before: Array, felt: Array, dt: float) -> Array:
    """Navigation state after one more interval.

    Parameters
    ----------
    x : ndarray, shape (10,)
        State at its beginning: lat, lon, height, v_n, q_nb; not changed.
    before : ndarray, shape (7,)
        Length of the interval before [s], its mean body rate [rad/s] and specific force [m/s^2]:
        for coning and sculling; zeros where there was none.
    felt : ndarray, shape (6,)
        Mean body rate and specific force over the interval.
    dt : float
        Its length [s].

    Returns
    -------
    ndarray, shape (10,)
    """
    v, q = (x[3], x[4], x[5]), (x[6], x[7], x[8], x[9])
    local = local_earth(x[0], x[2], v, dt)
    w, f = (felt[0] * dt, felt[1] * dt, felt[2] * dt), (felt[3] * dt, felt[4] * dt, felt[5] * dt)
    length = before[0]
    last_w = (before[1] * length, before[2] * length, before[3] * length)
    last_f = (before[4] * length, before[5] * length, before[6] * length)
    none = (0.0, 0.0, 0.0)
    lat, lon, height, v1, q1, _ = mechanise(
        x[0], x[1], x[2], v, q, matrix_rows(q), local, none, w, f, last_w, last_f, length, dt
    )
    return np.array([lat, lon, height, v1[0], v1[1], v1[2], q1[0], q1[1], q1[2], q1[3]])
