"""Receivers that lie: they repeat themselves, jump, drift, invent. What they state stays as it was."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.random import Generator

from gapless.simulate.faults.base import (
    Fault,
    Mask,
    Pair,
    Span,
    ahead,
    struck,
    truth,
    withheld,
)
from gapless.trip.motion import displace, offset_ned
from gapless.trip.recording import Array, Gnss, Recording

_DRIVING: Final = 5.0
"""Speed [m/s] at which a fault that needs a driving car begins."""
_STOP: Final = 8.0
"""How long a stop must last for a fault at rest [s]."""


def while_driving(log: Recording, span: Span) -> Span:
    """From the next moment at which the car drives."""
    time, speed = ahead(log)
    later = time[(time >= span[0]) & (np.abs(speed) > _DRIVING)]
    late = float(later[0]) - span[0] if len(later) else 0.0
    return span[0] + late, span[1] + late


def at_a_stop(log: Recording, span: Span) -> Span:
    """The next stop, or the last one before; its second second to its last."""
    time, speed = ahead(log)
    edges = np.flatnonzero(np.diff((np.abs(speed) < 0.01).astype(int), prepend=0, append=0))
    stops = [(time[a] + 1.0, time[b - 1] - 1.0) for a, b in edges.reshape(-1, 2)]
    long = [(float(a), float(b)) for a, b in stops if b - a > _STOP]
    return next((s for s in long if s[0] >= span[0]), long[-1] if long else (span[0], span[0]))


def _before(gnss: Gnss, rows: Mask) -> int:
    """The last row before a span, or its first."""
    first = int(np.argmax(rows)) if rows.any() else 0
    return max(first - 1, 0)


def _offset(size: float, chance: Generator) -> Array:
    bearing = chance.uniform(0.0, 2.0 * np.pi)
    return size * np.array([math.cos(bearing), math.sin(bearing), 0.0])


def _displaced(gnss: Gnss, rows: Mask, ned: Array) -> Gnss:
    lla = gnss.lla.copy()
    lla[rows] = displace(lla[rows], np.broadcast_to(ned, (int(rows.sum()), 3)))
    return replace(gnss, lla=lla)


def _repeated(gnss: Gnss, rows: Mask, column: str) -> Gnss:
    values = getattr(gnss, column).copy()
    values[rows] = values[_before(gnss, rows)]
    return replace(gnss, **{column: values})


def _still(gnss: Gnss, rows: Mask) -> Gnss:
    return replace(gnss, v_n=np.where(rows[:, None], 0.0, gnss.v_n))


def repeats(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Position and velocity, to the bit."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _repeated(_repeated(log.gnss, rows, "lla"), rows, "v_n"), rows)


def repeats_nearly(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Both, with a little noise on top."""
    rows = struck(log.gnss.time, span)
    gnss = _repeated(_repeated(log.gnss, rows, "lla"), rows, "v_n")
    noise = size * chance.standard_normal((2, int(rows.sum()), 3))
    gnss = _displaced(gnss, rows, noise[0])
    gnss.v_n[rows] += noise[1]
    return withheld(log, gnss, rows)


