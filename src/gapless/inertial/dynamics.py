"""Linearised error dynamics in NED: the blocks of F, and Phi applied to a covariance.

Phi = I + F dt is never formed: its few non-zero entries stay scalars, `apply_core` runs once over
the columns of P with all fifteen rows in registers, and P' = Phi (Phi P)' needs one transpose.
"""

from __future__ import annotations

from typing import Any

from gapless import earth
from gapless._numba import inline
from gapless.inertial.increments import Three
from gapless.inertial.layout import ROW
from gapless.inertial.mechanise import Nine
from gapless.recording import Array


@inline
def velocity_rows(v: Three, local: Any) -> tuple[Any, ...]:
    """Derivative of the velocity error's rate with respect to position and velocity errors.

    Parameters
    ----------
    v : tuple of 3
        Velocity [m/s].
    local : tuple
        `local_earth`.

    Returns
    -------
    tuple of 14
        n<-p_n, n<-p_d, e<-p_n, e<-p_d, d<-p_n, d<-p_d; n<-v_n, n<-v_e, n<-v_d, e<-v_n, e<-v_e,
        e<-v_d, d<-v_n, d<-v_e (d<-v_d is zero). Groves (2013), eq. 14.63 to 14.67, position errors
        in metres.
    """
    sl, cl, r_m, r_n, g, _, _ = local
    vn, ve, vd = v
    tan, sec2, w = sl / cl, 1.0 / (cl * cl), earth.RATE
    i_m, i_n = 1.0 / r_m, 1.0 / r_n
    return (
        -(2.0 * ve * w * cl + ve * ve * sec2 * i_n) * i_m,
        vn * vd * i_m * i_m - ve * ve * tan * i_n * i_n,
        (2.0 * w * (vn * cl - vd * sl) + vn * ve * sec2 * i_n) * i_m,
        (vn * tan + vd) * ve * i_n * i_n,
        2.0 * ve * w * sl * i_m,
        -ve * ve * i_n * i_n - vn * vn * i_m * i_m + 2.0 * g / earth.SEMI_MAJOR,
        vd * i_m,
        -2.0 * (w * sl + ve * tan * i_n),
        vn * i_m,
        2.0 * w * sl + ve * tan * i_n,
        (vd + vn * tan) * i_n,
        2.0 * w * cl + ve * i_n,
        -2.0 * vn * i_m,
        -2.0 * (w * cl + ve * i_n),
    )


@inline
def attitude_rows(v: Three, local: Any) -> tuple[Any, ...]:
    """Derivative of the attitude error's rate, phi' = -omega_in x phi - d(omega_in) + ...

    Parameters
    ----------
    v : tuple of 3
        Velocity [m/s].
    local : tuple
        `local_earth`.

    Returns
    -------
    tuple of 11
        n<-p_n, n<-p_d, e<-p_d, d<-p_n, d<-p_d; n<-v_e, e<-v_n, d<-v_e; omega_in north, east, down.
    """
    sl, cl, r_m, r_n, _, w_ie, w_en = local
    vn, ve, _ = v
    tan, i_m, i_n = sl / cl, 1.0 / r_m, 1.0 / r_n
    return (
        earth.RATE * sl * i_m,
        -ve * i_n * i_n,
        vn * i_m * i_m,
        (earth.RATE * cl + ve * i_n / (cl * cl)) * i_m,
        ve * tan * i_n * i_n,
        -i_n,
        i_m,
        tan * i_n,
        w_ie[0] + w_en[0],
        w_en[1],
        w_ie[2] + w_en[2],
    )


@inline
def position_rows(v: Three, local: Any) -> tuple[Any, Any, Any, Any, Any]:
    """Derivative of the metric position error's rate with respect to position errors.

    Parameters
    ----------
    v : tuple of 3
        Velocity [m/s].
    local : tuple
        `local_earth`.

    Returns
    -------
    tuple of 5
        n<-p_n, n<-p_d, e<-p_n, e<-p_e, e<-p_d: the axes turn with the vehicle and the radius grows
        with height.
    """
    sl, cl, r_m, r_n, _, _, _ = local
    tan = sl / cl
    return (
        -v[2] / r_m,
        v[0] / r_m,
        v[1] * tan / r_n,
        -(v[2] + v[0] * tan) / r_n,
        v[1] / r_n,
    )


