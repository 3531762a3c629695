"""A whole simulated recording from one call, with the truth as its reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.random import Generator

from gapless.errors import ConfigError
from gapless.sensors.grades import Grade
from gapless.sensors.grades import grade as named_grade
from gapless.sensors.imu_errors import corrupt
from gapless.simulate.chassis import Chassis
from gapless.simulate.motion import AT_AXLE, Vehicle, increments, trajectory
from gapless.simulate.path import Path, Segment
from gapless.simulate.profiles import fit
from gapless.simulate.profiles import profile as named_profile
from gapless.simulate.receivers import STANDARD, Receiver, WheelSensor, fixes, odometer
from gapless.simulate.vibration import vibrate
from gapless.trip.recording import Recording
from gapless.units import DEG

ORIGIN = (32.05 * DEG, 118.79 * DEG, 20.0)
"""Where a drive begins if nothing is said: latitude, longitude [rad], height [m]; that of wang2018."""
HEADING = 45.0 * DEG
"""Its first heading [rad]."""
LONGEST = 86_400.0
"""A drive lasts no longer [s]: a day of it fills some gigabytes."""
ROLL_GRADIENT = 0.007
"""Roll of a passenger car out of a turn [rad / (m/s^2)], four degrees per g."""


def drive(
    profile: str | Sequence[Segment] = "urban",
    duration: float = 1800.0,
    seed: int = 1,
    *,
    origin: tuple[float, float, float] = ORIGIN,
    heading: float = HEADING,
    roll_gradient: float = ROLL_GRADIENT,
) -> Path:
    """The path of a profile, as `simulate` drives it.

    Parameters
    ----------
    profile : str or sequence of Segment
        A name in `PROFILES`, or what to drive.
    duration : float
        At most this long [s]; a profile of fixed length may end before.
    seed : int
        The same seed drives the same path, whatever measures it.
    origin : tuple of 3 floats
        Latitude, longitude [rad], height [m] of the rear axle at time 0.
    heading : float
        At time 0 [rad].
    roll_gradient : float
        Roll out of a turn per lateral acceleration [rad / (m/s^2)].

    Returns
    -------
    Path

    Raises
    ------
    ConfigError
        If the profile is unknown, or the duration is not positive or more than a day.
    """
    if not 0.0 < duration <= LONGEST:
        raise ConfigError(
            f"a drive cannot last {duration:g} s; give a positive duration of at most {LONGEST:g} s"
        )
    chance = _streams(seed)[0]
    segments = (
        named_profile(profile)(duration, chance) if isinstance(profile, str) else fit(profile, duration)
    )
    return Path.from_segments(segments, origin, heading, roll_gradient=roll_gradient)


def simulate(
    profile: str | Sequence[Segment] = "urban",
    grade: str | Grade = "consumer",
    duration: float = 1800.0,
    seed: int = 1,
    *,
    rate: float | None = None,
    vehicle: Vehicle = AT_AXLE,
    receiver: Receiver = STANDARD,
    wheels: WheelSensor | None = None,
    chassis: Chassis | None = None,
    origin: tuple[float, float, float] = ORIGIN,
    heading: float = HEADING,
    reference_rate: float = 10.0,
) -> Recording:
    """A recording of a drive that never was.

    Parameters
    ----------
    profile : str or sequence of Segment
        A name in `PROFILES`, or what to drive.
    grade : str or Grade
        Of the IMU; "perfect" for one without errors.
    duration : float
        At most this long [s]; a profile of fixed length may end before.
    seed : int
        The path, the IMU, the receiver, the odometer and the chassis draw from streams of their own.
    rate : float, optional
        IMU samples per second [Hz]; that of the grade if not given.
    vehicle : Vehicle
        Where IMU and antenna are, and how the box is turned.
    receiver : Receiver
    wheels : WheelSensor, optional
        No odometer if not given.
    chassis : Chassis, optional
        What shakes the box, `CAR` for a passenger car: tyres, engine and road, in the place of the
        shapeless vibration of the grade. That alone if not given.
    origin : tuple of 3 floats
        Latitude, longitude [rad], height [m] of the rear axle at time 0.
    heading : float
        At time 0 [rad].
    reference_rate : float
        Rows of truth per second [Hz]; the first is at time 0, where the first IMU interval starts.

    Returns
    -------
    Recording
        The reference is the truth of the IMU point and the box's attitude, on the IMU clock.

    Raises
    ------
    ConfigError
        If the profile or the grade is unknown, the duration is not positive, too short for two IMU samples
        or more than a day, or a delay or an angle is not finite.
    """
    _check_finite(vehicle, receiver)
    budget = named_grade(grade) if isinstance(grade, str) else grade
    path = drive(profile, duration, seed, origin=origin, heading=heading)
    _, of_imu, of_receiver, of_wheels, of_chassis = _streams(seed)
    rate = rate or budget.rate
    true = increments(path, rate, vehicle)
    if len(true.time) < 2:
        raise ConfigError(
            f"a drive of {path.duration:g} s has no two IMU samples at {rate:g} Hz; make it longer"
        )
    if chassis is not None:
        true = vibrate(true, path, chassis, of_chassis, vehicle)
        budget = replace(budget, gyro_vibration=0.0, accel_vibration=0.0)
    speed, _ = path.along(true.time)
    imu, _ = corrupt(true, budget, of_imu, speed)
    rows = np.arange(int(np.floor(path.duration * reference_rate + 1e-9)) + 1) / reference_rate
    name = profile if isinstance(profile, str) else "custom"
    return Recording(
        f"{name}-{budget.name}-{seed}",
        imu,
        fixes(path, receiver, of_receiver, vehicle),
        None if wheels is None else odometer(path, wheels, of_wheels),
        trajectory(path, rows, vehicle),
        "imu",
        vehicle.lever_arm,
        budget.name,
    )


def _check_finite(vehicle: Vehicle, receiver: Receiver) -> None:
    delays = receiver.position_delay, receiver.velocity_delay
    for name, values in (("mounting", vehicle.mounting), ("receiver's delay", delays)):
        if not np.isfinite(values).all():
            told = ", ".join(f"{value:g}" for value in values)
            raise ConfigError(f"the {name} cannot be {told}; give finite numbers")


def _streams(seed: int) -> list[Generator]:
    """Independent streams for path, IMU, receiver, odometer and chassis."""
    return [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(5)]
