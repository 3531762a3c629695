"""Cubature moments of the INS: the covariance through the full mechanisation, point by point.

Between two covariance steps the nominal state goes sample by sample, as ever. At the end of a step the
points of the covariance at its beginning are injected into the nominal state of its beginning, and each is
mechanised through the summed increments in one go, corrected by the biases and scales of its own. Points are
compared with a central one that took the same way, so what one long step leaves out (coning, sculling
within it) cancels.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows, product
from gapless.inertial.belief import inject
from gapless.inertial.covariance import add_noise
from gapless.inertial.increments import Three
from gapless.inertial.layout import NAV, ROW
from gapless.inertial.mechanise import local_earth, mechanise
from gapless.inertial.points import factor, linearised, scatter
from gapless.inertial.propagate import (
    ACCEL_BIAS,
    COV_A,
    COV_DT,
    COV_START,
    COV_W,
    GYRO_BIAS,
    QUAT,
    ROUND,
    TICK_DT,
    VEL,
    propagate,
)
from gapless.trip.recording import Array

NOMINAL = QUAT + 4
"""Length of the nominal navigation state: lat, lon, h, v_n, q_nb."""
_NONE = (0.0, 0.0, 0.0)


@inline
def _corrected(raw: Three, x: Any, scale: Any, bias: Any, dt: Any) -> Three:
    """Summed increments less a point's own errors."""
    a, b, c = raw
    if scale > 0:
        a, b, c = a * (1.0 + x[scale]), b * (1.0 + x[scale + 1]), c * (1.0 + x[scale + 2])
    return a - x[bias] * dt, b - x[bias + 1] * dt, c - x[bias + 2] * dt


@inline
def _carry(x: Array, offsets: Any, w: Three, f: Three, dt: Any, out: Array) -> None:
    """A point's navigation state after increments w, f, as measured, in one step."""
    v, q, gd = (x[VEL], x[VEL + 1], x[VEL + 2]), (x[6], x[7], x[8], x[9]), offsets[2] + 1
    dg = (x[gd], x[gd + 1], x[gd + 2]) if gd > 0 else _NONE
    theta = _corrected(w, x, offsets[0] + 1, GYRO_BIAS, dt)
    dvel = _corrected(f, x, offsets[1] + 1, ACCEL_BIAS, dt)
    local = local_earth(x[0], x[2], v, dt)
    out[0], out[1], out[2], v, q, _ = mechanise(
        x[0], x[1], x[2], v, q, matrix_rows(q), local, dg, theta, dvel, _NONE, _NONE, 0.0, dt
    )
    out[3], out[4], out[5] = v
    out[6], out[7], out[8], out[9] = q


@inline
def _apart(a: Array, b: Array, metres: Three, was: Array, out: Array) -> None:
    """Error state that leads from b to a; of the turns that do, the one nearest to what it `was`."""
    out[0], out[1], out[2] = (a[0] - b[0]) * metres[0], (a[1] - b[1]) * metres[1], b[2] - a[2]
    for i in range(3):
        out[3 + i] = a[3 + i] - b[3 + i]
    d = product((a[6], a[7], a[8], a[9]), (b[6], -b[7], -b[8], -b[9]))
    s = np.sqrt(d[1] * d[1] + d[2] * d[2] + d[3] * d[3])
    k = 2.0 / d[0]
    if s > 1e-9:
        angle = 2.0 * np.arctan2(s, d[0])
        along = (d[1] * was[6] + d[2] * was[7] + d[3] * was[8]) / s
        k = (angle + 2.0 * np.pi * np.round((along - angle) / (2.0 * np.pi))) / s
    out[6], out[7], out[8] = k * d[1], k * d[2], k * d[3]


@kernel
def spread(
    x: Array, low: Array, offsets: NDArray[np.int64], w: Three, f: Three, dt: float
) -> tuple[Array, Array]:
    """Cubature points through one covariance step.

    Parameters
    ----------
    x : ndarray, shape (n + 1,)
        Nominal state at the beginning of the step.
    low : ndarray, shape (n, n)
        L of P = L L' there.
    offsets : ndarray of int, shape (7,)
        `Layout.offsets`.
    w, f : tuple of 3
        Increments as measured, summed over the step [rad], [m/s].
    dt : float
        Length of the step [s].

    Returns
    -------
    half, middle : ndarray, shape (n, 9)
        Of each pair, in navigation errors against a central point.
    """
    n = x.size - 1
    point, after, centre, dx = np.empty(n + 1), np.empty(NOMINAL), np.empty(NOMINAL), np.empty(n)
    half, middle, y = np.empty((n, NAV)), np.empty((n, NAV)), np.empty((2, NAV))
    _carry(x, offsets, w, f, dt, centre)
    metres, reach = _metres(centre), np.sqrt(n)
    for i in range(n):
        for side in range(2):
            point[:] = x
            for j in range(n):
                dx[j] = (1.0 - 2.0 * side) * reach * low[j, i]
            inject(point, dx)
            _carry(point, offsets, w, f, dt, after)
            _apart(after, centre, metres, dx, y[side])
        for r in range(NAV):
            half[i, r], middle[i, r] = 0.5 * (y[0, r] - y[1, r]), 0.5 * (y[0, r] + y[1, r])
    return half, middle


