"""The hot kernel: a block of IMU samples through the strapdown and its covariance.

What a sample leaves behind for the next one (increments for coning, sums for a decimated
covariance, sums for the next tick) lives in `memory`, never in the block: cutting a block in two
gives the same bits.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows
from gapless.inertial.covariance import add_noise, apply, apply_extras, apply_to_vector, fold
from gapless.inertial.dynamics import transition
from gapless.inertial.layout import NAV, ROW
from gapless.inertial.mechanise import local_earth, mechanise
from gapless.trip.recording import Array

LAT, LON, HEIGHT, VEL, QUAT, GYRO_BIAS, ACCEL_BIAS, EXTRA = 0, 1, 2, 3, 6, 10, 13, 16
"""Indices of the nominal state: lat, lon, h, v_n(3), q_nb(4), gyro bias(3), accel bias(3), extras."""
TIME, PREV_THETA, PREV_VEL, PREV_DT = 0, 1, 4, 7
COV_DT, COV_F, COV_W, COV_A = 8, 9, 12, 15
COV_START = 18
TICK_DT, TICK_W, TICK_F = 28, 29, 32
MEMORY_SIZE: Final = 35
"""Indices of `memory`: clock, previous increments; sums since the last covariance (specific
force in NED, rate and specific force as measured), the navigation state there, which only cubature
keeps, and sums since the last tick (corrected)."""
ROUND: Final = 1e-7
"""Slack [s] that keeps a sum of sample intervals from missing its period by a rounding error."""


@inline
def _load3(a: Array, i: int) -> tuple[Any, Any, Any]:
    return a[i], a[i + 1], a[i + 2]


@inline
def _store3(a: Array, i: int, v: tuple[Any, Any, Any]) -> None:
    a[i], a[i + 1], a[i + 2] = v


@kernel
def propagate(
    x: Array,
    memory: Array,
    width: int,
    p: Array,
    scratch: Array,
    error: Array,
    offsets: NDArray[np.int64],
    noise: Array,
    time: Array,
    dt: Array,
    dtheta: Array,
    dvel: Array,
    first: int,
    last: int,
    period: float,
    tick: float,
    flush: bool,
) -> int:
    """Integrate samples first..last-1, or up to the end of the running tick.

    Parameters
    ----------
    x : ndarray, shape (16 + extras,)
        Nominal state, changed in place.
    memory : ndarray, shape (35,)
        What the last sample left behind, changed in place.
    width : int
        Columns of the covariance in use (`Layout.width`).
    p : ndarray, shape (ROW * ROW,)
        Covariance, changed in place.
    scratch : ndarray, shape (2, ROW * ROW)
        Working space.
    error : ndarray, shape (width,) or (0,)
        Open-loop error estimate, propagated with the covariance; empty when feedback is used.
    offsets : ndarray of int, shape (7,)
        `Layout.offsets`.
    noise : ndarray, shape (7,)
        As for `add_noise`, then 1 / tau of gyro and accelerometer bias [1/s].
    time, dt : ndarray, shape (n,)
        End and length of each sample's interval [s].
    dtheta, dvel : ndarray, shape (n, 3)
        Increments [rad], [m/s].
    first, last : int
        Which samples.
    period : float
        Covariance at least this far apart [s]; 0 at every sample.
    tick : float
        Stop at the first sample that completes so much time since the last stop [s].
    flush : bool
        Bring the covariance up to the last sample (a tick's end always does): for an observation
        that is due there, never for the end of a block, or blocks would change the bits.

    Returns
    -------
    int
        Index of the next sample.
    """
    scales = max(offsets[0], offsets[1]) >= 0
    gs, as_, gd = offsets[0] + 1, offsets[1] + 1, offsets[2] + 1
    lat, lon, height, v = x[0], x[1], x[2], _load3(x, VEL)
    q = (x[6], x[7], x[8], x[9])
    c = matrix_rows(q)
    bg, ba = _load3(x, GYRO_BIAS), _load3(x, ACCEL_BIAS)
    dg = _load3(x, gd) if gd > 0 else (0.0, 0.0, 0.0)
    prev_theta, prev_vel, prev_dt = _load3(memory, PREV_THETA), _load3(memory, PREV_VEL), memory[PREV_DT]
    cov_dt, tick_dt = memory[COV_DT], memory[TICK_DT]
    sum_f, sum_w, sum_a = _load3(memory, COV_F), _load3(memory, COV_W), _load3(memory, COV_A)
    tick_w, tick_f = _load3(memory, TICK_W), _load3(memory, TICK_F)
    driven = max(offsets[0], offsets[1], offsets[2]) >= 0
    decay = (noise[5], noise[6])
    m, phi, tail = scratch[0], scratch[1, : NAV * ROW], scratch[1, NAV * ROW : (NAV + 1) * ROW]
    phi[:], tail[:] = 0.0, 1.0
    k = first
    while k < last:
        h = dt[k]
        wx, wy, wz = dtheta[k, 0], dtheta[k, 1], dtheta[k, 2]
        fx, fy, fz = dvel[k, 0], dvel[k, 1], dvel[k, 2]
        if scales:
            if gs > 0:
                wx, wy, wz = wx * (1.0 + x[gs]), wy * (1.0 + x[gs + 1]), wz * (1.0 + x[gs + 2])
            if as_ > 0:
                fx, fy, fz = fx * (1.0 + x[as_]), fy * (1.0 + x[as_ + 1]), fz * (1.0 + x[as_ + 2])
        w = (wx - bg[0] * h, wy - bg[1] * h, wz - bg[2] * h)
        f = (fx - ba[0] * h, fy - ba[1] * h, fz - ba[2] * h)
        c0 = c
        local = local_earth(lat, height, v, h)
        lat, lon, height, v1, q, f_n = mechanise(
            lat, lon, height, v, q, c, local, dg, w, f, prev_theta, prev_vel, prev_dt, h
        )
        prev_theta, prev_vel, prev_dt = w, f, h
        cov_dt += h
        tick_dt += h
        sum_f = (sum_f[0] + f_n[0], sum_f[1] + f_n[1], sum_f[2] + f_n[2])
        sum_w = (sum_w[0] + dtheta[k, 0], sum_w[1] + dtheta[k, 1], sum_w[2] + dtheta[k, 2])
        sum_a = (sum_a[0] + dvel[k, 0], sum_a[1] + dvel[k, 1], sum_a[2] + dvel[k, 2])
        tick_w = (tick_w[0] + w[0], tick_w[1] + w[1], tick_w[2] + w[2])
        tick_f = (tick_f[0] + f[0], tick_f[1] + f[1], tick_f[2] + f[2])
        k += 1
        stop = tick_dt >= tick - ROUND
        if cov_dt >= period - ROUND or stop or (flush and k == last):
            transition(v, local, sum_f, c0, sum_w, sum_a, cov_dt, decay, offsets, phi, tail)
            apply(phi, width, p, m)
            if driven:
                apply_extras(phi, offsets, width, p, m)
            fold(tail, width, m, p)
            apply(phi, NAV, m, p)
            if driven:
                apply_extras(phi, offsets, NAV, m, p)
            turn = (sum_w[0] - bg[0] * cov_dt, sum_w[1] - bg[1] * cov_dt, sum_w[2] - bg[2] * cov_dt)
            add_noise(noise, turn, cov_dt, p)
            if error.size > 0:
                apply_to_vector(phi, tail, error, m)
            cov_dt = 0.0
            sum_f = sum_w = sum_a = (0.0, 0.0, 0.0)
        c, v = matrix_rows(q), v1
        if stop:
            break
    if k > first:
        memory[TIME] = time[k - 1]
    x[0], x[1], x[2] = lat, lon, height
    _store3(x, VEL, v)
    x[6], x[7], x[8], x[9] = q
    _store3(memory, PREV_THETA, prev_theta)
    _store3(memory, PREV_VEL, prev_vel)
    memory[PREV_DT], memory[COV_DT], memory[TICK_DT] = prev_dt, cov_dt, tick_dt
    _store3(memory, COV_F, sum_f)
    _store3(memory, COV_W, sum_w)
    _store3(memory, COV_A, sum_a)
    _store3(memory, TICK_W, tick_w)
    _store3(memory, TICK_F, tick_f)
    return k
