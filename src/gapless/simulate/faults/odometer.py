"""Odometers that lie. What it is compared with has none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless.simulate.faults.base import Fault, Mask, Pair, Plant, Span, struck, throughout
from gapless.simulate.faults.receiver import while_driving
from gapless.trip.recording import Array, Recording

_EARLY: Final = 60.0
"""After so many seconds dies what dies early."""


def soon(log: Recording, span: Span) -> Span:
    """From the first minute on."""
    return log.start + _EARLY, np.inf


def _read(says: Callable[[Array, Mask, float], Array]) -> Plant:
    """A fault of an odometer from what it says: of its speeds, where it lies, and the size."""

    def plant(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
        if log.odometer is None:
            return Pair(log, log)
        rows = struck(log.odometer.time, span)
        speed = np.where(rows, says(log.odometer.speed, rows, size), log.odometer.speed)
        faulted = replace(log, odometer=replace(log.odometer, speed=speed))
        return Pair(faulted, replace(log, odometer=None))

    return plant


def _last(speed: Array, rows: Mask, size: float) -> Array:
    return np.full_like(speed, speed[max(int(np.argmax(rows)) - 1, 0)])


zero = _read(lambda speed, rows, size: np.zeros_like(speed))
"""Reads zero."""
sticks = _read(_last)
"""Reads its last value."""
unsigned = _read(lambda speed, rows, size: np.abs(speed))
"""Counts ticks and knows no reverse."""
steps = _read(lambda speed, rows, size: size * np.rint(speed / size))
"""Reads whole steps."""
slips = _read(lambda speed, rows, size: (1.0 + size) * speed)
"""Reads too much."""

KINDS: Final[Mapping[str, Fault]] = {
    "odometer-stands": Fault("odometer", "reads zero for good", zero, when=while_driving),
    "odometer-stands-a-while": Fault(
        "odometer", "reads zero for a while", zero, length=(5.0, 60.0), when=while_driving
    ),
    "odometer-dies-early": Fault("odometer", "reads zero from the first minute on", zero, when=soon),
    "odometer-sticks": Fault("odometer", "reads one value for good", sticks, when=while_driving),
    "odometer-unsigned": Fault(
        "odometer", "has no sign in reverse", unsigned, when=throughout, drive="dead ends"
    ),
    "odometer-steps": Fault(
        "odometer", "counts in steps", steps, size=(0.1, 1.0), unit="m/s", when=throughout
    ),
    "odometer-slips": Fault(
        "odometer",
        "reads too much for seconds",
        slips,
        size=(10.0, 50.0),
        unit="%",
        scale=0.01,
        length=(2.0, 20.0),
        when=while_driving,
    ),
}
"""By name."""
