"""What an error-free IMU measures on an analytic path, in closed form, and where its box is.

Independent of `gapless.inertial`, whose oracle it is: angular rate and specific force come from
derivatives of the path, increments from their quadrature, and nothing is ever mechanised.
Arrays in here carry their components first, shape (3, ...), for speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless import attitude, earth
from gapless.simulate.path import Path, gauss_legendre
from gapless.trip.recording import Imu, Trajectory

Array = NDArray[np.float64]
Triple = tuple[float, float, float]

_NODES = 4
"""Quadrature nodes in a sample interval: at 0.01 s the remainder is below 1e-12 rad and m/s."""
_CHUNK = 8192
"""Sample intervals evaluated at once: the arrays stay in the cache."""


@dataclass(frozen=True)
class Vehicle:
    """Where things sit. Points are seen from the middle of the rear axle, forward, right, down.

    Parameters
    ----------
    imu : tuple of 3 floats
        The IMU [m].
    antenna : tuple of 3 floats
        The GNSS antenna [m].
    mounting : tuple of 3 floats
        Roll, pitch, yaw of the IMU's box against the vehicle [rad]: C_cb, box to car.
    """

    imu: Triple = (0.0, 0.0, 0.0)
    antenna: Triple = (0.0, 0.0, 0.0)
    mounting: Triple = (0.0, 0.0, 0.0)

    @property
    def c_cb(self) -> Array:
        """Direction cosine matrix from the box's axes to the car's, shape (3, 3)."""
        return attitude.to_matrix(attitude.from_euler(self.mounting))

    @property
    def lever_arm(self) -> Array:
        """Antenna from the IMU in the box's axes [m], shape (3,)."""
        return np.asarray((np.array(self.antenna) - np.array(self.imu)) @ self.c_cb)


AT_AXLE = Vehicle()
"""IMU and antenna at the middle of the rear axle, the box along the car's axes."""


class _Motion(NamedTuple):
    """The car at given times: vectors in car axes (c) or the local level axes (n) of the rear axle."""

    c_nc: Array  # (3, 3, ...)
    lla: Array
    v_c: Array  # velocity over ground
    dv_c: Array  # its rate of change in n, turned into c
    w_nc: Array  # angular rate against n
    dw_nc: Array
    w_ie_n: Array
    w_en_n: Array
    dw_en_n: Array


def _cross(a: Array, b: Array) -> Array:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _everywhere(vector: Triple, like: Array) -> Array:
    """One vector at every time of an array of vectors."""
    return np.broadcast_to(np.array(vector).reshape(3, *(1,) * (like.ndim - 1)), like.shape)


def _into_body(c_nb: Array, x_n: Array) -> Array:
    return np.asarray(np.einsum("ij...,i...->j...", c_nb, x_n))


def _into_level(c_nb: Array, x_b: Array) -> Array:
    return np.asarray(np.einsum("ij...,j...->i...", c_nb, x_b))


def _body_rate(angles: Array, rates: Array, accelerations: Array) -> tuple[Array, Array]:
    """Angular rate of the ZYX sequence in body axes, and its derivative; Groves (2013), eq. 2.57."""
    s, c = np.sin(angles), np.cos(angles)
    dr, dp, dh = rates
    ddr, ddp, ddh = accelerations
    # the heading axis in body axes, e = (-sp, sr cp, cr cp), and its derivative
    e = np.stack([-s[1], s[0] * c[1], c[0] * c[1]])
    de = np.stack([-c[1] * dp, c[0] * c[1] * dr - s[0] * s[1] * dp, -s[0] * c[1] * dr - c[0] * s[1] * dp])
    rate = np.stack([dr + e[0] * dh, c[0] * dp + e[1] * dh, -s[0] * dp + e[2] * dh])
    turning = de * dh + e * ddh
    return rate, turning + np.stack([ddr, c[0] * ddp - s[0] * dr * dp, -s[0] * ddp - c[0] * dr * dp])


