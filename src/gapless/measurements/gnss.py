"""GNSS position and velocity at an antenna with a lever arm."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gapless import earth
from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows
from gapless.inertial.belief import Belief
from gapless.inertial.propagate import PREV_DT, PREV_THETA, PREV_VEL
from gapless.measurements.base import Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array

LEVER = 3
"""Where `Layout.offsets` keeps the lever arm."""


@inline
def _matrix(x: Array) -> Array:
    return np.array(matrix_rows((x[6], x[7], x[8], x[9]))).reshape(3, 3)


@inline
def _lever(x: Any, offsets: Any, lever: Any) -> Any:
    i = offsets[LEVER]
    return x[i + 1 : i + 4] if i >= 0 else lever


@inline
def _minus_skew(a: Any, h: Any, row: Any, column: Any) -> None:
    """h[row:, column:] = -[a x]."""
    h[row, column + 1], h[row, column + 2] = a[2], -a[1]
    h[row + 1, column], h[row + 1, column + 2] = -a[2], a[0]
    h[row + 2, column], h[row + 2, column + 1] = a[1], -a[0]


@inline
def _cross(a: Any, b: Any) -> Array:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@kernel
def position(
    x: Array, offsets: NDArray[np.int64], n: int, lever: Array, jitter: float, lla: Array, sd: Array
) -> tuple[Array, Array, Array]:
    """Antenna position: z = antenna observed - (p + C_nb l), in NED metres.

    Parameters
    ----------
    x : ndarray
        Nominal state.
    offsets : ndarray of int
        `Layout.offsets`; the lever arm is taken from the state where that block is on.
    n : int
        Number of error states.
    lever : ndarray, shape (3,)
        Antenna from the IMU, FRD [m].
    jitter : float
        Standard deviation of the time stamp [s].
    lla : ndarray, shape (3,)
        Observed latitude, longitude [rad], height [m].
    sd : ndarray, shape (3,)
        Standard deviations north, east, down [m].

    Returns
    -------
    z : ndarray, shape (3,)
    H : ndarray, shape (3, n)
        Groves (2013), eq. 14.111: identity on position, -[C l x] on attitude, C on the lever arm.
    R : ndarray, shape (3, 3)
    """
    c = _matrix(x)
    arm = _lever(x, offsets, lever)
    cl = np.empty(3)
    for i in range(3):
        cl[i] = c[i, 0] * arm[0] + c[i, 1] * arm[1] + c[i, 2] * arm[2]
    r_m, r_n = earth.radii(np.sin(x[0]))
    z = np.empty(3)
    z[0] = (lla[0] - x[0]) * (r_m + x[2]) - cl[0]
    z[1] = earth.longitude(lla[1] - x[1]) * (r_n + x[2]) * np.cos(x[0]) - cl[1]
    z[2] = x[2] - lla[2] - cl[2]
    h, r = np.zeros((3, n)), np.zeros((3, 3))
    for i in range(3):
        h[i, i] = 1.0
        for j in range(3):
            r[i, j] = x[3 + i] * x[3 + j] * jitter * jitter
        r[i, i] += sd[i] * sd[i]
        if offsets[LEVER] >= 0:
            for j in range(3):
                h[i, offsets[LEVER] + j] = c[i, j]
    _minus_skew(cl, h, 0, 6)
    return z, h, r


@kernel
def velocity(
    x: Array,
    offsets: NDArray[np.int64],
    n: int,
    lever: Array,
    memory: Array,
    jitter: float,
    lag: Array,
    lag_force: Array,
    v_n: Array,
    sd: Array,
) -> tuple[Array, Array, Array]:
    """Antenna velocity, at an instant or as the mean over an epoch that ends now.

    z = v observed - (v + C_nb (omega x l) - lag). The mean over an epoch is the velocity at its end
    less the mean of what was gained since each instant of it: `lag`, of which `lag_force` came
    from specific force and so turns with an attitude error.

    Parameters
    ----------
    x, offsets, n, lever
        As for `position`.
    memory : ndarray
        What the last sample left behind: body rate and specific force.
    jitter : float
        Standard deviation of the time stamp [s].
    lag, lag_force : ndarray, shape (3,)
        NED [m/s]; zeros for an instantaneous velocity.
    v_n, sd : ndarray, shape (3,)
        Observed velocity and its standard deviations [m/s].

    Returns
    -------
    z : ndarray, shape (3,)
    H : ndarray, shape (3, n)
        Groves (2013), eq. 14.111 without the earth-rate terms (below 1e-4 m/s for arms of a metre).
    R : ndarray, shape (3, 3)
    """
    rate, force = np.zeros(3), np.zeros(3)
    if memory[PREV_DT] > 0.0:
        for i in range(3):
            rate[i] = memory[PREV_THETA + i] / memory[PREV_DT]
            force[i] = memory[PREV_VEL + i] / memory[PREV_DT]
    c = _matrix(x)
    arm = _lever(x, offsets, lever)
    spin = _cross(rate, arm)
    swing, late, turned = np.empty(3), np.empty(3), np.empty(3)
    for i in range(3):
        swing[i] = c[i, 0] * spin[0] + c[i, 1] * spin[1] + c[i, 2] * spin[2]
        late[i] = (c[i, 0] * force[0] + c[i, 1] * force[1] + c[i, 2] * force[2]) * jitter
        turned[i] = swing[i] - lag_force[i]
    if force[2] != 0.0:
        late[2] += earth.gravity(np.sin(x[0]), x[2]) * jitter
    z = np.empty(3)
    h, r = np.zeros((3, n)), np.zeros((3, 3))
    for i in range(3):
        z[i] = v_n[i] - x[3 + i] - swing[i] + lag[i]
        h[i, 3 + i] = 1.0
        for j in range(3):
            r[i, j] = late[i] * late[j]
        r[i, i] += sd[i] * sd[i]
        row = _cross(c[i], arm)
        for j in range(3):
            h[i, 9 + j] = row[j]
        if offsets[LEVER] >= 0:
            row = _cross(c[i], rate)
            for j in range(3):
                h[i, offsets[LEVER] + j] = row[j]
    _minus_skew(turned, h, 0, 6)
    return z, h, r


@dataclass(frozen=True)
class Position:
    """GNSS position.

    Parameters
    ----------
    lever : ndarray, shape (3,)
        Antenna from the IMU, FRD [m].
    correlation : float
        Correlation time of its error [s]: readings closer than this share their information.
    floor : float
        Least standard deviation believed [m].
    jitter : float
        Standard deviation of its time stamps [s]: along the track, a fix is as wrong as the
        vehicle is fast.
    wander : float
        Share of the standard deviation that many fixes have in common.
    """

    lever: Array = field(default_factory=lambda: np.zeros(3))
    correlation: float = 0.25
    floor: float = 0.0
    jitter: float = 0.02
    wander: float = 0.0

    def observe(self, belief: Belief, reading: Reading) -> Observation:
        """Observation of the antenna's position; see `Sensor.observe`."""
        layout, x = belief.layout, belief.estimate()
        sd = np.maximum(reading.sd, self.floor)
        noise = sd * _share(self.correlation, reading.interval)
        z, h, r = position(x, layout.offsets, layout.n, self.lever, self.jitter, reading.value, noise)
        return Observation(z, h, r, self.wander * sd)


