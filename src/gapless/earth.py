"""The WGS-84 earth: radii of curvature, normal gravity, earth rate, lla <-> ECEF <-> NED.

Latitude and longitude are in radians, heights in metres above the ellipsoid. The scalar formulas
(`radii`, `gravity`, `transport_rate`) take floats or arrays, and kernels inline them.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gapless._numba import inline

Array = NDArray[np.float64]

SEMI_MAJOR: Final = 6378137.0
"""Equatorial radius a [m] (WGS-84)."""
FLATTENING: Final = 1.0 / 298.257223563
ECCENTRICITY_2: Final = FLATTENING * (2.0 - FLATTENING)
"""First eccentricity squared."""
RATE: Final = 7.292115e-5
"""Earth rotation rate [rad/s] (WGS-84)."""
GM: Final = 3.986004418e14
"""Gravitational constant times mass [m^3/s^2]."""
_GRAVITY_EQUATOR: Final = 9.7803253359
_GRAVITY_K: Final = 0.00193185265241
_GRAVITY_M: Final = RATE**2 * SEMI_MAJOR**3 * (1.0 - FLATTENING) / GM


@inline
def longitude(angle: Any) -> Any:
    """A longitude, or a difference of two, between -pi and pi: the way round the earth that is shorter.

    Parameters
    ----------
    angle : float or ndarray
        [rad]

    Returns
    -------
    float or ndarray
        In [-pi, pi); what lies there comes back bit for bit.
    """
    return angle - 2.0 * np.pi * np.floor((angle + np.pi) / (2.0 * np.pi))


@inline
def radii(sin_lat: Any) -> tuple[Any, Any]:
    """Meridian and transverse radii of curvature R_M, R_N [m].

    Parameters
    ----------
    sin_lat : float or ndarray
        Sine of the geodetic latitude.

    Returns
    -------
    R_M, R_N : float or ndarray
        Groves (2013), eq. 2.105 and 2.106.
    """
    q = 1.0 - ECCENTRICITY_2 * sin_lat * sin_lat
    r_n = SEMI_MAJOR / np.sqrt(q)
    return r_n * (1.0 - ECCENTRICITY_2) / q, r_n


@inline
def gravity(sin_lat: Any, height: Any) -> Any:
    """Magnitude of normal gravity [m/s^2]: Somigliana with the second-order height term.

    Parameters
    ----------
    sin_lat : float or ndarray
        Sine of the geodetic latitude.
    height : float or ndarray
        Height above the ellipsoid [m].

    Returns
    -------
    float or ndarray
        Hofmann-Wellenhof & Moritz (2006), eq. 2-146 and 2-215; good to 1e-6 m/s^2 up to 10 km.
    """
    s2 = sin_lat * sin_lat
    g0 = _GRAVITY_EQUATOR * (1.0 + _GRAVITY_K * s2) / np.sqrt(1.0 - ECCENTRICITY_2 * s2)
    r = height / SEMI_MAJOR
    return g0 * (1.0 - 2.0 * r * (1.0 + FLATTENING + _GRAVITY_M - 2.0 * FLATTENING * s2) + 3.0 * r * r)


@inline
def transport_rate(v_north: Any, v_east: Any, tan_lat: Any, r_m: Any, r_n: Any) -> tuple[Any, Any, Any]:
    """Rotation of the navigation frame against the earth, omega_en^n [rad/s].

    Parameters
    ----------
    v_north, v_east : float or ndarray
        Velocity over ground [m/s].
    tan_lat : float or ndarray
        Tangent of the latitude.
    r_m, r_n : float or ndarray
        Radii of curvature *plus height* [m].

    Returns
    -------
    tuple
        North, east, down component; Groves (2013), eq. 5.44.
    """
    e = v_east / r_n
    return e, -v_north / r_m, -e * tan_lat


def lla_to_ecef(lla: ArrayLike) -> Array:
    """Geodetic to Cartesian earth-centred earth-fixed coordinates.

    Parameters
    ----------
    lla : array_like, shape (..., 3)
        Latitude, longitude [rad], height [m].

    Returns
    -------
    ndarray, shape (..., 3)
        x, y, z [m].
    """
    lla = np.asarray(lla, float)
    lat, lon, h = lla[..., 0], lla[..., 1], lla[..., 2]
    _, r_n = radii(np.sin(lat))
    p = (r_n + h) * np.cos(lat)
    z = (r_n * (1.0 - ECCENTRICITY_2) + h) * np.sin(lat)
    return np.stack([p * np.cos(lon), p * np.sin(lon), z], axis=-1)


def ecef_to_lla(ecef: ArrayLike) -> Array:
    """Cartesian to geodetic coordinates.

    Parameters
    ----------
    ecef : array_like, shape (..., 3)
        x, y, z [m]; within 10 km of the ellipsoid four iterations leave less than 1e-9 m.

    Returns
    -------
    ndarray, shape (..., 3)
        Latitude, longitude [rad], height [m]; Bowring's iteration on the reduced latitude.
    """
    ecef = np.asarray(ecef, float)
    x, y, z = ecef[..., 0], ecef[..., 1], ecef[..., 2]
    p = np.hypot(x, y)
    b = SEMI_MAJOR * (1.0 - FLATTENING)
    second = ECCENTRICITY_2 / (1.0 - ECCENTRICITY_2)
    beta = np.arctan2(z, p * (1.0 - FLATTENING))
    lat = beta
    for _ in range(4):
        lat = np.arctan2(
            z + second * b * np.sin(beta) ** 3, p - ECCENTRICITY_2 * SEMI_MAJOR * np.cos(beta) ** 3
        )
        beta = np.arctan2((1.0 - FLATTENING) * np.sin(lat), np.cos(lat))
    _, r_n = radii(np.sin(lat))
    h = p * np.cos(lat) + z * np.sin(lat) - SEMI_MAJOR**2 / r_n
    return np.stack([lat, np.arctan2(y, x), h], axis=-1)


def ned_axes(lla: ArrayLike) -> Array:
    """Direction cosine matrix C_ne that turns ECEF vectors into NED at a point.

    Parameters
    ----------
    lla : array_like, shape (3,)
        Latitude, longitude [rad], height [m].

    Returns
    -------
    ndarray, shape (3, 3)
    """
    lat, lon, _ = np.asarray(lla, float)
    sl, cl, so, co = np.sin(lat), np.cos(lat), np.sin(lon), np.cos(lon)
    return np.array([[-sl * co, -sl * so, cl], [-so, co, 0.0], [-cl * co, -cl * so, -sl]])


def lla_to_ned(lla: ArrayLike, origin: ArrayLike) -> Array:
    """Cartesian offset from an origin, in the origin's north, east, down axes.

    Parameters
    ----------
    lla : array_like, shape (..., 3)
        Latitude, longitude [rad], height [m].
    origin : array_like, shape (3,)
        The same of the origin.

    Returns
    -------
    ndarray, shape (..., 3)
        North, east, down [m].
    """
    return np.asarray((lla_to_ecef(lla) - lla_to_ecef(origin)) @ ned_axes(origin).T)


def ned_to_lla(ned: ArrayLike, origin: ArrayLike) -> Array:
    """Inverse of `lla_to_ned`.

    Parameters
    ----------
    ned : array_like, shape (..., 3)
        North, east, down [m] from the origin.
    origin : array_like, shape (3,)
        Latitude, longitude [rad], height [m].

    Returns
    -------
    ndarray, shape (..., 3)
        Latitude, longitude [rad], height [m].
    """
    return ecef_to_lla(lla_to_ecef(origin) + np.asarray(ned, float) @ ned_axes(origin))
