"""Increments of a shaking chassis, and how well its wheels could tell the speed at best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless.errors import ConfigError
from gapless.sensors.noise import band_limited
from gapless.simulate.chassis import Chassis, Engine, Road, Slip, WheelComb
from gapless.simulate.harmonics import Harmonic
from gapless.simulate.motion import AT_AXLE, Vehicle
from gapless.simulate.path import Path
from gapless.trip.recording import Imu

Array = NDArray[np.float64]

_STEP = 0.005
"""Longest stretch in which a tone counts as steady [s]: at 3 m/s^2 the phase of order 8 strays from a
straight line by 3e-4 rad, and is exact at both ends."""


class _Fine(NamedTuple):
    """A record's intervals cut into stretches; way and turns are counted at their edges."""

    dt: Array  # (m,) [s]
    way: Array  # (m + 1,) along the path [m]
    rolled: Array  # (m + 1,) of the driven wheels' tread [m]

    def mean(self, at_edges: Array) -> Array:
        """Mean rate of change over each stretch."""
        return np.asarray(np.diff(at_edges) / self.dt)


def vibrate(imu: Imu, path: Path, chassis: Chassis, rng: Generator, vehicle: Vehicle = AT_AXLE) -> Imu:
    """Increments with what shakes the chassis added.

    Parameters
    ----------
    imu : Imu
        Of that path, its intervals without gaps.
    path : Path
    chassis : Chassis
    rng : numpy.random.Generator
        Each comb and the road draw from streams of their own: each line begins with a random phase
        in each channel.
    vehicle : Vehicle
        How the box is turned in the car.

    Returns
    -------
    Imu
        A line A cos(2 pi k turns(t) + phase) is integrated over each interval in closed form,
        A dt sinc(k dturns) cos(2 pi k turns(middle) + phase), from the turns at the ends of stretches
        of 5 ms or less: what the integration takes away and what aliases is what does in an IMU.
    """
    of_wheels, of_engine, of_road = rng.spawn(3)
    fine = _cut(imu, path, chassis.slips)
    tones = np.zeros((len(fine.dt), 6))
    for comb, stream in zip(chassis.wheels, of_wheels.spawn(len(chassis.wheels)), strict=True):
        rolled = fine.rolled if comb.driven else fine.way
        share = chassis.signal * comb.growth(fine.mean(rolled))
        _add_tones(tones, comb.harmonics, rolled / comb.circumference, share * fine.dt, stream)
    if chassis.engine:
        turns = _engine_turns(chassis.engine, fine)
        share = chassis.engine.growth(fine.mean(turns))
        _add_tones(tones, chassis.engine.harmonics, turns, share * fine.dt, of_engine)
    shaken = tones.reshape(len(imu), -1, 6).sum(axis=1)
    if chassis.road:
        shaken += _road(chassis.road, imu, fine, of_road)
    c_cb = vehicle.c_cb
    return replace(imu, dtheta=imu.dtheta + shaken[:, :3] @ c_cb, dvel=imu.dvel + shaken[:, 3:] @ c_cb)


def _cut(imu: Imu, path: Path, slips: Sequence[Slip]) -> _Fine:
    parts = int(np.ceil(np.max(imu.dt) / _STEP - 1e-6))
    ends = (imu.time - imu.dt)[:, None] + imu.dt[:, None] * np.arange(1, parts + 1) / parts
    edges = np.concatenate([imu.time[:1] - imu.dt[:1], ends.ravel()])
    distance = path.speed.antiderivative(0.0)
    way = distance(edges)
    rolled = way.copy()
    for start, duration, ratio in slips:
        rolled += (ratio - 1.0) * (distance(np.clip(edges, start, start + duration)) - distance(start))
    return _Fine(np.diff(edges), way, rolled)


def _add_tones(
    tones: Array, harmonics: Sequence[Harmonic], turns: Array, weight: Array, rng: Generator
) -> None:
    """Add the lines of a comb in all six channels; `weight` is the growth times dt."""
    phases = rng.uniform(0.0, 2.0 * np.pi, (len(harmonics), 6))
    middle, advance = np.pi * (turns[1:] + turns[:-1]), np.diff(turns)
    for h, phase in zip(harmonics, phases, strict=True):
        angle, size = h.order * middle, weight * np.sinc(h.order * advance)
        amplitude = np.array([*h.rate, *h.accel])
        tones += np.outer(size * np.cos(angle), amplitude * np.cos(phase))
        tones -= np.outer(size * np.sin(angle), amplitude * np.sin(phase))


