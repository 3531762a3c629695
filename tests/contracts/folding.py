"""Short simulated drives, navigators over them, and all the bits that a law may compare."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

import numpy as np

from gapless.fold.feed import events
from gapless.fold.navigator import Navigator, Settings
from gapless.scenarios import Outage, withhold
from gapless.simulate import Receiver, Vehicle, WheelSensor, simulate
from gapless.simulate.faults import FAULTS
from gapless.systems.build import settings
from gapless.systems.recipe import System
from gapless.trip.events import Event, ImuBlock
from gapless.trip.recording import Recording
from gapless.units import DEG

CAR = Vehicle(imu=(1.2, 0.3, -0.6), antenna=(0.4, 0.1, -1.5), mounting=(0.0, 2.0 * DEG, -3.0 * DEG))
"""Nothing in one place and nothing straight, so that no term of any model is idle."""
CLOCKS = {
    "late": {"position": -0.15, "velocity": -0.6, "odometer": 0.3},
    "exact": {"position": 0.0, "velocity": 0.0},
    "early": {"position": 0.21, "velocity": 0.093, "odometer": -0.047},
}
"""What is added to each sensor's stamps; stamps that fall inside samples, and on them."""
OUTAGE, SILENCE = (72.0, 92.0), (127.0, 144.0)
"""Without GNSS; without IMU as well [s after the start]."""
HOLES = ((66.4, 66.7), (84.0, 85.5), (110.0, 112.0))
"""Without IMU for so short that it is bridged: between fixes, in the outage, over fixes [s]."""
FAULTY = {
    "receiver": (
        ("odometer-stands-a-while", 1.0, 48.0, 54.0),
        ("repeats", 1.0, 57.0, 66.0),
        ("moves", 25.0, 72.0, np.inf),
        ("repeats-nearly", 0.005, 136.0, 146.0),
    ),
    "imu": (
        ("box-knocked-over", 70.0, 60.0, np.inf),
        ("jumps", 25.0, 90.0, 98.0),
        ("gyro-leaps", 2.5, 100.0, np.inf),
        ("box-turned", 60.0, 133.0, np.inf),
    ),
}
"""Kind, size in its unit, from and until [s]; each kind of ruling is in one of them."""
SUDDEN = 2
"""A seed with which boxes move too fast for their gyros to tell."""
FAULTY_HOLES = ((61.5, 62.3), (84.0, 85.5), (110.0, 111.0), (125.0, 128.0))
"""Just after the box fell, among lies, at rest, and one that is too long to be bridged."""
MOUNTING = (np.array([0.03, -0.05]), np.array([0.02, 0.02]))


@cache
def recording(clock: str, rate: float, seed: int = 6, duration: float = 165.0) -> Recording:
    """An urban drive with an outage, holes in the IMU's log, and sensors on clocks of their own."""
    late = CLOCKS[clock]
    receiver = Receiver(rate=rate, position_delay=-late["position"], velocity_delay=-late["velocity"])
    wheels = WheelSensor(rate=5.0, delay=-late.get("odometer", 0.0), scale=0.01)
    log = simulate("urban", "consumer", duration, seed, vehicle=CAR, receiver=receiver, wheels=wheels)
    logged = np.ones(len(log.imu), bool)
    for begin, end in (SILENCE, *HOLES):
        logged &= (log.imu.time < begin) | (log.imu.time >= end)
    gnss = withhold(log.gnss, [Outage(*OUTAGE)], 0.0)
    return replace(log, imu=log.imu.take(logged), gnss=gnss)


@cache
def faulty(faults: str, clock: str, rate: float) -> Recording:
    """The same drive with faults of `FAULTY` in it, and holes about them."""
    late = CLOCKS[clock]
    receiver = Receiver(rate=rate, position_delay=-late["position"], velocity_delay=-late["velocity"])
    wheels = WheelSensor(rate=5.0, delay=-late.get("odometer", 0.0), scale=0.01)
    log = simulate("urban", "consumer", 165.0, 6, vehicle=CAR, receiver=receiver, wheels=wheels)
    for kind, size, begin, end in FAULTY[faults]:
        fault = FAULTS[kind]
        log = fault.plant(log, (begin, end), size * fault.scale, np.random.default_rng(SUDDEN)).faulted
    logged = np.ones(len(log.imu), bool)
    for begin, end in FAULTY_HOLES:
        logged &= (log.imu.time < begin) | (log.imu.time >= end)
    return replace(log, imu=log.imu.take(logged))


def prepared(log: Recording, clock: str, system: System | None = None) -> Settings:
    """Settings with every decision given, so that runs differ in nothing but their events."""
    return settings(system or System(), log, CLOCKS[clock], MOUNTING)


def fold(navigator: Navigator, feed: Iterable[Event]) -> Navigator:
    for event in feed:
        navigator.step(event)
    return navigator


def run(setup: Settings, log: Recording, clock: str) -> Navigator:
    return fold(Navigator(setup), events(log, CLOCKS[clock]))


def belief(navigator: Navigator) -> tuple[bytes, ...]:
    """State, covariance, what the kernel carries: every bit of the belief."""
    b = navigator.belief
    return b.x.tobytes(), b.P.tobytes(), b.memory.tobytes(), b.error.tobytes()


def rows(navigator: Navigator, start: float = -np.inf, end: float = np.inf) -> list[tuple[object, ...]]:
    """Journal rows in [start, end)."""
    j = navigator.journal
    found = zip(j.times, j.states, j.variances, j.shared, j.sources, strict=True)
    return [
        (t, x.tobytes(), p.tobytes(), common.tobytes(), s) for t, x, p, common, s in found if start <= t < end
    ]


def noticed(navigator: Navigator, end: float = np.inf) -> tuple[list[object], ...]:
    """Rulings, knocks and alignments before a time."""
    j = navigator.journal
    return tuple(
        [x for x in found if x[0] < end] for found in (j.rulings, [k[:2] for k in j.knocks], j.alignments)
    )


def heard(navigator: Navigator, skip: dict[str, int] | None = None) -> dict[str, list[tuple[object, ...]]]:
    """Innovations by channel, the first few left out."""
    skip = skip or {}
    found = {}
    for name, i in navigator.journal.innovations().items():
        all_ = zip(i.time, i.z, i.sd, i.nis, i.factor, strict=True)
        found[name] = [(t, z.tobytes(), s.tobytes(), n, f) for t, z, s, n, f in all_][skip.get(name, 0) :]
    return found


def singles(feed: Iterable[Event]) -> Iterable[Event]:
    """The same events with the IMU sample by sample, as a live feed brings them."""
    for event in feed:
        if isinstance(event, ImuBlock):
            for k in range(len(event.time)):
                yield event.rows(k, k + 1)
        else:
            yield event
