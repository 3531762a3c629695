"""How a trip moved, as GNSS or a reference tells it: offsets, velocity, course, distance, first motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple, Self

import numpy as np

from gapless import earth
from gapless.attitude import wrap
from gapless.trip.recording import Array, Columns, Imu, Recording

FIRST_MOTION_SPEED: Final = 5.0
"""Speed that counts as driving [m/s]."""
FIRST_MOTION_TIME: Final = 3.0
"""How long the speed has to stay above it [s]."""
COURSE_SPEED: Final = 1.0
"""Below this speed [m/s] the last course is kept."""
_HALF_WINDOW: Final = 1.0
"""Positions this far before and after [s] give the velocity where none is measured."""


@dataclass(frozen=True, eq=False)
class Motion(Columns):
    """Horizontal motion of a trajectory.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    speed : ndarray, shape (n,)
        Horizontal [m/s].
    course : ndarray, shape (n,)
        Direction of travel from north [rad], kept below `COURSE_SPEED`; NaN if it never moved.
    distance : ndarray, shape (n,)
        Travelled since the first row [m]: the integral of the speed, because the length of a path
        through noisy positions grows with the noise.
    """

    speed: Array
    course: Array
    distance: Array


def offset_ned(lla: Array, origin: Array) -> Array:
    """Offset north and east along the ellipsoid, and down in height, row by row.

    Parameters
    ----------
    lla, origin : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m].

    Returns
    -------
    ndarray, shape (n, 3)
        [m]. Radii of curvature at the middle of the two: the error is of third order, 1e-6 of
        an offset of 10 km.
    """
    middle = 0.5 * (lla + origin)
    lat = origin[:, 0] + 0.5 * wrap(lla[:, 0] - origin[:, 0])
    r_m, r_n = earth.radii(np.sin(lat))
    d_lat, d_lon = wrap(lla[:, 0] - origin[:, 0]), wrap(lla[:, 1] - origin[:, 1])
    north = d_lat * (r_m + middle[:, 2])
    east = d_lon * (r_n + middle[:, 2]) * np.cos(lat)
    return np.column_stack([north, east, origin[:, 2] - lla[:, 2]])


def displace(lla: Array, ned: Array) -> Array:
    """Positions moved by metres.

    Parameters
    ----------
    lla : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m].
    ned : ndarray, shape (n, 3)
        North, east, down along the ellipsoid [m].

    Returns
    -------
    ndarray, shape (n, 3)
    """
    r_m, r_n = earth.radii(np.sin(lla[:, 0]))
    h = lla[:, 2]
    scale = np.column_stack([1.0 / (r_m + h), 1.0 / ((r_n + h) * np.cos(lla[:, 0])), np.full(len(lla), -1.0)])
    moved = np.asarray(lla + ned * scale)
    moved[:, 1] = earth.longitude(moved[:, 1])
    return moved


def velocity_from_positions(time: Array, lla: Array) -> Array:
    """Horizontal velocity from the positions about one second before and after.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    lla : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m].

    Returns
    -------
    ndarray, shape (n, 2)
        North, east [m/s]; NaN where there is no other position within a second.
    """
    slack = 1e-6  # s: stamps exactly one second apart count
    a = np.searchsorted(time, time - _HALF_WINDOW - slack)
    b = np.searchsorted(time, time + _HALF_WINDOW + slack, side="right") - 1
    span = np.where(b > a, time[b] - time[a], np.nan)
    return offset_ned(lla[b], lla[a])[:, :2] / span[:, None]


def horizontal_velocity(time: Array, lla: Array, v_n: Array) -> Array:
    """Measured horizontal velocity, or that of the positions where none is measured at all.

    Parameters
    ----------
    time : ndarray, shape (n,)
    lla, v_n : ndarray, shape (n, 3)
        Position [rad, rad, m] and velocity [m/s].

    Returns
    -------
    ndarray, shape (n, 2)
        North, east [m/s].
    """
    measured = v_n[:, :2]
    return measured if np.isfinite(measured).any() else velocity_from_positions(time, lla)


def motion(time: Array, velocity: Array) -> Motion:
    """Speed, course and distance from a horizontal velocity.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s], increasing.
    velocity : ndarray, shape (n, 2)
        North, east [m/s]; NaN where unknown.

    Returns
    -------
    Motion
    """
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    moving = speed > COURSE_SPEED
    course = np.full(len(time), np.nan)
    if moving.any():
        rows = np.flatnonzero(moving)
        nearest = rows[np.maximum(np.searchsorted(rows, np.arange(len(time)), side="right") - 1, 0)]
        course = np.arctan2(velocity[nearest, 1], velocity[nearest, 0])
    known = np.isfinite(speed)
    whole = np.interp(time, time[known], speed[known]) if known.any() else np.zeros(len(time))
    steps = 0.5 * (whole[1:] + whole[:-1]) * np.diff(time)
    return Motion(time, speed, course, np.concatenate([[0.0], np.cumsum(steps)])[: len(time)])


class Sums(NamedTuple):
    """What increments of an IMU add up to.

    Parameters
    ----------
    time : ndarray, shape (n + 1,)
        [s]
    value : ndarray, shape (n + 1, m)
        Zero at first.
    """

    time: Array
    value: Array

    @classmethod
    def of(cls, imu: Imu, increments: Array) -> Self:
        """Added up along an IMU's samples.

        Parameters
        ----------
        imu : Imu
        increments : ndarray, shape (n, m)

        Returns
        -------
        Sums
        """
        time = np.concatenate([[imu.time[0] - imu.dt[0]], imu.time])
        return cls(time, np.concatenate([np.zeros_like(increments[:1]), np.cumsum(increments, axis=0)]))

    def at(self, time: Array) -> Array:
        """Sums up to some times.

        Parameters
        ----------
        time : ndarray, shape (k,)
            [s]

        Returns
        -------
        ndarray, shape (k, m)
        """
        return np.column_stack([np.interp(time, self.time, column) for column in self.value.T])

    def around(self, time: Array, half: float) -> Array:
        """What was added within windows around some times.

        Parameters
        ----------
        time : ndarray, shape (k,)
            [s]
        half : float
            Half the window [s].

        Returns
        -------
        ndarray, shape (k, m)
        """
        return np.asarray(self.at(time + half) - self.at(time - half))


def first_motion(recording: Recording) -> float:
    """When driving began, as GNSS tells it.

    Parameters
    ----------
    recording : Recording

    Returns
    -------
    float
        Logged GNSS time [s] from which the speed stays above 5 m/s for 3 s; infinity if it
        never does.
    """
    gnss = recording.gnss
    rows = np.isfinite(gnss.v_n[:, :2]).all(1) if gnss.has_velocity else np.isfinite(gnss.lla).all(1)
    gnss = gnss.take(rows)
    velocity = horizontal_velocity(gnss.time, gnss.lla, gnss.v_n)
    fast = np.hypot(velocity[:, 0], velocity[:, 1]) > FIRST_MOTION_SPEED
    edges = np.flatnonzero(np.diff(np.concatenate([[False], fast, [False]]).astype(int)))
    for first, beyond in edges.reshape(-1, 2):
        if gnss.time[beyond - 1] - gnss.time[first] >= FIRST_MOTION_TIME:
            return float(gnss.time[first])
    return float("inf")