def _dcm(angles: Array) -> Array:
    """C_nb of roll, pitch, heading, shape (3, 3, ...); Groves (2013), eq. 2.22 transposed."""
    (sr, sp, sh), (cr, cp, ch) = np.sin(angles), np.cos(angles)
    return np.stack(
        [
            np.stack([cp * ch, sr * sp * ch - cr * sh, cr * sp * ch + sr * sh]),
            np.stack([cp * sh, sr * sp * sh + cr * ch, cr * sp * sh - sr * ch]),
            np.stack([-sp, sr * cp, cr * cp]),
        ]
    )


def _motion(path: Path, t: Array) -> _Motion:
    angles, rates, accelerations = path.euler(t)
    speed, acceleration = path.along(t)
    lla = path.position(t)
    w_nc, dw_nc = _body_rate(angles, rates, accelerations)
    c_nc = _dcm(angles)
    zero = np.zeros_like(speed)
    v_c = np.stack([speed, zero, zero])
    dv_c = np.stack([acceleration, speed * w_nc[2], -speed * w_nc[1]])
    sin_lat, cos_lat = np.sin(lla[0]), np.cos(lla[0])
    r_m, r_n = earth.radii(sin_lat)
    v_n, dv_n = speed * c_nc[:, 0], _into_level(c_nc, dv_c)
    where = (sin_lat / cos_lat, r_m + lla[2], r_n + lla[2])
    w_en = np.stack(earth.transport_rate(v_n[0], v_n[1], *where))
    dw_en = np.stack(earth.transport_rate(dv_n[0], dv_n[1], *where))
    # the tangent of the latitude changes too; that the radii do weighs 1e-12 rad/s^2 times a lever arm
    dw_en[2] += w_en[0] * w_en[1] / cos_lat**2
    return _Motion(
        c_nc,
        lla,
        v_c,
        dv_c,
        w_nc,
        dw_nc,
        np.stack([earth.RATE * cos_lat, zero, -earth.RATE * sin_lat]),
        w_en,
        dw_en,
    )


def _tilt(m: _Motion, lever_n: Array) -> Array:
    """Rotation vector from the local level axes of the axle to those of a point metres away [rad]."""
    r_m, r_n = earth.radii(np.sin(m.lla[0]))
    return np.stack(
        earth.transport_rate(lever_n[0], lever_n[1], np.tan(m.lla[0]), r_m + m.lla[2], r_n + m.lla[2])
    )


def _gravity(m: _Motion, lever_n: Array) -> Array:
    """Gravity vector at a point metres from the axle, in the local level axes of the axle."""
    tilt = _tilt(m, lever_n)
    g = earth.gravity(np.sin(m.lla[0] - tilt[1]), m.lla[2] - lever_n[2])
    return np.stack([tilt[1] * g, -tilt[0] * g, g])


def rates(path: Path, t: Any, vehicle: Vehicle = AT_AXLE) -> tuple[Array, Array]:
    """Angular rate and specific force of the IMU, in closed form.

    At the axle f = dv + (2 w_ie + w_en) x v - g (Groves 2013, eq. 5.53, solved for f). At a lever arm
    r from it the inertial acceleration grows by dw_ib x r + w_ib x (w_ib x r), and gravitation differs
    from gravity by the centrifugal term of the earth.

    Parameters
    ----------
    path : Path
    t : array_like, shape (...)
        [s]
    vehicle : Vehicle

    Returns
    -------
    omega_ib_b, f_b : ndarray, shape (3, ...)
        In the axes of the box [rad/s], [m/s^2].
    """
    m = _motion(path, np.asarray(t, float))
    w_ie, w_en = _into_body(m.c_nc, m.w_ie_n), _into_body(m.c_nc, m.w_en_n)
    w_in = w_ie + w_en
    w_ib = m.w_nc + w_in
    dw_in = _into_body(m.c_nc, m.dw_en_n - _cross(m.w_en_n, m.w_ie_n)) - _cross(m.w_nc, w_in)
    lever = _everywhere(vehicle.imu, m.v_c)
    gravity = _into_body(m.c_nc, _gravity(m, _into_level(m.c_nc, lever)))
    f = m.dv_c + _cross(w_ie + w_in, m.v_c) - gravity
    f += (
        _cross(m.dw_nc + dw_in, lever) + _cross(w_ib, _cross(w_ib, lever)) - _cross(w_ie, _cross(w_ie, lever))
    )
    c_cb = vehicle.c_cb
    return _into_body(c_cb, w_ib), _into_body(c_cb, f)


