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
def local_earth(lat: Any, height: Any, v: Three, dt: Any) -> tuple[Any, Any, Any, Any, Any, Three, Three]:
    """What the earth is like half a sample ahead.

    Taken where the sample starts, earth rate and gravity would be late by half a sample: 1e-9 rad
    and 4 mm after 30 min on a motorway.

    Parameters
    ----------
    lat, height : float
        [rad], [m]
    v : tuple of 3
        Velocity north, east, down [m/s].
    dt : float
        Length of the sample [s].

    Returns
    -------
    sl, cl, r_m, r_n, g : float
        Sine and cosine of latitude, R_M + h and R_N + h [m], gravity [m/s^2].
    w_ie, w_en : tuple of 3
        Earth rate and transport rate in NED [rad/s].
    """
    lat, height = lat + 0.5 * dt * v[0] / earth.SEMI_MAJOR, height - 0.5 * dt * v[2]
    sl, cl = np.sin(lat), np.cos(lat)
    r_m, r_n = earth.radii(sl)
    r_m, r_n = r_m + height, r_n + height
    w_ie = (earth.RATE * cl, 0.0, -earth.RATE * sl)
    w_en = earth.transport_rate(v[0], v[1], sl / cl, r_m, r_n)
    return sl, cl, r_m, r_n, earth.gravity(sl, height), w_ie, w_en


@inline
def velocity_step(v: Three, f_n: Three, local: Any, dg: Three, dt: Any) -> tuple[Three, Three, Three, Three]:
    """Velocity after a sample.

    Parameters
    ----------
    v : tuple of 3
        Velocity before [m/s].
    f_n : tuple of 3
        Specific-force increment in the navigation frame of the start [m/s].
    local : tuple
        `local_earth` of the sample.
    dg : tuple of 3
        Gravity disturbance, NED [m/s^2].
    dt : float
        [s]

    Returns
    -------
    v_new, v_mid : tuple of 3
        After the sample and half-way [m/s].
    w_in : tuple of 3
        Rate of the navigation frame against inertial space, half-way [rad/s].
    f_mid : tuple of 3
        Specific-force increment in the navigation frame half-way [m/s].

    Notes
    -----
    Coriolis is taken at the mid-point velocity, and so is the transport rate in it: otherwise a
    closed lap leaves pi v^2 tan(lat) dt / 2R. That velocity holds half a Coriolis itself, or
    (2 omega_ie)^2 v dt / 2 remains, 1 nm/s^2 and 2 mm of height after 30 min on a motorway.
    """
    sl, cl, r_m, r_n, g, w_ie, w_en = local
    w_in = (w_ie[0] + w_en[0], w_ie[1] + w_en[1], w_ie[2] + w_en[2])
    turn = cross(w_in, f_n)
    half = 0.5 * dt
    f = (f_n[0] - half * turn[0], f_n[1] - half * turn[1], f_n[2] - half * turn[2])
    gain = (f[0] + dg[0] * dt, f[1] + dg[1] * dt, f[2] + (dg[2] + g) * dt)
    c = cross((w_ie[0] + w_in[0], w_ie[1] + w_in[1], w_ie[2] + w_in[2]), v)
    mid = (
        v[0] + 0.5 * gain[0] - half * c[0],
        v[1] + 0.5 * gain[1] - half * c[1],
        v[2] + 0.5 * gain[2] - half * c[2],
    )
    w_en = earth.transport_rate(mid[0], mid[1], sl / cl, r_m, r_n)
    w_in = (w_ie[0] + w_en[0], w_ie[1] + w_en[1], w_ie[2] + w_en[2])
    c = cross((w_ie[0] + w_in[0], w_ie[1] + w_in[1], w_ie[2] + w_in[2]), mid)
    new = (v[0] + gain[0] - dt * c[0], v[1] + gain[1] - dt * c[1], v[2] + gain[2] - dt * c[2])
    return new, mid, w_in, f


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
        `local_earth` of the sample.
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
    _, cl, r_m, r_n, _, _, _ = local
    factor = two_sample(prev_dt, dt)
    f_b = sculling(dtheta, dvel, prev_theta, prev_vel, factor)
    new, mid, w_in, f_n = velocity_step(v, rotate(c, f_b), local, dg, dt)
    q = attitude_step(q, coning(dtheta, prev_theta, factor), w_in, dt)
    lat, lon = lat + mid[0] / r_m * dt, lon + mid[1] / (r_n * cl) * dt
    return lat, lon, height - mid[2] * dt, new, q, f_n
