"""Linearised error dynamics in NED: the entries of F, and Phi = I + F dt."""

from __future__ import annotations

from typing import Any, Final

from gapless import earth
from gapless._numba import inline
from gapless.inertial.increments import Three
from gapless.inertial.layout import ROW
from gapless.inertial.mechanise import Nine
from gapless.trip.recording import Array

GRAVITY_NORTHWARD: Final = 0.1033
"""Rate of normal gravity with latitude over sin cos [m/s^2]: g_e (2 k + e^2) of Somigliana's formula."""


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
        in metres; and gravity's change with latitude, more than Coriolis' at a car's speed.
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
        (2.0 * ve * w + GRAVITY_NORTHWARD * cl) * sl * i_m,
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
def transition(
    v: Three,
    local: Any,
    f_n: Three,
    c: Nine,
    w_b: Three,
    f_b: Three,
    dt: Any,
    decay: Any,
    offsets: Any,
    phi: Array,
    tail: Array,
) -> None:
    """Phi = I + F dt: its navigation rows, stored dense, and the diagonal of the rest.

    Parameters
    ----------
    v : tuple of 3
        Velocity [m/s].
    local : tuple
        `local_earth`.
    f_n : tuple of 3
        Specific force integrated over the interval, NED [m/s].
    c : tuple of 9
        C_nb.
    w_b, f_b : tuple of 3
        Rate [rad] and specific force [m/s] as measured, integrated over the interval, body axes.
    dt : float
        [s]
    decay : tuple of 2
        1 / tau of gyro and accelerometer bias [1/s].
    offsets : ndarray of int, shape (7,)
        `Layout.offsets`.
    phi : ndarray, shape (NAV * ROW,)
        Row by row; entries that are always zero are not written.
    tail : ndarray, shape (ROW,)
        The diagonal, of which the six bias entries are written.
    """
    r, s, a = position_rows(v, local), velocity_rows(v, local), attitude_rows(v, local)
    n, e, d = 0, ROW, 2 * ROW
    phi[n], phi[n + 2], phi[n + 3] = 1.0 + r[0] * dt, r[1] * dt, dt
    phi[e], phi[e + 1], phi[e + 2], phi[e + 4] = r[2] * dt, 1.0 + r[3] * dt, r[4] * dt, dt
    phi[d + 2], phi[d + 5] = 1.0, dt
    n, e, d = 3 * ROW, 4 * ROW, 5 * ROW
    phi[n], phi[n + 2] = s[0] * dt, s[1] * dt
    phi[e], phi[e + 2] = s[2] * dt, s[3] * dt
    phi[d], phi[d + 2] = s[4] * dt, s[5] * dt
    phi[n + 3], phi[n + 4], phi[n + 5] = 1.0 + s[6] * dt, s[7] * dt, s[8] * dt
    phi[e + 3], phi[e + 4], phi[e + 5] = s[9] * dt, 1.0 + s[10] * dt, s[11] * dt
    phi[d + 3], phi[d + 4], phi[d + 5] = s[12] * dt, s[13] * dt, 1.0
    phi[n + 7], phi[n + 8] = f_n[2], -f_n[1]
    phi[e + 6], phi[e + 8] = -f_n[2], f_n[0]
    phi[d + 6], phi[d + 7] = f_n[1], -f_n[0]
    n, e, d = 6 * ROW, 7 * ROW, 8 * ROW
    phi[n], phi[n + 2], phi[n + 4] = a[0] * dt, a[1] * dt, a[5] * dt
    phi[e + 2], phi[e + 3] = a[2] * dt, a[6] * dt
    phi[d], phi[d + 2], phi[d + 4] = a[3] * dt, a[4] * dt, a[7] * dt
    phi[n + 6], phi[n + 7], phi[n + 8] = 1.0, a[10] * dt, -a[9] * dt
    phi[e + 6], phi[e + 7], phi[e + 8] = -a[10] * dt, 1.0, a[8] * dt
    phi[d + 6], phi[d + 7], phi[d + 8] = a[9] * dt, -a[8] * dt, 1.0
    for i in range(3):
        velocity, attitude = (3 + i) * ROW, (6 + i) * ROW
        for j in range(3):
            c_ij = c[3 * i + j]
            phi[velocity + 12 + j] = phi[attitude + 9 + j] = -c_ij * dt
            if offsets[0] >= 0:
                phi[attitude + offsets[0] + j] = c_ij * w_b[j]
            if offsets[1] >= 0:
                phi[velocity + offsets[1] + j] = c_ij * f_b[j]
        if offsets[2] >= 0:
            phi[velocity + offsets[2] + i] = dt
        tail[9 + i], tail[12 + i] = 1.0 - decay[0] * dt, 1.0 - decay[1] * dt
