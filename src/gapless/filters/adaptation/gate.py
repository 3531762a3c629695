"""The innovation gate: doubt softly, reject only the absurd, never lock good fixes out for good.

An observation beyond the soft bound has its R inflated in proportion, so a fix that is a little
off still counts a little; beyond the hard bound it is rejected. When surprising observations agree
with each other for long enough, the filter is the suspect: the gate then asks for P to be widened
by what they say, and they get in.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple, Self

import numpy as np

from gapless.recording import Array

SOFT = {1: 6.63, 2: 9.21, 3: 11.34, 6: 16.81}
"""99 % quantiles of chi-square by dimension."""


class Verdict(NamedTuple):
    """What to do with an observation.

    Parameters
    ----------
    factor : float
        On R: 1 as stated, more where doubted, inf where rejected.
    widen : bool
        Add z z' to P first: the filter is wrong, not the observation.
    """

    factor: float
    widen: bool


_AS_STATED = Verdict(1.0, False)


class _Run(NamedTuple):
    """Surprising observations in a row that agree with each other."""

    start: float
    length: int
    last: float
    z: Array
    after_gap: bool


@dataclass
class Gate:
    """One gate for all channels.

    Parameters
    ----------
    hard : float
        Rejection bound, in multiples of the soft bound.
    slope : float
        How fast R grows beyond the soft bound.
    gap : float
        Seconds without an accepted observation after which two that agree are believed.
    patience : float
        Seconds of agreement after which they are believed in any case.
    large : dict of str to (float, float)
        By channel: how large the disagreement must be to suspect the filter without a gap
        (smaller ones are left to the inflated R: a fix that is a few metres wrong for some
        seconds is common, a filter that is 30 m wrong beside good fixes is not), and beyond what
        it is the reading that is absurd (no filter beside good fixes is 60 m/s wrong).
    """

    hard: float = 1e3
    slope: float = 1.5
    gap: float = 5.0
    patience: float = 5.0
    large: dict[str, tuple[float, float]] = field(
        default_factory=lambda: {"position": (30.0, math.inf), "velocity": (3.0, 60.0)}
    )
    accepted: dict[str, float] = field(default_factory=dict)
    runs: dict[str, _Run] = field(default_factory=dict)

    def judge(self, channel: str, time: float, z: Array, nis: float, r: Array) -> Verdict:
        """Verdict on an observation, and the memory of it.

        Parameters
        ----------
        channel : str
        time : float
            [s]
        z : ndarray, shape (m,)
            Innovation.
        nis : float
            z' S^-1 z.
        r : ndarray, shape (m, m)
            As stated.

        Returns
        -------
        Verdict
        """
        soft = SOFT[z.size]
        if nis <= soft:
            self.accepted[channel] = time
            self.runs.pop(channel, None)
            return _AS_STATED
        run = self._extend(channel, time, z, np.sqrt(np.diag(r)))
        if self._believe(channel, run, z):
            self.accepted[channel] = time
            self.runs.pop(channel, None)
            return Verdict(1.0, True)
        if not nis <= soft * self.hard:
            return Verdict(math.inf, False)
        return Verdict(self.slope * nis / soft, False)

    def _extend(self, channel: str, time: float, z: Array, sd: Array) -> _Run:
        run = self.runs.get(channel)
        gap = time - self.accepted.get(channel, time) > self.gap
        agree = False
        if run is not None:
            slack = 4.0 * sd + 0.2 * float(np.linalg.norm(z)) + 1.0 * (time - run.last)
            agree = bool(np.all(np.abs(z - run.z) <= slack))
        if run is None or not agree:
            run = _Run(time, 1, time, z, gap)
        else:
            run = _Run(run.start, run.length + 1, time, z, run.after_gap)
        self.runs[channel] = run
        return run

    def _believe(self, channel: str, run: _Run, z: Array) -> bool:
        if channel not in self.large:
            return False
        if run.after_gap:
            return run.length >= 2 and run.last - run.start >= 0.5
        least, most = self.large[channel]
        return (
            least < float(np.linalg.norm(z[:2])) < most
            and run.length >= 4
            and run.last - run.start >= self.patience
        )

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Gate
        """
        return type(self)(
            self.hard, self.slope, self.gap, self.patience, self.large, dict(self.accepted), dict(self.runs)
        )
