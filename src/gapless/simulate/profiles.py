"""How a vehicle is driven: named profiles, each a function of duration and chance that gives segments."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless.errors import ConfigError
from gapless.simulate.path import Segment
from gapless.units import DEG

Profile = Callable[[float, Generator], tuple[Segment, ...]]

KMH: Final = 1.0 / 3.6
"""m/s per km/h."""
_STANDING_START: Final = 30.0
"""Every random drive begins at rest [s], as long as a levelling needs."""


def fit(segments: Sequence[Segment], duration: float) -> tuple[Segment, ...]:
    """The segments of the first `duration` seconds.

    Parameters
    ----------
    segments : sequence of Segment
    duration : float
        [s], > 0.

    Returns
    -------
    tuple of Segment
        The last one cut short; all of them if they end before.
    """
    kept, left = [], duration
    for s in segments:
        if left <= 1e-9:
            break
        kept.append(replace(s, duration=min(s.duration, left)))
        left -= s.duration
    return tuple(kept)


def static(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """Standing still on level ground.

    Parameters
    ----------
    duration : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
    """
    return (Segment(duration),)


def wang2018(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """The 784 s of Wang et al. (2018), Table 3: straights, two right turns, up to 18 m/s.

    Parameters
    ----------
    duration : float
        [s]; more than 784 are not driven.
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        Sixteen.
    """
    commands = (
        (5.0, 0.0, 0.0),
        (20.0, 0.3, 0.0),
        (20.0, 0.6, 0.0),
        (100.0, 0.0, 0.0),
        (20.0, -0.5, 0.0),
        (100.0, 0.0, 0.0),
        (10.0, 0.0, 9.0),
        (50.0, 0.0, 0.0),
        (10.0, 0.9, 0.0),
        (100.0, 0.0, 0.0),
        (30.0, -0.3, 0.0),
        (100.0, 0.0, 0.0),
        (9.0, 0.0, 10.0),
        (100.0, 0.0, 0.0),
        (100.0, -0.08, 0.0),
        (10.0, 0.0, 0.0),
    )
    return fit([Segment(t, a, w * DEG) for t, a, w in commands], duration)


def urban(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """City driving: 30-60 km/h, traffic lights of 10-60 s, right-angled turns, hills, changes of lane.

    Parameters
    ----------
    duration : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
    """
    return _take(_urban(rng), duration)


def highway(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """Motorway driving: 70-120 km/h, long gentle curves, changes of lane, slow changes of speed.

    Parameters
    ----------
    duration : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
    """
    return _take(_highway(rng), duration)


def mixed(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """Town, motorway, town and so on, a few minutes each.

    Parameters
    ----------
    duration : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
    """
    return _take(_mixed(rng), duration)


def carpark(duration: float, rng: Generator) -> tuple[Segment, ...]:
    """Creeping through a car park: 5-12 km/h, tight turns on ramps and aisles, short waits.

    Parameters
    ----------
    duration : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
    """
    return _take(_carpark(rng), duration)


PROFILES: Final[dict[str, Profile]] = {
    "carpark": carpark,
    "highway": highway,
    "mixed": mixed,
    "static": static,
    "urban": urban,
    "wang2018": wang2018,
}
"""Named profiles."""


def profile(name: str) -> Profile:
    """A named profile.

    Parameters
    ----------
    name : str

    Returns
    -------
    callable
        Of the duration [s] and a generator, giving segments.

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    if name not in PROFILES:
        raise ConfigError(f"no profile {name!r}; the profiles are {', '.join(PROFILES)}")
    return PROFILES[name]


def _take(drive: Iterator[Segment], duration: float) -> tuple[Segment, ...]:
    segments = [Segment(_STANDING_START)]
    total = _STANDING_START
    while total < duration:
        segments.append(next(drive))
        total += segments[-1].duration
    return fit(segments, duration)


def _change(speed: float, target: float, rate: float, slope: float = 0.0) -> Iterator[Segment]:
    """From one speed to another at some magnitude of acceleration."""
    if abs(target - speed) > 1e-9:
        duration = abs(target - speed) / rate
        yield Segment(duration, (target - speed) / duration, 0.0, slope)


def _turn(angle: float, rate: float, slope: float = 0.0, bank: float = 0.0) -> Iterator[Segment]:
    """Through an angle at some magnitude of turn rate."""
    duration = abs(angle) / rate
    yield Segment(duration, 0.0, angle / duration, slope, bank)