@inline
def apply_core(
    phi_p: Any,
    phi_v: Any,
    phi_a: Any,
    f: Three,
    c: Nine,
    dt: Any,
    decay: Any,
    width: int,
    p: Array,
    out: Array,
) -> None:
    """Out = Phi p for the fifteen core states; further rows are copied.

    Parameters
    ----------
    phi_p, phi_v, phi_a : tuple
        `position_rows`, `velocity_rows`, `attitude_rows`.
    f : tuple of 3
        Specific-force increment in NED over the interval [m/s].
    c : tuple of 9
        C_nb.
    dt : float
        [s]
    decay : tuple of 2
        exp(-dt / tau) of gyro and accelerometer bias.
    width : int
        Columns in use.
    p, out : ndarray, shape (ROW * ROW,)
        Rows of fixed length, so that a compiler sees constant distances and makes vectors.
    """
    a0, a1, a2, a3, a4 = phi_p[0] * dt, phi_p[1] * dt, phi_p[2] * dt, phi_p[3] * dt, phi_p[4] * dt
    b0, b1, b2, b3 = phi_v[0] * dt, phi_v[1] * dt, phi_v[2] * dt, phi_v[3] * dt
    b4, b5, b6, b7 = phi_v[4] * dt, phi_v[5] * dt, 1.0 + phi_v[6] * dt, phi_v[7] * dt
    b8, b9, b10, b11 = phi_v[8] * dt, phi_v[9] * dt, 1.0 + phi_v[10] * dt, phi_v[11] * dt
    b12, b13 = phi_v[12] * dt, phi_v[13] * dt
    e0, e1, e2, e3 = phi_a[0] * dt, phi_a[1] * dt, phi_a[2] * dt, phi_a[3] * dt
    e4, e5, e6, e7 = phi_a[4] * dt, phi_a[5] * dt, phi_a[6] * dt, phi_a[7] * dt
    w0, w1, w2 = phi_a[8] * dt, phi_a[9] * dt, phi_a[10] * dt
    c0, c1, c2, c3, c4, c5 = c[0] * dt, c[1] * dt, c[2] * dt, c[3] * dt, c[4] * dt, c[5] * dt
    c6, c7, c8 = c[6] * dt, c[7] * dt, c[8] * dt
    for j in range(width):
        pn, pe, pd = p[j], p[j + ROW], p[j + 2 * ROW]
        vn, ve, vd = p[j + 3 * ROW], p[j + 4 * ROW], p[j + 5 * ROW]
        an, ae, ad = p[j + 6 * ROW], p[j + 7 * ROW], p[j + 8 * ROW]
        gx, gy, gz = p[j + 9 * ROW], p[j + 10 * ROW], p[j + 11 * ROW]
        x, y, z = p[j + 12 * ROW], p[j + 13 * ROW], p[j + 14 * ROW]
        out[j] = pn + a0 * pn + a1 * pd + dt * vn
        out[j + ROW] = pe + a2 * pn + a3 * pe + a4 * pd + dt * ve
        out[j + 2 * ROW] = pd + dt * vd
        out[j + 3 * ROW] = (b0 * pn + b1 * pd + b6 * vn + b7 * ve + b8 * vd) + (
            f[2] * ae - f[1] * ad - (c0 * x + c1 * y + c2 * z)
        )
        out[j + 4 * ROW] = (b2 * pn + b3 * pd + b9 * vn + b10 * ve + b11 * vd) + (
            f[0] * ad - f[2] * an - (c3 * x + c4 * y + c5 * z)
        )
        out[j + 5 * ROW] = (b4 * pn + b5 * pd + b12 * vn + b13 * ve + vd) + (
            f[1] * an - f[0] * ae - (c6 * x + c7 * y + c8 * z)
        )
        out[j + 6 * ROW] = (an + e0 * pn + e1 * pd + e5 * ve + w2 * ae - w1 * ad) - (
            c0 * gx + c1 * gy + c2 * gz
        )
        out[j + 7 * ROW] = (ae + e2 * pd + e6 * vn - w2 * an + w0 * ad) - (c3 * gx + c4 * gy + c5 * gz)
        out[j + 8 * ROW] = (ad + e3 * pn + e4 * pd + e7 * ve + w1 * an - w0 * ae) - (
            c6 * gx + c7 * gy + c8 * gz
        )
        out[j + 9 * ROW], out[j + 10 * ROW], out[j + 11 * ROW] = decay[0] * gx, decay[0] * gy, decay[0] * gz
        out[j + 12 * ROW], out[j + 13 * ROW], out[j + 14 * ROW] = decay[1] * x, decay[1] * y, decay[1] * z


@inline
def apply_extras(
    offsets: Any, w: Three, f: Three, c: Nine, dt: Any, width: int, p: Array, out: Array
) -> None:
    """Add to `out` what the optional blocks do to velocity and attitude errors.

    Parameters
    ----------
    offsets : ndarray of int, shape (7,)
        `Layout.offsets`.
    w, f : tuple of 3
        Body rate [rad] and specific force [m/s] integrated over the interval.
    c : tuple of 9
        C_nb.
    dt : float
        [s]
    width : int
    p, out : ndarray, shape (ROW * ROW,)
    """
    for block, target, u in ((offsets[0], 6, w), (offsets[1], 3, f)):
        if block >= 0:
            for i in range(3):
                a0, a1, a2 = c[3 * i] * u[0], c[3 * i + 1] * u[1], c[3 * i + 2] * u[2]
                row, k = (target + i) * ROW, block * ROW
                for j in range(width):
                    out[row + j] += a0 * p[k + j] + a1 * p[k + ROW + j] + a2 * p[k + 2 * ROW + j]
    if offsets[2] >= 0:
        for i in range(3):
            row, k = (3 + i) * ROW, (offsets[2] + i) * ROW
            for j in range(width):
                out[row + j] += dt * p[k + j]


@inline
def add_noise(noise: Array, w: Three, dt: Any, p: Array) -> None:
    """Add Q over one interval; velocity noise reaches the position with its half-interval moment.

    Parameters
    ----------
    noise : ndarray, shape (5,)
        Spectral densities: gyro [rad^2/s], accelerometer [m^2/s^3], gyro bias [rad^2/s^3],
        accelerometer bias [m^2/s^5]; then the variance of a turn's proportional error [1].
    w : tuple of 3
        Body rate integrated over the interval [rad].
    dt : float
        [s]
    p : ndarray, shape (ROW * ROW,)
    """
    turn = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / dt
    angle = noise[0] * dt + noise[4] * turn
    cross = 0.5 * noise[1] * dt * dt
    for i in range(3):
        p[(i) * ROW + 3 + i] += cross
        p[(3 + i) * ROW + i] += cross
        p[(3 + i) * ROW + 3 + i] += noise[1] * dt
        p[(6 + i) * ROW + 6 + i] += angle
        p[(9 + i) * ROW + 9 + i] += noise[2] * dt
        p[(12 + i) * ROW + 12 + i] += noise[3] * dt
