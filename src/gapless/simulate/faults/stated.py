"""Clocks and lever arms that are not what is said, and a drive that begins in reverse."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless import attitude
from gapless.simulate.faults.base import Fault, Pair, Plant, Span, ahead, throughout, truth
from gapless.trip.motion import displace
from gapless.trip.recording import Array, Gnss, Recording

_LATE: Final = 0.8
"""A stamp is late by no more than this share of the time between fixes."""
_HALF: Final = 0.1
"""Half the window that the velocity of an antenna is taken from [s]."""


def _clock(late: Callable[[Array, Span, float, Generator], Array]) -> Plant:
    """Stamps of fixes that are late by what is given; those that time would go back with are lost."""

    def plant(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
        time = log.gnss.time + late(log.gnss.time, span, size, chance)
        rows = np.diff(np.maximum.accumulate(time), prepend=-np.inf) > 0.0
        return Pair(replace(log, gnss=replace(log.gnss, time=time).take(rows)), log)

    return plant


def _constant(time: Array, span: Span, size: float, chance: Generator) -> Array:
    return np.where(time >= span[0], chance.choice([-size, size]), 0.0)


def _drift(time: Array, span: Span, size: float, chance: Generator) -> Array:
    return np.asarray(chance.choice([-size, size]) * (time - time[0]))


def _jitter(time: Array, span: Span, size: float, chance: Generator) -> Array:
    most = min(size, _LATE * float(np.median(np.diff(time))))
    return chance.uniform(0.0, most, len(time))


def _at_arm(log: Recording, arm: Array) -> Gnss:
    """Fixes of an antenna that sits elsewhere, by metres in the box's axes."""
    t, gnss = truth(log), log.gnss

    def ned(time: Array) -> Array:
        angles = np.column_stack([np.interp(time, t.time, a) for a in np.unwrap(t.euler, axis=0).T])
        return np.asarray(attitude.to_matrix(attitude.from_euler(angles)) @ arm)

    swing = (ned(gnss.time + _HALF) - ned(gnss.time - _HALF)) / (2.0 * _HALF)
    return replace(gnss, lla=displace(gnss.lla, ned(gnss.time)), v_n=gnss.v_n + swing)


def _arm(told: Array) -> Plant:
    """An antenna that sits further off than is said; of its arm that share is told."""

    def plant(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
        aside = chance.uniform(-0.5, 0.5)
        arm = size * np.array([chance.choice([-1.0, 1.0]), aside, -0.3])
        had = np.zeros(3) if log.lever_arm is None else log.lever_arm
        right = replace(log, gnss=_at_arm(log, arm), lever_arm=had + arm)
        wrong = had + told * arm if told.any() else None
        return Pair(replace(right, lever_arm=wrong), right)

    return plant


def backing_out(log: Recording, span: Span) -> Span:
    """From the first sample until it drives forwards."""
    time, speed = ahead(log)
    backwards = int(np.argmax(speed < -0.5))
    onwards = backwards + int(np.argmax(speed[backwards:] > 0.5))
    return log.start, float(time[onwards])


def as_it_is(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Nothing but the drive itself."""
    return Pair(log, log.slice(span[1], np.inf))


_ALL: Final = {"when": throughout}

KINDS: Final[Mapping[str, Fault]] = {
    "clock-off": Fault("clock", "its stamps are off", _clock(_constant), (0.05, 0.3), "s", when=throughout),
    "clock-leaps": Fault("clock", "they are off from some moment on", _clock(_constant), (0.05, 0.3), "s"),
    "clock-drifts": Fault(
        "clock", "its clock runs fast or slow", _clock(_drift), (30.0, 300.0), "ppm", 1e-6, when=throughout
    ),
    "stamps-jitter": Fault(
        "clock", "stamped when bytes arrive", _clock(_jitter), (0.02, 0.2), "s", when=throughout
    ),
    "arm-untold": Fault("arm", "its arm is not told", _arm(np.zeros(3)), (1.0, 4.0), "m", when=throughout),
    "arm-mirrored": Fault(
        "arm", "its forward and right are told with the wrong sign", _arm(np.array([-1.0, -1.0, 1.0])),
        (1.0, 4.0), "m", when=throughout,
    ),
    "starts-reversing": Fault(
        "drive", "the car backs out before it drives", as_it_is, when=backing_out, drive="backs out"
    ),
}  # fmt: skip
"""By name."""
