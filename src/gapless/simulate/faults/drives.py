"""Drives to plant faults in: profile, IMU, receiver and odometer drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless.simulate.drive import simulate
from gapless.simulate.motion import Vehicle
from gapless.simulate.path import Segment
from gapless.simulate.profiles import profile
from gapless.simulate.receivers import Receiver, WheelSensor
from gapless.trip.recording import Recording
from gapless.units import DEG

PROFILES: Final = ("urban", "highway", "mixed")
GRADES: Final = ("consumer", "consumer", "adis16448", "liu2019")
"""As often as they are listed."""


def receiver(chance: Generator) -> Receiver:
    """Two in three of single-point fixes, one of RTK; 1 to 10 Hz, as good as it says or better."""
    stated, rate = chance.uniform(1.0, 1.5), float(chance.choice([1.0, 1.0, 5.0, 10.0]))
    delay = float(chance.choice([0.0, 1.0]) * chance.uniform(0.0, 0.2))
    if chance.random() < 1.0 / 3.0:
        return Receiver(
            rate,
            (0.01, 0.01, 0.02),
            (0.01, 0.01, 0.02),
            60.0,
            (0.02, 0.02, 0.04),
            delay,
            delay,
            stated=stated,
            fix=4,
        )
    size = chance.uniform(0.7, 2.0)
    white, lasting = (tuple(size * np.array(x)) for x in ((0.5, 0.5, 1.0), (1.0, 1.0, 2.0)))
    return Receiver(rate, white, lasting, 60.0, (0.05, 0.05, 0.1), delay, delay, stated=stated)


def wheels(chance: Generator) -> WheelSensor:
    """An odometer that reads up to 2 % too much or too little."""
    return WheelSensor(scale=chance.uniform(-0.02, 0.02), noise=0.03)


def dead_ends(chance: Generator) -> tuple[Segment, ...]:
    """Into dead ends and out of them in reverse."""
    speed = chance.uniform(1.5, 4.0)
    go = [Segment(8.0, chance.uniform(1.0, 1.6)), Segment(25.0), Segment(6.0, 0.0, 15.0 * DEG), Segment(15.0)]
    go = [*go, Segment(8.0, -go[0].acceleration)]
    back = [Segment(4.0), Segment(5.0, -speed / 5.0), Segment(20.0), Segment(5.0, speed / 5.0), Segment(4.0)]
    return Segment(30.0), *go, *go, *(back + go) * 20


def backs_out(chance: Generator, duration: float) -> tuple[Segment, ...]:
    """Out of a garage in reverse, then through town."""
    speed, stay = chance.uniform(1.5, 6.5), chance.uniform(8.0, 20.0)
    out = (Segment(5.0, -speed / 5.0), Segment(stay), Segment(5.0, speed / 5.0), Segment(6.0))
    return Segment(30.0), *out, *profile("urban")(duration, chance)[1:]


def base(of: str, duration: float, seed: int, odometer: bool | None = None) -> Recording:
    """A drive without faults.

    Parameters
    ----------
    of : str
        One of `PROFILES`, or of `DRIVES`: "any" is one of `PROFILES` by chance.
    duration : float
        [s]
    seed : int
    odometer : bool, optional
        Whether it has one; by chance if not given.

    Returns
    -------
    Recording
        It states no grade: nobody tells a filter how good a sensor is.
    """
    chance = np.random.default_rng(np.random.SeedSequence([seed, 77]))
    roll, pitch, yaw = (float(a) * DEG for a in chance.normal(0.0, (2.0, 2.0, 4.0)))
    x, y, z = (float(a) for a in chance.uniform((-1.0, -0.5, -1.5), (1.0, 0.5, -0.5)))
    own, wheel = receiver(chance), wheels(chance)
    has = chance.random() < 0.5 if odometer is None else odometer
    grade = str(chance.choice(GRADES))
    driven: str | tuple[Segment, ...] = str(chance.choice(PROFILES)) if of == "any" else of
    if of == "dead ends":
        driven = dead_ends(chance)
    if of == "backs out":
        driven = backs_out(chance, duration)
    vehicle = Vehicle(antenna=(x, y, z), mounting=(roll, pitch, yaw))
    log = simulate(
        driven, grade, duration, seed, vehicle=vehicle, receiver=own, wheels=wheel if has else None
    )
    return replace(log, name=f"{of}-{grade}-{seed}", grade=None)
