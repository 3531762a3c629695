"""A navigator's settings from a recipe and from what was decided."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from gapless.alignment.coarse import Aligner
from gapless.errors import ConfigError
from gapless.filters.adaptation.registry import KINDS, RULES, chain
from gapless.filters.stamp_doubt import SURE, Doubt
from gapless.fold.settings import Settings
from gapless.inertial.layout import Layout
from gapless.measurements.base import Constraint, Sensor
from gapless.measurements.gnss import Position, Velocity
from gapless.measurements.nonholonomic import NonHolonomic
from gapless.measurements.odometer import Odometer
from gapless.measurements.spread import Spread
from gapless.measurements.stillness import Stillness
from gapless.sensors import grade
from gapless.systems.adjust import named
from gapless.systems.arm import lever_arm
from gapless.systems.learning import bridges
from gapless.systems.recipe import Imu, System
from gapless.trip.recording import Array, Recording
from gapless.units import DEG

TURN = 5.0
"""How long a turn lasts [s]."""


def settings(
    system: System,
    recording: Recording,
    offsets: Mapping[str, float],
    mounting: tuple[Array, Array],
    gyro_density: float = 0.0,
    row: float = 0.1,
    doubt: Doubt = SURE,
) -> Settings:
    """Settings of a navigator.

    Parameters
    ----------
    system : System
    recording : Recording
        For its lever arm, and for whether there is an odometer.
    offsets : mapping of str to float
        Clock offset of each channel [s].
    mounting : tuple of 2 ndarray, shape (2,)
        Pitch and yaw of the car's forward axis in the box, and their standard deviations [rad].
    gyro_density : float
        What the log's gyros show of vibration [rad/sqrt(s)].
    row : float
        Time between journal rows [s].
    doubt : Doubt
        Of the receiver's stamps.

    Returns
    -------
    Settings
    """
    imu = budget(system.imu, gyro_density)
    names = states(system, recording)
    angles, angle_sd = mounting
    sensors, lateness = _sensors(system, recording, angles), _lateness(stamps(system, offsets), recording)
    rules = system.adaptation
    parts = [(part.bridge, part.learner) for part in (system, *candidates(system))]
    spoken = tuple(b for use, who in parts for b in bridges(use, who, sensors, lateness))
    averaged = 1.5 * system.gnss.velocity_averaging + 0.2 if system.gnss.velocity_averaging else 0.0
    tables = {name: getattr(rules, name) for name in RULES}
    return Settings(
        layout=Layout(names),
        noise=imu["noise"],
        initial_sd={
            "attitude": system.alignment.tilt_sd * DEG,
            "gyro_bias": imu["gyro_bias_sd"],
            "accel_bias": imu["accel_bias_sd"],
            "gyro_scale": imu["gyro_scale_sd"],
            "accel_scale": imu["accel_scale_sd"],
            "gravity": system.imu.gravity_sd,
            "lever_arm": np.array(system.gnss.lever_arm_sd),
            "mounting": angle_sd,
            "axle": system.nonholonomic.axle_sd,
            "odometer_scale": system.odometer.scale_sd,
            "odometer_offset": system.odometer.offset_sd,
        },
        initial=_initial(names, angles, system, recording),
        sensors=sensors,
        constraints=_constraints(system, angles),
        bridges=spoken,
        adaptation={kind: chain(kind, getattr(rules, kind), tables) for kind in KINDS},
        aligner=Aligner(float(angles[1]), system.alignment.min_speed, system.alignment.window),
        tick=system.filter.tick,
        period=system.filter.covariance_period,
        row=row,
        lateness=lateness,
        trail=max(averaged, *(bridge.reach for bridge in spoken), 0.0),
        misalignment=float(imu["misalignment"]),
        wander_time=system.gnss.wander_time,
        cubature=system.filter.moments == "cubature",
        doubt=doubt,
        open_loop=system.filter.correction == "feedforward",
    )


def candidates(system: System) -> list[System]:
    """Other systems whose bridges may speak in this one, once they have earned it.

    Parameters
    ----------
    system : System

    Returns
    -------
    list of System

    Raises
    ------
    ConfigError
        If there is no such system, or it has no bridge.
    """
    try:
        found = [named(name) for name in system.rehearsal.others]
    except ConfigError as error:
        raise ConfigError(f"rehearsal.others: {error}") from None
    for other in found:
        if other.bridge.model == "none":
            raise ConfigError(f"rehearsal.others: {other.name} has no bridge; name a system that has one")
    return found


def stamps(system: System, offsets: Mapping[str, float]) -> dict[str, float]:
    """What is added to each channel's stamps: a mean over an epoch holds for the epoch's end.

    Parameters
    ----------
    system : System
    offsets : mapping of str to float
        Equivalent instantaneous clock offsets [s].

    Returns
    -------
    dict of str to float
        [s]
    """
    return {**offsets, "velocity": offsets.get("velocity", 0.0) + 0.5 * system.gnss.velocity_averaging}


def _lateness(offsets: Mapping[str, float], recording: Recording) -> float:
    """How late readings arrive, with some slack; 0 where none does."""
    ends = recording.gnss.time[[0, -1]] if len(recording.gnss) else np.zeros(2)
    more = offsets.get("drift", 0.0) * (ends - offsets.get("since", 0.0))
    most = max(
        0.0,
        *(-late for name, late in offsets.items() if name == "odometer"),
        *(-late - m for name, late in offsets.items() if name in ("position", "velocity") for m in more),
    )
    return most + 0.05 if most > 0.0 else 0.0


def states(system: System, recording: Recording) -> tuple[str, ...]:
    """Optional state blocks: those of the recipe, and those that its sensors and constraints need.

    Parameters
    ----------
    system : System
    recording : Recording

    Returns
    -------
    tuple of str
    """
    names = list(system.filter.states)
    car = "nonholonomic" in system.constraints
    wheel = "odometer" in system.sensors and recording.odometer is not None
    wanted = ["mounting"] * (car or wheel) + ["axle"] * car + ["odometer_scale", "odometer_offset"] * wheel
    return (*names, *(name for name in wanted if name not in names))


def budget(imu: Imu, gyro_density: float = 0.0) -> dict[str, Array]:
    """Process noise and turn-on errors in SI units, from a named grade or from the recipe.

    Parameters
    ----------
    imu : Imu
    gyro_density : float
        What the log's gyros show of vibration [rad/sqrt(s)]; a named grade does without.

    Returns
    -------
    dict of str to ndarray
        "noise" as `propagate` takes it, then the standard deviations of the turn-on errors, and
        "misalignment".
    """
    if not imu.grade:
        gyro_noise = math.hypot(imu.gyro_noise * DEG, imu.vibration * gyro_density)
        noise = [gyro_noise, imu.accel_noise, imu.gyro_walk * DEG, imu.accel_walk, imu.turn]
        bias = (imu.gyro_bias_sd * DEG, imu.accel_bias_sd, imu.gyro_scale_sd, imu.accel_scale_sd)
        askew = imu.misalignment * DEG
    else:
        g = grade(imu.grade)
        # what moves in run is a random walk with the same power over the correlation time
        gyro = math.hypot(g.gyro_walk, g.gyro_instability * math.sqrt(2.0 / g.gyro_instability_tau))
        accel = math.hypot(g.accel_walk, g.accel_instability * math.sqrt(2.0 / g.accel_instability_tau))
        # a gyro askew turns with every turn; over one of some five seconds that looks like noise
        turn = g.misalignment_sd * math.sqrt(TURN)
        # of six angles between the axes, each pair's half difference turns the whole triad
        askew = g.misalignment_sd / math.sqrt(2.0)
        noise = [g.gyro_noise, g.accel_noise, gyro, accel, turn]
        bias = (
            math.hypot(g.gyro_bias_sd, g.gyro_instability),
            math.hypot(g.accel_bias_sd, g.accel_instability),
            g.gyro_scale_sd,
            g.accel_scale_sd,
        )
    names = ("gyro_bias_sd", "accel_bias_sd", "gyro_scale_sd", "accel_scale_sd")
    found = {name: np.asarray(value) for name, value in zip(names, bias, strict=True)}
    found["misalignment"] = np.asarray(askew)
    return found | {"noise": np.array([*np.square(noise), 0.0, 0.0])}


def _initial(names: tuple[str, ...], angles: Array, system: System, recording: Recording) -> dict[str, Array]:
    known = {
        "mounting": angles,
        "axle": np.array([system.nonholonomic.axle]),
        "lever_arm": lever_arm(system, recording),
    }
    return {name: value for name, value in known.items() if name in names}


def _sensors(system: System, recording: Recording, angles: Array) -> dict[str, Sensor]:
    lever, use, wheel = lever_arm(system, recording), system.gnss, system.odometer
    known: dict[str, Sensor] = {
        "position": Position(lever, use.position_correlation, use.position_floor, use.jitter, use.wander),
        "velocity": Velocity(
            lever, use.velocity_correlation, use.velocity_floor, use.jitter, use.velocity_averaging
        ),
        "odometer": Odometer(
            wheel.sd, wheel.correlation, wheel.jitter, wheel.side, (float(angles[0]), float(angles[1]))
        ),
    }
    if system.filter.moments == "cubature":
        known = {name: Spread(sensor) for name, sensor in known.items()}
    return {
        name: known[name] for name in system.sensors if name != "odometer" or recording.odometer is not None
    }


def _constraints(system: System, angles: Array) -> dict[str, Constraint]:
    z, n = system.zero_velocity, system.nonholonomic
    known: dict[str, Constraint] = {
        "zero_velocity": Stillness(z.sd, z.rate_sd * DEG, z.odds, z.hold),
        "nonholonomic": NonHolonomic(
            n.lateral,
            n.vertical,
            n.turn,
            n.min_speed,
            n.axle,
            (float(angles[0]), float(angles[1])),
            n.interval,
        ),
    }
    return {name: known[name] for name in system.constraints}