@dataclass(frozen=True)
class Velocity:
    """GNSS velocity, at an instant or as the mean over an epoch.

    Parameters
    ----------
    lever : ndarray, shape (3,)
        Antenna from the IMU, FRD [m].
    correlation : float
        Correlation time of its error [s].
    floor : float
        Least standard deviation believed [m/s].
    jitter : float
        Standard deviation of its time stamps [s], which counts while the vehicle accelerates.
    averaging : float
        Length of the epoch that it is the mean of [s]; its readings then hold for the epoch's end.
        0 for a velocity at an instant.
    """

    lever: Array = field(default_factory=lambda: np.zeros(3))
    correlation: float = 1.2
    floor: float = 0.1
    jitter: float = 0.02
    averaging: float = 0.0

    def observe(self, belief: Belief, reading: Reading) -> Observation:
        """Observation of the antenna's velocity; see `Sensor.observe`."""
        layout = belief.layout
        sd = np.maximum(reading.sd, self.floor) * _share(self.correlation, reading.interval)
        x, lag, lag_force = belief.estimate(), *belief.trail.lag(self.averaging)
        z, h, r = velocity(
            x,
            layout.offsets,
            layout.n,
            self.lever,
            belief.memory,
            self.jitter,
            lag,
            lag_force,
            reading.value,
            sd,
        )
        return Observation(z, h, r + _arm_aside(belief, h))


def _arm_aside(belief: Belief, h: Array) -> Array:
    """Take a lever arm that is a state out of H; what its doubt does to a velocity, for R, shape (3, 3).

    A velocity looks at the arm through one sample's rate, which is vibration and noise for the most part. To
    learn the arm from that shrinks it, and makes sure of it on a straight road (1 deg/s of noise in 1000
    readings: 0.2 m). In turns positions tell it.
    """
    block = belief.layout.blocks.get("lever_arm")
    if block is None:
        return np.zeros((3, 3))
    swing = h[:, block].copy()
    h[:, block] = 0.0
    return np.asarray(swing @ belief.P[block, block] @ swing.T)


def _share(correlation: float, interval: float) -> float:
    """Factor on a standard deviation when readings come faster than their errors change."""
    return math.sqrt(max(1.0, correlation / max(interval, 0.01)))
