"""Strapdown navigation equations in NED, one sample at a time, full earth rates."""

from __future__ import annotations

from typing import Any

import numpy as np

from gapless import earth
from gapless._numba import inline
from gapless.attitude import Four, product, small_rotation
from gapless.inertial.increments import Three, coning, cross, sculling, two_sample

Nine = tuple[Any, Any, Any, Any, Any, Any, Any, Any, Any]


@inline
def rotate(c: Nine, v: Three) -> Three:
    """C v of component tuples (C row by row).

    Parameters
    ----------
    c : tuple of 9
    v : tuple of 3

    Returns
    -------
    tuple of 3
    """
    return (
        c[0] * v[0] + c[1] * v[1] + c[2] * v[2],
        c[3] * v[0] + c[4] * v[1] + c[5] * v[2],
        c[6] * v[0] + c[7] * v[1] + c[8] * v[2],
    )


@inline
def local_earth(lat: Any, height: Any, v: Three) -> tuple[Any, Any, Any, Any, Any, Three, Three]:
    """What the earth is like here: sin, cos of latitude, R_M + h, R_N + h, gravity, omega_ie, omega_en.

    Parameters
    ----------
    lat, height : float
        [rad], [m]
    v : tuple of 3
        Velocity north, east, down [m/s].

    Returns
    -------
    sl, cl, r_m, r_n, g : float
    w_ie, w_en : tuple of 3
        Earth rate and transport rate in NED [rad/s].
    """
    sl, cl = np.sin(lat), np.cos(lat)
    r_m, r_n = earth.radii(sl)
    r_m, r_n = r_m + height, r_n + height
    w_ie = (earth.RATE * cl, 0.0, -earth.RATE * sl)
    w_en = earth.transport_rate(v[0], v[1], sl / cl, r_m, r_n)
    return sl, cl, r_m, r_n, earth.gravity(sl, height), w_ie, w_en


@inline
def velocity_step(v: Three, f_n: Three, w_ie: Three, w_en: Three, g: Three, dt: Any) -> tuple[Three, Three]:
    """Velocity after a sample, and the specific-force increment in the middle navigation frame.

    Parameters
    ----------
    v : tuple of 3
        Velocity before [m/s].
    f_n : tuple of 3
        Specific-force increment in the navigation frame of the start [m/s].
    w_ie, w_en : tuple of 3
        Earth rate, transport rate [rad/s].
    g : tuple of 3
        Gravity, NED [m/s^2].
    dt : float
        [s]

    Returns
    -------
    v_new, f_mid : tuple of 3
        Coriolis at mid-point velocity; the frame's own turn over half the sample is in f_mid.
    """
    w_in = (w_ie[0] + w_en[0], w_ie[1] + w_en[1], w_ie[2] + w_en[2])
    turn = cross(w_in, f_n)
    half = 0.5 * dt
    f = (f_n[0] - half * turn[0], f_n[1] - half * turn[1], f_n[2] - half * turn[2])
    mid = (
        v[0] + 0.5 * (f[0] + g[0] * dt),
        v[1] + 0.5 * (f[1] + g[1] * dt),
        v[2] + 0.5 * (f[2] + g[2] * dt),
    )
    coriolis = cross((2.0 * w_ie[0] + w_en[0], 2.0 * w_ie[1] + w_en[1], 2.0 * w_ie[2] + w_en[2]), mid)
    new = (
        v[0] + f[0] + dt * (g[0] - coriolis[0]),
        v[1] + f[1] + dt * (g[1] - coriolis[1]),
        v[2] + f[2] + dt * (g[2] - coriolis[2]),
    )
    return new, f


@inline
def attitude_step(q: Four, rotation: Three, w_in: Three, dt: Any) -> Four:
    """Quaternion after a sample, kept at unit length to first order.

    Parameters
    ----------
    q : tuple of 4
        q_nb before.
    rotation : tuple of 3
        Body rotation vector of the sample [rad].
    w_in : tuple of 3
        Rate of the navigation frame against inertial space [rad/s].
    dt : float
        [s]

    Returns
    -------
    tuple of 4
    """
    frame = small_rotation(-w_in[0] * dt, -w_in[1] * dt, -w_in[2] * dt)
    new = product(product(frame, q), small_rotation(rotation[0], rotation[1], rotation[2]))
    s = 1.5 - 0.5 * (new[0] * new[0] + new[1] * new[1] + new[2] * new[2] + new[3] * new[3])
    return new[0] * s, new[1] * s, new[2] * s, new[3] * s


@inline
def mechanise(
    lat: Any,
    lon: Any,
    height: Any,
    v: Three,
    q: Four,
    c: Nine,
    local: Any,
    dg: Three,
    dtheta: Three,
    dvel: Three,
    prev_theta: Three,
    prev_vel: Three,
    prev_dt: Any,
    dt: Any,
) -> tuple[Any, Any, Any, Three, Four, Three]:
    """One strapdown step (Groves 2013, ch. 5.5; Savage 1998).

    Parameters
    ----------
    lat, lon, height : float
        Position before [rad, rad, m].
    v, q, c : tuple
        Velocity [m/s], q_nb and its matrix before.
    local : tuple
        `local_earth` there.
    dg : tuple of 3
        Gravity disturbance, NED [m/s^2].
    dtheta, dvel, prev_theta, prev_vel : tuple of 3
        Corrected increments of this and the previous sample.
    prev_dt, dt : float
        Lengths of the two [s].

    Returns
    -------
    lat, lon, height, v, q
        After the sample.
    f_n : tuple of 3
        Specific-force increment of the sample in the navigation frame [m/s].
    """
    sl, cl, r_m, r_n, g, w_ie, w_en = local
    factor = two_sample(prev_dt, dt)
    f_b = sculling(dtheta, dvel, prev_theta, prev_vel, factor)
    new, f_n = velocity_step(v, rotate(c, f_b), w_ie, w_en, (dg[0], dg[1], dg[2] + g), dt)
    mid = (0.5 * (v[0] + new[0]), 0.5 * (v[1] + new[1]), 0.5 * (v[2] + new[2]))
    w_mid = earth.transport_rate(mid[0], mid[1], sl / cl, r_m, r_n)
    step_lat = mid[0] / r_m * dt
    lon = lon + mid[1] / (r_n * (cl - 0.5 * sl * step_lat)) * dt
    w_in = (w_ie[0] + w_mid[0], w_ie[1] + w_mid[1], w_ie[2] + w_mid[2])
    q = attitude_step(q, coning(dtheta, prev_theta, factor), w_in, dt)
    return lat + step_lat, lon, height - mid[2] * dt, new, q, f_n
