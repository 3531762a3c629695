"""What a fault is, how its severity and span are drawn, and how two of them come together."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless.trip.recording import Array, Gnss, Recording, Trajectory

Span = tuple[float, float]
"""From, until [s] on the IMU clock; until inf where a fault stays."""
Mask = NDArray[np.bool_]


class Pair(NamedTuple):
    """One recording twice.

    Parameters
    ----------
    faulted : Recording
        With the fault in it. Where positions move to another frame for good, so does its reference.
    spared : Recording
        What the fault is to be compared with: the fixes of the span withheld, no odometer, everything
        before the end of an inertial fault cut off, clocks and arms told rightly.
    """

    faulted: Recording
    spared: Recording


Plant = Callable[[Recording, Span, float, Generator], Pair]
"""Of a recording, the span [s], the size in SI units, and chance."""
When = Callable[[Recording, Span], Span]
"""Where a fault can be, of where it was asked for."""

FOR_GOOD: Final = (math.inf, math.inf)
DRIVES: Final = ("any", "urban", "dead ends", "backs out")
"""What a drive has to be for a fault to show: any; with stops; in reverse on the way; in reverse at first."""


def as_asked(log: Recording, span: Span) -> Span:
    """Where it was asked for."""
    return span


def throughout(log: Recording, span: Span) -> Span:
    """From the first stamp to the last."""
    stamps = (log.imu.time, log.gnss.time, *(() if log.odometer is None else (log.odometer.time,)))
    return min(float(time[0]) for time in stamps if len(time)), math.inf


@dataclass(frozen=True)
class Fault:
    """One kind of fault.

    Parameters
    ----------
    sensor : str
        Whose: "receiver", "odometer", "imu", "clock", "arm" or "drive".
    text : str
        What happens, in a clause.
    plant : callable
    size : tuple of 2 floats
        Least and greatest severity, drawn log-uniform, in `unit`; (1, 1) where how long it lasts is all.
    unit : str
    scale : float
        SI units of one `unit`.
    length : tuple of 2 floats
        Least and greatest duration [s], drawn log-uniform; inf for good.
    when : callable
        Moves the span to where there is something to spoil.
    drive : str
        One of `DRIVES`.
    """

    sensor: str
    text: str
    plant: Plant
    size: tuple[float, float] = (1.0, 1.0)
    unit: str = ""
    scale: float = 1.0
    length: tuple[float, float] = FOR_GOOD
    when: When = as_asked
    drive: str = "any"


@dataclass(frozen=True, eq=False)
class Planted:
    """A recording with one or two faults.

    Parameters
    ----------
    kind : str
        Names joined by " + ".
    faulted, spared : Recording
        As in `Pair`.
    spans : tuple of (float, float)
        Of each fault [s].
    sizes : tuple of float
        Of each, in the unit of its kind.
    """

    kind: str
    faulted: Recording
    spared: Recording
    spans: tuple[Span, ...]
    sizes: tuple[float, ...]

    @property
    def start(self) -> float:
        """When the first of them begins [s]; inf without any."""
        return min((a for a, _ in self.spans), default=math.inf)

    @property
    def end(self) -> float:
        """When the last that began has ended, or begun where it stays [s]; -inf without any."""
        return max((b if math.isfinite(b) else a for a, b in self.spans), default=-math.inf)


def log_uniform(bounds: tuple[float, float], chance: Generator) -> float:
    """A number between two, its logarithm uniform.

    Parameters
    ----------
    bounds : tuple of 2 floats
        > 0, or both inf.
    chance : numpy.random.Generator

    Returns
    -------
    float
    """
    low, high = bounds
    share = chance.random()
    return low if low == high else float(low * (high / low) ** share)


def plant(faults: Sequence[tuple[str, Fault]], log: Recording, times: Sequence[float], seed: int) -> Planted:
    """Plant faults one after the other.

    Parameters
    ----------
    faults : sequence of (str, Fault)
        By name; the name is part of the seed.
    log : Recording
        Simulated, with its truth.
    times : sequence of float
        When each is to begin [s]; it may be later, where the car has to drive, stand or reverse for it.
    seed : int

    Returns
    -------
    Planted
        The same for the same seed.
    """
    both = Pair(log, log)
    spans, sizes = [], []
    for (name, fault), at in zip(faults, times, strict=True):
        size, length, own = np.random.SeedSequence([seed, *name.encode()]).spawn(3)
        severity = log_uniform(fault.size, np.random.default_rng(size))
        span = fault.when(log, (at, at + log_uniform(fault.length, np.random.default_rng(length))))
        found = [fault.plant(one, span, severity * fault.scale, np.random.default_rng(own)) for one in both]
        both = Pair(found[0].faulted, found[1].spared)
        spans.append(span)
        sizes.append(severity)
    return Planted(" + ".join(name for name, _ in faults), *both, tuple(spans), tuple(sizes))


def struck(time: Array, span: Span) -> Mask:
    """Which stamps lie in a span.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    span : tuple of 2 floats

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    return np.asarray((time >= span[0]) & (time < span[1]))


def withheld(log: Recording, gnss: Gnss, rows: Mask) -> Pair:
    """Fixes of a receiver that lies, against none where it does.

    Parameters
    ----------
    log : Recording
    gnss : Gnss
        Its fixes with the fault.
    rows : ndarray of bool
        Those that lie.

    Returns
    -------
    Pair
    """
    return Pair(replace(log, gnss=gnss), replace(log, gnss=log.gnss.take(~rows)))


def truth(log: Recording) -> Trajectory:
    """The reference of a simulated recording.

    Parameters
    ----------
    log : Recording

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError
        If it has none: faults that depend on what the car does need one.
    """
    if log.reference is None:
        raise ValueError(f"{log.name} has no reference; plant faults in a recording that has one")
    return log.reference


def ahead(log: Recording) -> tuple[Array, Array]:
    """Times and forward speeds of the truth.

    Parameters
    ----------
    log : Recording

    Returns
    -------
    time, speed : ndarray, shape (n,)
        [s], and [m/s], negative in reverse. The box is taken to look ahead within 90 degrees.
    """
    t = truth(log)
    heading = t.euler[:, 2]
    return t.time, np.cos(heading) * t.v_n[:, 0] + np.sin(heading) * t.v_n[:, 1]