@inline
def _metres(x: Array) -> Three:
    """Metres per radian of latitude and of longitude (the third is height's)."""
    _, cl, r_m, r_n, _, _, _ = local_earth(x[0], x[2], _NONE, 0.0)
    return r_m, r_n * cl, 1.0


@inline
def _gather(half: Array, extra: Array, low: Array, tail: Array, p: Array) -> None:
    """P' of the step without its noise: navigation from the points, the rest as it decays."""
    n = half.shape[0]
    share, root = 1.0 / n, 1.0 / np.sqrt(n)
    for r in range(NAV):
        for c in range(NAV):
            p[r * ROW + c] = extra[r, c]
    for i in range(n):
        for r in range(NAV):
            a = share * half[i, r]
            for c in range(NAV):
                p[r * ROW + c] += a * half[i, c]
    for j in range(NAV, n):
        row = p[j * ROW : j * ROW + n]
        for c in range(NAV):
            row[c] = 0.0
        for i in range(j + 1):
            a = root * tail[j] * low[j, i]
            for c in range(NAV):
                row[c] += a * half[i, c]
        for c in range(NAV):
            p[c * ROW + j] = row[c]
        for i in range(NAV, n):
            row[i] *= tail[i] * tail[j]


@kernel
def propagate_points(
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
    """Like `propagate`, with cubature moments (Arasaratnam and Haykin 2009).

    The nominal state goes the same way but for the shift of the mean at each covariance step.

    Parameters
    ----------
    x, memory, width, p, scratch, error, offsets, noise
    time, dt, dtheta, dvel, first, last, period, tick, flush
        As for `propagate`; `error` is empty. The transition that is left in `scratch` is the statistically
        linearised one, D' P^-1 with D the covariance of consecutive states.

    Returns
    -------
    int
        Index of the next sample.
    """
    n, k, stop = x.size - 1, first, False
    unused = np.zeros(ROW * ROW)
    while k < last and not stop:
        if memory[COV_DT] == 0.0:
            memory[COV_START : COV_START + NOMINAL] = x[:NOMINAL]
        w = (memory[COV_W], memory[COV_W + 1], memory[COV_W + 2])
        f = (memory[COV_A], memory[COV_A + 1], memory[COV_A + 2])
        span, ticking, end, due = memory[COV_DT], memory[TICK_DT], k, False
        while end < last and not due:
            w = (w[0] + dtheta[end, 0], w[1] + dtheta[end, 1], w[2] + dtheta[end, 2])
            f = (f[0] + dvel[end, 0], f[1] + dvel[end, 1], f[2] + dvel[end, 2])
            span += dt[end]
            ticking += dt[end]
            end += 1
            stop = ticking >= tick - ROUND
            due = span >= period - ROUND or stop or (flush and end == last)
        # P of its own: here it carries the nominal state, the sums and the diagonal of Phi
        propagate(
            x, memory, NAV, unused, scratch, error, offsets, noise,
            time, dt, dtheta, dvel, k, end, period, tick, flush and end == last,
        )  # fmt: skip
        k = end
        if due:
            begun, low = x.copy(), factor(p, ROW, n)
            begun[:NOMINAL] = memory[COV_START : COV_START + NOMINAL]
            half, middle = spread(begun, low, offsets, w, f, span)
            shift, extra = scatter(middle)
            phi, tail = scratch[1, : NAV * ROW], scratch[1, NAV * ROW : (NAV + 1) * ROW]
            found = linearised(half, low)
            for r in range(NAV):
                phi[r * ROW : r * ROW + n] = found[r]
            _gather(half, extra, low, tail, p)
            turn = (
                w[0] - x[GYRO_BIAS] * span,
                w[1] - x[GYRO_BIAS + 1] * span,
                w[2] - x[GYRO_BIAS + 2] * span,
            )
            add_noise(noise, turn, span, p)
            dx = np.zeros(n)
            dx[:NAV] = shift
            inject(x, dx)
    return k
