"""IMUs whose zero moves, that clip, pause, or are moved. What each is compared with begins after it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless import attitude
from gapless.simulate.faults.base import Fault, Pair, Plant, Span, ahead, struck, truth
from gapless.trip.recording import Array, Imu, Recording
from gapless.units import DEG, MILLI_G

_FULL_SCALE: Final = 2000.0 * MILLI_G
"""Where a cheap accelerometer clips [m/s^2]."""
_EVERY: Final = 120.0
"""From one hole to the next [s]."""
_WARM: Final = (60.0, 180.0)
"""When a gyro warms up [s after the first sample]."""
_BUMP: Final = 0.08
"""How long a bump lasts [s]: up and down again."""


def _anew(log: Recording, imu: Imu, end: float) -> Pair:
    """A filter that goes on, against one that knows nothing of what was before."""
    faulted = replace(log, imu=imu)
    return Pair(faulted, faulted.slice(end, np.inf))


def _axis(chance: Generator) -> Array:
    return np.asarray(chance.choice([-1.0, 1.0]) * np.eye(3)[chance.integers(3)])


def warming(log: Recording, span: Span) -> Span:
    """The minutes after it was switched on."""
    return log.start + _WARM[0], log.start + _WARM[1]


def _rate(triad: str, course: Callable[[Array, Span], Array]) -> Plant:
    """A zero of the gyros (dtheta) or accelerometers (dvel) that moves along a course from 0 to 1."""

    def plant(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
        moved = (size * course(log.imu.time, span) * log.imu.dt)[:, None] * _axis(chance)
        imu = replace(log.imu, **{triad: getattr(log.imu, triad) + moved})
        return _anew(log, imu, span[1] if np.isfinite(span[1]) else span[0])

    return plant


def _step(time: Array, span: Span) -> Array:
    return (time > span[0]).astype(float)


def _ramp(time: Array, span: Span) -> Array:
    return np.clip((time - span[0]) / (span[1] - span[0]), 0.0, 1.0)


def clips(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Bumps of the road, more than it can measure."""
    imu = log.imu
    time, speed = ahead(log)
    at = span[0] + np.cumsum(chance.uniform(1.0, 4.0, 200))
    at = at[(at < span[1] - _BUMP) & (np.abs(np.interp(at, time, speed)) > 2.0)]
    felt = np.zeros(len(imu))
    for start in at:
        rows = struck(imu.time, (start, start + _BUMP))
        felt[rows] = size * np.sin(2.0 * np.pi * (imu.time[rows] - start) / _BUMP)
    force = imu.dvel / imu.dt[:, None] + felt[:, None] * np.array([0.3, 0.0, 1.0])
    kept = np.clip(force, -_FULL_SCALE, _FULL_SCALE) * imu.dt[:, None]
    rows = struck(imu.time, span)[:, None]
    return _anew(log, replace(imu, dvel=np.where(rows, kept, imu.dvel)), span[1])


def _turned(axis: int) -> Plant:
    """The box is turned about one of its axes, in no time, or in a second of which the gyros tell."""

    def plant(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
        imu, t = log.imu, truth(log)
        vector = chance.choice([-1.0, 1.0]) * size * np.eye(3)[axis]
        takes = chance.choice([1e-3, 1.0])
        share = np.clip((imu.time - span[0]) / takes, 0.0, 1.0)
        c = attitude.to_matrix(attitude.from_rotation_vector(-share[:, None] * vector))
        felt = np.diff(share, prepend=0.0)[:, None] * vector * (takes >= 1.0)
        dtheta, dvel = (np.einsum("nij,nj->ni", c, x) for x in (imu.dtheta, imu.dvel))
        own = np.clip((t.time - span[0]) / takes, 0.0, 1.0)[:, None] * vector
        turned = attitude.multiply(attitude.from_euler(t.euler), attitude.from_rotation_vector(own))
        after = replace(log, reference=replace(t, euler=attitude.to_euler(turned)))
        return _anew(after, replace(imu, dtheta=dtheta + felt, dvel=dvel), span[0] + takes)

    return plant


def holes_before(log: Recording, span: Span) -> Span:
    """From the first hole, up to the last, which is where it was asked for."""
    first = span[0] - _EVERY * np.floor(max(span[0] - log.start - 60.0, 0.0) / _EVERY)
    return float(first), span[0]


def pauses(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Samples are lost, every two minutes."""
    imu = log.imu
    lost = np.zeros(len(imu), bool)
    for start in np.arange(span[0], span[1] + 1.0, _EVERY):
        lost |= struck(imu.time, (start, start + size))
    return _anew(log, imu.take(~lost), span[1] + size)


_MOVED: Final = {"size": (10.0, 90.0), "unit": "deg", "scale": DEG}

KINDS: Final[Mapping[str, Fault]] = {
    "gyro-leaps": Fault("imu", "a gyro's zero leaps", _rate("dtheta", _step), (0.1, 3.0), "deg/s", DEG),
    "gyro-warms": Fault(
        "imu", "a gyro's zero drifts for two minutes", _rate("dtheta", _ramp), (0.2, 0.5), "deg/s", DEG,
        when=warming,
    ),
    "accelerometer-leaps": Fault(
        "imu", "an accelerometer's zero leaps", _rate("dvel", _step), (0.1, 1.0), "m/s^2"
    ),
    "clips": Fault(
        "imu", "bumps beyond 2 g are clipped", clips, (10.0, 40.0), "m/s^2", length=(30.0, 120.0)
    ),
    "box-turned": Fault("imu", "the box is turned about its down axis", _turned(2), **_MOVED),  # type: ignore[arg-type]
    "box-tipped": Fault("imu", "it is tipped about its right axis", _turned(1), **_MOVED),  # type: ignore[arg-type]
    "box-knocked-over": Fault("imu", "it falls about its forward axis", _turned(0), **_MOVED),  # type: ignore[arg-type]
    "imu-pauses": Fault(
        "imu", "samples are missing every two minutes", pauses, (0.2, 2.0), "s", when=holes_before
    ),
}  # fmt: skip
"""By name."""