def _engine_turns(engine: Engine, fine: _Fine) -> Array:
    """Turns of the crankshaft at the edges; the gear of a stretch is that of the wheels' speed in it."""
    speed = np.abs(fine.mean(fine.rolled))
    ratios = np.array([g.ratio for g in engine.gears])
    gear = np.searchsorted([g.until for g in engine.gears], speed)
    turning = np.maximum(engine.idle, ratios[gear] * speed / engine.circumference)
    return np.concatenate([[0.0], np.cumsum(turning * fine.dt)])


def _road(road: Road, imu: Imu, fine: _Fine, rng: Generator) -> Array:
    """Its increments: of density^2 per interval and hertz, two-sided, from the lowest frequency up."""
    dt = float(np.median(imu.dt))
    half = 0.5 / dt
    shape = band_limited(len(imu), dt, (road.lowest, half), rng, axes=6)
    density = np.array([*road.rate, *road.accel]) * np.sqrt(2.0 * max(half - road.lowest, 0.0))
    parts = len(fine.dt) // len(imu)
    speed = np.diff(fine.way[::parts]) / imu.dt
    return np.asarray((road.growth(speed) * imu.dt)[:, None] * density * shape)


def speed_bound(
    chassis: Chassis, speed: float, window: float, rate: float, noise: tuple[float, float] = (0.0, 0.0)
) -> float:
    """Least standard deviation of a speed that is read from the wheels' lines (Cramer-Rao).

    Parameters
    ----------
    chassis : Chassis
        Its wheels are heard; its road is noise; its engine is left out. Circumferences are known,
        amplitudes and phases are not.
    speed : float
        Constant in the window [m/s].
    window : float
        Its length [s].
    rate : float
        Samples per second [Hz].
    noise : tuple of 2 floats
        White noise of gyros [rad/sqrt(s)] and accelerometers [m/s/sqrt(s)] on top of the road's.

    Returns
    -------
    float
        [m/s]; inf if there is nothing to hear. A tone of angular frequency w, amplitude A and unknown
        phase in N samples dt apart with noise of variance s^2 has var(w) >= 24 s^2 / (A^2 dt^2 N (N^2 - 1))
        (Rife & Boorstyn 1974, IEEE Trans. IT 20(5); for a real tone Kay 1993, eq. 3.41). Here s^2 =
        density^2 / dt, A is what the integration over dt leaves, and w = 2 pi k v / C, aliased or not,
        gives (2 pi k / C)^2 / var(w) of information on v; that of all lines and channels adds up as long
        as lines lie several 1 / window apart, and from 0 and rate / 2.

    Raises
    ------
    ConfigError
        If the window holds fewer than two samples, or a channel that hears a line has no noise.
    """
    count = int(np.floor(window * rate + 1e-9))
    if count < 2:
        raise ConfigError(f"{window:g} s at {rate:g} Hz hold no speed; give a window of two samples or more")
    per_line = sum(_information(comb, chassis.road, speed, rate, noise) for comb in chassis.wheels)
    information = chassis.signal**2 * count * (count**2 - 1.0) / (24.0 * rate**3) * per_line
    if not np.isfinite(information):
        raise ConfigError("a speed from lines without noise has no bound; give a road or a sensor noise")
    return float(1.0 / np.sqrt(information)) if information else float("inf")


def _information(
    comb: WheelComb, road: Road | None, speed: float, rate: float, noise: tuple[float, float]
) -> float:
    """Of a comb: sum over its lines and channels of (2 pi k / C)^2 A^2 / density^2."""
    total, at = 0.0, np.asarray(speed)
    for h in comb.harmonics:
        frequency = h.order * speed / comb.circumference
        heard = abs(frequency - rate * np.round(frequency / rate))  # where it folds to
        density = np.repeat(noise, 3).astype(float)
        if road and heard >= road.lowest:
            density = np.hypot(density, road.growth(at) * np.array([*road.rate, *road.accel]))
        left = comb.growth(at) * np.sinc(frequency / rate) * np.array([*h.rate, *h.accel])
        slope = 2.0 * np.pi * h.order / comb.circumference * left
        with np.errstate(divide="ignore"):
            total += np.sum((slope[slope != 0.0] / density[slope != 0.0]) ** 2)
    return float(total)