def _wiggle(angle: float, duration: float, slope: float = 0.0) -> Iterator[Segment]:
    """A change of lane: off by an angle and back."""
    for sign in (1.0, -1.0):
        yield Segment(duration, 0.0, sign * angle / duration, slope)


def _slope(climb: float, steepest: float, rng: Generator) -> float:
    """A new slope that, in the long run, brings back down what went up [rad]."""
    return float(np.clip(rng.normal(-climb / 2000.0, steepest / 2.0), -steepest, steepest))


def _urban(rng: Generator) -> Iterator[Segment]:
    climb = 0.0
    while True:
        cruise = rng.uniform(30.0, 60.0) * KMH
        yield from _change(0.0, cruise, rng.uniform(1.0, 2.2))
        for _ in range(rng.integers(1, 4)):
            slope, straight = _slope(climb, 0.04, rng), rng.uniform(8.0, 30.0)
            climb += slope * cruise * straight
            yield Segment(straight, 0.0, 0.0, slope, rng.uniform(-0.02, 0.02))
            if rng.random() < 0.5:
                yield from _wiggle(
                    rng.choice([-1.0, 1.0]) * rng.uniform(3.0, 6.0) * DEG, rng.uniform(1.6, 2.5), slope
                )
            if rng.random() < 0.6:
                slow = rng.uniform(15.0, 25.0) * KMH
                yield from _change(cruise, slow, rng.uniform(1.0, 2.0), slope)
                angle = rng.choice([-1.0, 1.0]) * rng.normal(90.0, 4.0) * DEG
                yield from _turn(angle, rng.uniform(14.0, 22.0) * DEG)
                yield from _change(slow, cruise, rng.uniform(1.0, 2.2))
        yield from _change(cruise, 0.0, rng.uniform(1.2, 2.5))
        yield Segment(rng.uniform(10.0, 60.0))


def _highway(rng: Generator) -> Iterator[Segment]:
    climb, slope, speed = 0.0, 0.0, 70.0 * KMH
    yield from _change(0.0, speed, rng.uniform(1.0, 2.0))
    while True:
        target = rng.uniform(70.0, 120.0) * KMH
        yield from _change(speed, target, rng.uniform(0.3, 1.0), slope)
        speed = target
        slope, straight = _slope(climb, 0.03, rng), rng.uniform(10.0, 60.0)
        climb += slope * speed * straight
        yield Segment(straight, 0.0, 0.0, slope)
        radius = rng.uniform(800.0, 4000.0)
        angle = rng.choice([-1.0, 1.0]) * rng.uniform(5.0, 40.0) * DEG
        yield from _turn(
            angle, speed / radius, slope, float(np.sign(angle)) * min(0.05, speed**2 / radius / 9.8)
        )
        if rng.random() < 0.5:
            yield from _wiggle(
                rng.choice([-1.0, 1.0]) * rng.uniform(1.5, 3.0) * DEG, rng.uniform(2.0, 3.5), slope
            )


def _mixed(rng: Generator) -> Iterator[Segment]:
    while True:
        for drive in (_urban, _highway):
            yield from _some(drive(rng), rng.uniform(90.0, 240.0))


def _some(drive: Iterator[Segment], seconds: float) -> Iterator[Segment]:
    """The first part of a drive that begins at rest, and a stop after it."""
    speed = gone = 0.0
    while gone < seconds:
        s = next(drive)
        speed, gone = speed + s.acceleration * s.duration, gone + s.duration
        yield s
    yield from _change(speed, 0.0, 1.5)
    yield Segment(5.0)


def _carpark(rng: Generator) -> Iterator[Segment]:
    while True:
        speed = rng.uniform(5.0, 12.0) * KMH
        yield from _change(0.0, speed, rng.uniform(0.6, 1.2))
        for _ in range(rng.integers(2, 6)):
            yield Segment(rng.uniform(3.0, 12.0))
            angle = rng.choice([-1.0, 1.0]) * rng.choice([90.0, 180.0]) * DEG
            ramp = rng.choice([0.0, 0.0, 0.1, -0.1]) if abs(angle) > 2.0 else 0.0
            yield from _turn(angle, speed / rng.uniform(5.5, 8.0), ramp)
        yield from _change(speed, 0.0, rng.uniform(0.8, 1.5))
        yield Segment(rng.uniform(3.0, 20.0))
