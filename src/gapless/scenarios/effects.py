"""What an outage does to the fixes: takes them away, spoils them, or spoils those at its edges."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless.trip.motion import displace
from gapless.trip.recording import Array, Gnss

_PER_SECOND: Final = 0.1
"""A velocity goes wrong by this many m/s for each metre of its position."""
_SPIKES_AFTER: Final = 3
"""Fixes after an outage that are spikes."""
_JUST_BEFORE: Final = 2.0
"""An older fix [s] is not the last before an outage: the log may only not have come to it yet."""
WRONG_FOR: Final = 10.0
"""How long a fix that returns wrong stays so [s]."""


@dataclass(frozen=True, order=True)
class Effect:
    """What happens to the fixes of an outage.

    Parameters
    ----------
    name : str
        A key of `KINDS`.
    size : float
        How much of it, in the unit of its kind; 0 where there is no more and less.
    seed : int
        Of what is drawn.
    """

    name: str
    size: float = 0.0
    seed: int = 0

    @property
    def lasting(self) -> float:
        """How long after the outage's end fixes are still touched [s]; that time is scored too."""
        return KINDS[self.name].lasting

    def __str__(self) -> str:
        size = f":{self.size:.10g}" if self.size else ""
        return self.name + size + (f":{self.seed}" if self.seed else "")

    def apply(self, gnss: Gnss, begin: float, end: float) -> Gnss:
        """What the receiver would have logged.

        What is drawn depends on the seed and on `begin` only: neither on other outages nor on what
        is logged later.

        Parameters
        ----------
        gnss : Gnss
        begin, end : float
            Logged stamps [s] of the outage.

        Returns
        -------
        Gnss
        """
        rng = np.random.default_rng([self.seed, round(abs(begin) * 1000.0)])
        return KINDS[self.name].apply(gnss, begin, end, self.size, rng)


class Kind(NamedTuple):
    """A kind of effect.

    Parameters
    ----------
    apply : callable
        (gnss, begin, end, size, rng) -> gnss.
    size : float
        The default; 0 where the kind takes none.
    unit : str
    what : str
        For people.
    lasting : float
        [s] after the end that it reaches.
    """

    apply: Callable[[Gnss, float, float, float, Generator], Gnss]
    size: float
    unit: str
    what: str
    lasting: float = 0.0


def _inside(gnss: Gnss, begin: float, end: float) -> NDArray[np.bool_]:
    return np.asarray((gnss.time >= begin) & (gnss.time < end))


def _moved(gnss: Gnss, rows: NDArray[np.intp], ned: Array, velocity: bool = True) -> Gnss:
    lla, v_n = gnss.lla.copy(), gnss.v_n.copy()
    lla[rows] = displace(lla[rows], ned)
    if velocity:
        v_n[rows] += _PER_SECOND * ned
    return replace(gnss, lla=lla, v_n=v_n)


def _aside(size: float, bearing: Array) -> Array:
    return size * np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(len(bearing))])


def _silent(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    return gnss.take(~_inside(gnss, begin, end))


def _noisy(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    rows = np.flatnonzero(_inside(gnss, begin, end))
    return _moved(gnss, rows, size * rng.standard_normal((len(rows), 3)))


def _biased(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    rows = np.flatnonzero(_inside(gnss, begin, end))
    return _moved(gnss, rows, _aside(size, np.full(len(rows), rng.uniform(0.0, math.tau))), velocity=False)


def _thinned(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    keep, last = ~_inside(gnss, begin, end), -math.inf
    for i in np.flatnonzero(~keep):
        if gnss.time[i] - last >= 1.0 / size - 1e-3:  # s: stamps are not that exact
            keep[i], last = True, gnss.time[i]
    return gnss.take(keep)


def _velocity(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    lla = np.where(_inside(gnss, begin, end)[:, None], np.nan, gnss.lla)
    return replace(gnss, lla=lla)


def _spiked(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    jumps = _aside(size, rng.uniform(0.0, math.tau, 1 + _SPIKES_AFTER))
    first, after = np.searchsorted(gnss.time, [begin, end])
    back = np.arange(after, min(after + _SPIKES_AFTER, len(gnss)))
    struck = _moved(gnss, back, jumps[1 : 1 + len(back)])
    if first > 0 and begin - gnss.time[first - 1] <= _JUST_BEFORE:
        struck = _moved(struck, np.array([first - 1]), jumps[:1])
    return _silent(struck, begin, end, size, rng)


def _wrong(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    return _silent(_biased(gnss, end, end + WRONG_FOR, size, rng), begin, end, size, rng)


def _real(gnss: Gnss, begin: float, end: float, size: float, rng: Generator) -> Gnss:
    return gnss


KINDS: Final = {
    "silent": Kind(_silent, 0.0, "", "no fixes"),
    "noisy": Kind(_noisy, 10.0, "m", "white noise added, a tenth of it per second to the velocity"),
    "biased": Kind(_biased, 20.0, "m", "positions off by a constant"),
    "thinned": Kind(_thinned, 2.0, "Hz", "fewer fixes"),
    "velocity": Kind(_velocity, 0.0, "", "velocity only"),
    "spiked": Kind(
        _spiked, 100.0, "m", "no fixes; the last before and the first three after are spikes", 5.0
    ),
    "wrong": Kind(_wrong, 20.0, "m", "no fixes; for 10 s after they are off by a constant", WRONG_FOR),
    "real": Kind(_real, 0.0, "", "nothing is withheld: a gap of the recording's own"),
}
"""Every kind of effect. Stated standard deviations stay as they are: the receiver does not own up."""

SILENT: Final = Effect("silent")
