"""The error model of an IMU, forwards (corrupt) and backwards (correct).

An increment is measured as (I + M)(true) + bias dt + noise: M carries scale-factor errors on its
diagonal and misalignments beside it (Groves 2013, eq. 4.15 and 4.16, without g-dependent errors).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless.sensors.grades import Grade
from gapless.sensors.noise import band_limited, gauss_markov, random_walk
from gapless.trip.recording import Imu

Array = NDArray[np.float64]

VIBRATION_BAND = (8.0, 30.0)
"""Where a car shakes a box that is fastened to it [Hz]: wheels and engine, above what it drives."""
VIBRATION_SPEED = 15.0
"""Speed at which a grade states its vibration [m/s]."""
_IDLE = 0.1
"""Share of the vibration that an idling engine leaves at standstill."""


@dataclass(frozen=True, eq=False)
class ImuErrors:
    """The deterministic part of an IMU's errors: what a calibration can find and take away.

    Parameters
    ----------
    gyro_bias : ndarray, shape (3,) or (n, 3)
        Constant, or mean over each sample interval [rad/s].
    accel_bias : ndarray, shape (3,) or (n, 3)
        [m/s^2]
    gyro_matrix, accel_matrix : ndarray, shape (3, 3)
        M: scale-factor errors on the diagonal, misalignments beside it.
    """

    gyro_bias: Array
    accel_bias: Array
    gyro_matrix: Array
    accel_matrix: Array


class _Budget(NamedTuple):
    """Of one triad, gyro or accelerometer; the fields of `Grade` without their prefix."""

    noise: float
    bias_sd: float
    instability: float
    instability_tau: float
    walk: float
    scale_sd: float
    misalignment_sd: float
    quantum: float
    vibration: float


def _budget(grade: Grade, triad: str) -> _Budget:
    own = (name if name == "misalignment_sd" else f"{triad}_{name}" for name in _Budget._fields)
    return _Budget(*(getattr(grade, name) for name in own))


def corrupt(imu: Imu, grade: Grade, rng: Generator, speed: Array | float = 0.0) -> tuple[Imu, ImuErrors]:
    """Increments as an IMU of some grade would have measured them.

    Parameters
    ----------
    imu : Imu
        Error-free increments.
    grade : Grade
    rng : numpy.random.Generator
    speed : float or ndarray, shape (n,)
        Of the vehicle [m/s], which the vibration grows with: a tenth of it at standstill (the
        engine), all of it at `VIBRATION_SPEED`.

    Returns
    -------
    measured : Imu
    errors : ImuErrors
        What was put in, noise, vibration and quantisation apart.
    """
    shaking = _IDLE + (1.0 - _IDLE) * np.abs(np.broadcast_to(speed, imu.dt.shape)) / VIBRATION_SPEED
    gyro_rng, accel_rng = rng.spawn(2)
    dtheta, gyro_bias, gyro_matrix = _measure(imu.dtheta, imu.dt, _budget(grade, "gyro"), shaking, gyro_rng)
    dvel, accel_bias, accel_matrix = _measure(imu.dvel, imu.dt, _budget(grade, "accel"), shaking, accel_rng)
    measured = replace(imu, dtheta=dtheta, dvel=dvel)
    return measured, ImuErrors(gyro_bias, accel_bias, gyro_matrix, accel_matrix)


def correct(imu: Imu, errors: ImuErrors) -> Imu:
    """Increments freed of known biases, scale-factor errors and misalignments.

    Parameters
    ----------
    imu : Imu
        As measured.
    errors : ImuErrors
        Known or estimated.

    Returns
    -------
    Imu
        (I + M)^-1 (measured - bias dt).
    """
    return replace(
        imu,
        dtheta=_undo(imu.dtheta, imu.dt, errors.gyro_bias, errors.gyro_matrix),
        dvel=_undo(imu.dvel, imu.dt, errors.accel_bias, errors.accel_matrix),
    )


def _undo(measured: Array, dt: Array, bias: Array, matrix: Array) -> Array:
    return np.asarray((measured - bias * dt[:, None]) @ np.linalg.inv(np.eye(3) + matrix).T)


def _measure(
    true: Array, dt: Array, budget: _Budget, shaking: Array, rng: Generator
) -> tuple[Array, Array, Array]:
    """Measured increments, bias and matrix M of one triad.

    Each error has a random stream of its own, so that taking one away leaves the others as they were.
    """
    b = budget
    of_bias, of_run, of_walk, of_matrix, of_noise, of_vibration = rng.spawn(6)
    bias = np.tile(b.bias_sd * of_bias.standard_normal(3), (len(dt), 1))
    if b.instability:
        bias += gauss_markov(dt, b.instability, b.instability_tau, of_run)
    if b.walk:
        bias += random_walk(dt, b.walk, of_walk)
    matrix = b.misalignment_sd * of_matrix.standard_normal((3, 3))
    np.fill_diagonal(matrix, b.scale_sd * of_matrix.standard_normal(3))
    measured = true + true @ matrix.T + bias * dt[:, None]
    if b.noise:
        measured += b.noise * np.sqrt(dt)[:, None] * of_noise.standard_normal(true.shape)
    if b.vibration:
        shape = band_limited(len(dt), float(np.median(dt)), VIBRATION_BAND, of_vibration)
        measured += b.vibration * (shaking * dt)[:, None] * shape
    return (_quantise(measured, b.quantum) if b.quantum else measured), bias, matrix


def _quantise(increments: Array, quantum: float) -> Array:
    """Whole steps; what is left over is carried on, so that the sum never strays by a whole step."""
    steps = np.floor(np.cumsum(increments, axis=0) / quantum)
    return quantum * np.diff(steps, axis=0, prepend=0.0)