def increments(path: Path, rate: float, vehicle: Vehicle = AT_AXLE) -> Imu:
    """Error-free IMU increments: the rates integrated over each sample interval.

    Parameters
    ----------
    path : Path
    rate : float
        Samples per second [Hz]; the first interval starts at time 0.
    vehicle : Vehicle

    Returns
    -------
    Imu
        By Gauss-Legendre quadrature on four nodes.
    """
    count = int(np.floor(path.duration * rate + 1e-9))
    edges = np.arange(count + 1) / rate
    dt = np.diff(edges)
    dtheta, dvel = np.empty((count, 3)), np.empty((count, 3))
    nodes, weights, _ = gauss_legendre(_NODES)
    for first in range(0, count, _CHUNK):
        rows = slice(first, min(first + _CHUNK, count))
        omega, f = rates(path, edges[:-1][rows, None] + dt[rows, None] * nodes, vehicle)
        dtheta[rows] = (omega @ weights * dt[rows]).T
        dvel[rows] = (f @ weights * dt[rows]).T
    return Imu(edges[1:], dt, dtheta, dvel)


def point(path: Path, t: Array, lever: Triple) -> tuple[Array, Array, Array]:
    """Position and velocity of a point of the car, and the car's attitude in that point's level axes.

    Parameters
    ----------
    path : Path
    t : ndarray, shape (n,)
        [s]
    lever : tuple of 3 floats
        The point from the rear axle in car axes [m].

    Returns
    -------
    lla : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m]; the earth's curvature counts to second order, which
        leaves 1e-8 m at 3 m (the change of the radii themselves).
    v_n : ndarray, shape (n, 3)
        North, east, down [m/s].
    c_nc : ndarray, shape (n, 3, 3)
        Car to the point's local level axes.
    """
    m = _motion(path, np.asarray(t, float))
    arm = _everywhere(lever, m.v_c)
    d = _into_level(m.c_nc, arm)
    w_ec = m.w_nc + _into_body(m.c_nc, m.w_en_n)
    tilt = _tilt(m, d)
    v_axle = _into_level(m.c_nc, m.v_c + _cross(w_ec, arm))
    c_nc = np.stack([m.c_nc[:, k] - _cross(tilt, m.c_nc[:, k]) for k in range(3)], axis=1)
    r_m, r_n = earth.radii(np.sin(m.lla[0]))
    height = m.lla[2] - d[2]
    sag = 0.5 * (d[0] ** 2 / r_m + d[1] ** 2 / r_n)
    lat = m.lla[0] + d[0] / (r_m + height) - 0.5 * np.tan(m.lla[0]) * d[1] ** 2 / (r_m * r_n)
    lon = earth.longitude(m.lla[1] + d[1] / ((r_n + height) * np.cos(lat)))
    lla = np.stack([lat, lon, height + sag], axis=-1)
    return lla, (v_axle - _cross(tilt, v_axle)).T, np.moveaxis(c_nc, -1, 0)


def trajectory(path: Path, t: Array, vehicle: Vehicle = AT_AXLE) -> Trajectory:
    """Truth at given times: the IMU's position and velocity, the box's attitude.

    Parameters
    ----------
    path : Path
    t : ndarray, shape (n,)
        [s]
    vehicle : Vehicle

    Returns
    -------
    Trajectory
        `source` "reference"; `sd` 0 and `horizontal` NaN.
    """
    lla, v_n, c_nc = point(path, t, vehicle.imu)
    euler = attitude.matrix_to_euler(c_nc @ vehicle.c_cb)
    unknown, source = np.full(len(t), np.nan), np.full(len(t), "reference")
    return Trajectory(np.asarray(t, float), lla, v_n, euler, np.zeros((len(t), 9)), unknown, source)
