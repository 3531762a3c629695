"""What a GNSS receiver and an odometer would have logged of a path, and what goes wrong with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless.sensors.noise import gauss_markov
from gapless.simulate.motion import Vehicle, point
from gapless.simulate.path import Path, gauss_legendre
from gapless.trip.motion import displace
from gapless.trip.recording import Gnss, Odometer

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Receiver:
    """A GNSS receiver. Standard deviations are north, east, down.

    Parameters
    ----------
    rate : float
        Fixes per second [Hz].
    position_white : tuple of 3 floats
        White part of the position error [m].
    position_correlated : tuple of 3 floats
        Its first-order Gauss-Markov part [m].
    correlation_time : float
        Of the latter [s].
    velocity : tuple of 3 floats
        White velocity error [m/s].
    position_delay, velocity_delay : float
        By how much a stamp is late: a fix logged at t holds for t less the delay [s].
    velocity_window : float
        Velocity is the mean over this long before the time it holds for [s], as if half of it later
        still; 0 for instantaneous.
    stated : float
        Stated standard deviations over the true ones.
    fix : int
        Fix code: 1 single, 2 differential, 4 RTK fixed, 5 RTK float.
    """

    rate: float = 1.0
    position_white: Triple = (0.5, 0.5, 1.0)
    position_correlated: Triple = (1.0, 1.0, 2.0)
    correlation_time: float = 60.0
    velocity: Triple = (0.05, 0.05, 0.1)
    position_delay: float = 0.0
    velocity_delay: float = 0.0
    velocity_window: float = 0.0
    stated: float = 1.0
    fix: int = 1


STANDARD = Receiver(stated=1.5)
"""A single-frequency receiver in the open: 1.1 m and 0.05 m/s horizontally, once a second. Like the real
ones that we could hold against a truth, it is better than it says."""


@dataclass(frozen=True)
class WheelSensor:
    """An odometer on the rear axle.

    Parameters
    ----------
    rate : float
        Readings per second [Hz].
    scale : float
        It reads 1 + scale times the speed.
    offset : float
        Added to it while the wheels roll [m/s]; a reading is never below zero for it.
    delay : float
        By how much a stamp is late; negative if it is early [s].
    noise : float
        White [m/s].
    quantum : float
        Least step of a reading [m/s]; 0 for none.
    """

    rate: float = 10.0
    scale: float = 0.0
    offset: float = 0.0
    delay: float = 0.0
    noise: float = 0.02
    quantum: float = 0.0


def _epochs(path: Path, rate: float, reach: tuple[float, float]) -> Array:
    """Stamps of a sensor whose readings hold for from `reach[0]` to `reach[1]` seconds before them."""
    stamps = np.arange(int(np.floor(path.duration * rate + 1e-9)) + 1) / rate
    return stamps[(stamps - reach[1] >= 0.0) & (stamps - reach[0] <= path.duration + 1e-9)]


def fixes(path: Path, receiver: Receiver, rng: Generator, vehicle: Vehicle) -> Gnss:
    """What a receiver logs.

    Parameters
    ----------
    path : Path
    receiver : Receiver
    rng : numpy.random.Generator
    vehicle : Vehicle
        Says where the antenna is.

    Returns
    -------
    Gnss
        Position of the antenna; stated standard deviations are those of the whole error, white and
        correlated, times `receiver.stated`.
    """
    r = receiver
    late = (
        min(r.position_delay, r.velocity_delay),
        max(r.position_delay, r.velocity_delay + r.velocity_window),
    )
    time = _epochs(path, r.rate, late)
    white, velocity = rng.standard_normal((2, len(time), 3))
    drift = gauss_markov(np.full(len(time), 1.0 / r.rate), 1.0, r.correlation_time, rng)
    error = white * np.array(r.position_white) + drift * np.array(r.position_correlated)
    lla, _, _ = point(path, time - r.position_delay, vehicle.antenna)
    v_n = _mean_velocity(path, time - r.velocity_delay, r.velocity_window, vehicle.antenna)
    sd = r.stated * np.hypot(r.position_white, r.position_correlated)
    return Gnss(
        time,
        displace(lla, error),
        np.tile(sd, (len(time), 1)),
        v_n + velocity * np.array(r.velocity),
        np.tile(r.stated * np.array(r.velocity), (len(time), 1)),
        np.full(len(time), r.fix, np.int64),
    )


def _mean_velocity(path: Path, time: Array, window: float, antenna: Triple) -> Array:
    """Velocity over (time - window, time], by quadrature: to 1e-6 m/s for windows up to 1 s."""
    nodes, weights, _ = gauss_legendre(8 if window else 1)
    at = time[:, None] - window * nodes
    _, v_n, _ = point(path, at.ravel(), antenna)
    return np.asarray(weights @ v_n.reshape(*at.shape, 3))


def odometer(path: Path, sensor: WheelSensor, rng: Generator) -> Odometer:
    """What an odometer logs.

    Parameters
    ----------
    path : Path
    sensor : WheelSensor
    rng : numpy.random.Generator

    Returns
    -------
    Odometer
    """
    time = _epochs(path, sensor.rate, (sensor.delay, sensor.delay))
    true, _ = path.along(time - sensor.delay)
    rolling = np.where(true > 0.0, np.maximum((1.0 + sensor.scale) * true + sensor.offset, 0.0), true)
    speed = rolling + sensor.noise * rng.standard_normal(len(time))
    if sensor.quantum:
        speed = sensor.quantum * np.rint(speed / sensor.quantum)
    return Odometer(time, speed)


def spikes(
    gnss: Gnss,
    rng: Generator,
    count: int,
    position: tuple[float, float] = (0.0, 0.0),
    velocity: tuple[float, float] = (0.0, 0.0),
) -> tuple[Gnss, NDArray[np.int64]]:
    """Faults that a receiver does not own up to: jumps at single epochs, stated sigmas as they were.

    Parameters
    ----------
    gnss : Gnss
        Simulated or real.
    rng : numpy.random.Generator
    count : int
        How many epochs are struck.
    position, velocity : tuple of 2 floats
        Least and greatest size of a jump [m], [m/s]; sizes are log-uniform, directions horizontal
        and uniform. (0, 0) for none.

    Returns
    -------
    gnss : Gnss
    struck : ndarray of int
        Rows that were, increasing.
    """
    struck = np.sort(rng.choice(len(gnss), min(count, len(gnss)), replace=False))
    lla, v_n = gnss.lla.copy(), gnss.v_n.copy()
    lla[struck] = displace(lla[struck], _jumps(len(struck), position, rng))
    v_n[struck] += _jumps(len(struck), velocity, rng)
    return replace(gnss, lla=lla, v_n=v_n), struck


def _jumps(count: int, size: tuple[float, float], rng: Generator) -> Array:
    bearing, share = rng.uniform(0.0, 2.0 * np.pi, count), rng.random(count)
    length = size[0] * (size[1] / size[0]) ** share if size[0] else size[1] * share
    return np.column_stack([length * np.cos(bearing), length * np.sin(bearing), np.zeros(count)])


def withhold(gnss: Gnss, outages: Sequence[tuple[float, float]], start: float = 0.0) -> Gnss:
    """Fixes without those logged in some stretches.

    Parameters
    ----------
    gnss : Gnss
    outages : sequence of (float, float)
        Each from, until [s] after `start`, the end not included.
    start : float
        [s]

    Returns
    -------
    Gnss
    """
    t = gnss.time - start
    out = np.zeros(len(t), bool)
    for a, b in outages:
        out |= (t >= a) & (t < b)
    return gnss.take(~out)