def repeats_position(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """The position, beside a velocity that lives."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _repeated(log.gnss, rows, "lla"), rows)


def repeats_velocity(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """The velocity, beside a position that lives."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _repeated(log.gnss, rows, "v_n"), rows)


def stands(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """The position, and says that it does not move."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _still(_repeated(log.gnss, rows, "lla"), rows), rows)


def coasts(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Straight on at the last velocity."""
    rows = struck(log.gnss.time, span)
    k = _before(log.gnss, rows)
    gnss = _repeated(_repeated(log.gnss, rows, "lla"), rows, "v_n")
    since = gnss.time[rows] - gnss.time[k]
    return withheld(log, _displaced(gnss, rows, since[:, None] * gnss.v_n[k]), rows)


def jumps(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Off to one side, and back."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _displaced(log.gnss, rows, _offset(size, chance)), rows)


def jumps_up(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Too high or too low, and back."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _displaced(log.gnss, rows, np.array([0.0, 0.0, chance.choice([-size, size])])), rows)


def _moved(log: Recording, span: Span, ned: Array) -> Pair:
    """For good: truth goes along, and there is nothing to withhold."""
    t, rows = truth(log), struck(log.gnss.time, span)
    later = t.time >= span[0]
    lla = t.lla.copy()
    lla[later] = displace(lla[later], np.broadcast_to(ned, (int(later.sum()), 3)))
    gnss = _displaced(log.gnss, rows, ned)
    return Pair(replace(log, gnss=gnss, reference=replace(t, lla=lla)), log)


def moves(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Into another frame, aside."""
    return _moved(log, span, _offset(size, chance))


def moves_up(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Into another frame of heights."""
    return _moved(log, span, np.array([0.0, 0.0, chance.choice([-size, size])]))


def drifts(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Off at rest, at a steady speed that its velocity owns up to or not."""
    rows = struck(log.gnss.time, span)
    drift, told = _offset(size, chance), chance.random() < 0.5
    gnss = _displaced(log.gnss, rows, (log.gnss.time[rows] - span[0])[:, None] * drift)
    return withheld(log, replace(gnss, v_n=gnss.v_n + told * rows[:, None] * drift), rows)


def holds(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Its last position while the car stands, as many receivers are set to: no fault."""
    return stands(log, span, size, chance)


def says_zero(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Velocity zero, beside a position that lives."""
    rows = struck(log.gnss.time, span)
    return withheld(log, _still(log.gnss, rows), rows)


def says_zero_at_times(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Velocity zero in a share of the rows."""
    rows = struck(log.gnss.time, span) & (chance.random(len(log.gnss)) < size)
    return withheld(log, _still(log.gnss, rows), rows)


def fills_in(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Through a tunnel in a straight line from its mouth to its end."""
    gnss, rows = log.gnss, struck(log.gnss.time, span)
    if not rows.any():
        return withheld(log, gnss, rows)
    a, b = _before(gnss, rows), min(int(np.flatnonzero(rows)[-1]) + 1, len(gnss) - 1)
    way, time = (
        offset_ned(gnss.lla[b : b + 1], gnss.lla[a : a + 1])[0],
        max(gnss.time[b] - gnss.time[a], 1e-3),
    )
    v = way / time
    gnss = _displaced(_repeated(gnss, rows, "lla"), rows, (gnss.time[rows] - gnss.time[a])[:, None] * v)
    return withheld(log, replace(gnss, v_n=np.where(rows[:, None], v, gnss.v_n)), rows)


def comes_back(log: Recording, span: Span, size: float, chance: Generator) -> Pair:
    """Nothing in a tunnel, the first half; then positions off, that glide back smoothly."""
    gnss, rows = log.gnss, struck(log.gnss.time, span)
    middle, fading = 0.5 * (span[0] + span[1]), 0.1 * (span[1] - span[0])
    late = rows & (gnss.time >= middle)
    off = _offset(size, chance) * np.exp(-(gnss.time[late] - middle) / fading)[:, None]
    v_n = gnss.v_n.copy()
    v_n[late] -= off / fading
    gnss = replace(_displaced(gnss, late, off), v_n=v_n)
    return Pair(replace(log, gnss=gnss.take(~rows | late)), replace(log, gnss=log.gnss.take(~rows)))


SHORT: Final = (5.0, 60.0)
FAR: Final = {"size": (10.0, 60.0), "unit": "m"}
TUNNEL: Final = {"length": (20.0, 80.0), "when": while_driving}
STOP: Final = {"when": at_a_stop, "drive": "urban"}
DRIFT: Final = {**STOP, "size": (0.1, 0.5), "unit": "m/s"}
DRIVING: Final = {"length": SHORT, "when": while_driving}

KINDS: Final[Mapping[str, Fault]] = {
    name: Fault("receiver", text, plant, **more)
    for name, text, plant, more in (
        ("repeats", "repeats position and velocity to the bit", repeats, DRIVING),
        (
            "repeats-nearly",
            "repeats both within a centimetre or so",
            repeats_nearly,
            {**DRIVING, "size": (0.002, 0.02), "unit": "m"},
        ),
        ("repeats-position", "repeats the position, its velocity lives", repeats_position, DRIVING),
        ("repeats-velocity", "repeats the velocity, its position lives", repeats_velocity, DRIVING),
        ("stands", "repeats the position with a velocity of zero", stands, DRIVING),
        ("coasts", "goes straight on at its last velocity", coasts, DRIVING),
        ("jumps", "is off to one side for a while", jumps, {**FAR, "length": SHORT}),
        ("jumps-up", "is off in height for a while", jumps_up, {**FAR, "length": SHORT}),
        ("moves", "is off to one side for good", moves, FAR),
        ("moves-up", "is off in height for good", moves_up, FAR),
        (
            "drifts",
            "drifts off while the car stands",
            drifts,
            {**STOP, "size": (0.1, 0.5), "unit": "m/s"},
        ),
        ("holds", "holds its position while the car stands, which is no fault", holds, STOP),
        ("says-zero", "says that the car stands while it drives", says_zero, DRIVING),
        (
            "says-zero-at-times",
            "says so in a share of its rows",
            says_zero_at_times,
            {"size": (0.05, 0.5), "unit": "of the rows"},
        ),
        ("fills-in", "goes straight through a tunnel, from mouth to end", fills_in, TUNNEL),
        ("comes-back", "comes out of a tunnel aside, and glides back", comes_back, {**FAR, **TUNNEL}),
    )
}
"""By name."""
