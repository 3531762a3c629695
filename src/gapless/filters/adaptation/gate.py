"""The innovation gate: doubt softly, reject only the absurd, never lock good fixes out for good.

An observation beyond the soft bound has its R inflated in proportion, so a fix that is a little
off still counts a little; beyond the hard bound it is rejected. When surprising observations agree
with each other for long enough, the filter is the suspect: the gate then asks for P to be widened
by what they say, and they get in.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, NamedTuple, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.filters.quantile import chi_square_quantile
from gapless.recording import Array

SOFT = {1: 6.63, 2: 9.21, 3: 11.34, 6: 16.81}
"""99 % quantiles of chi-square by dimension."""


class GateTable(Struct, forbid_unknown_fields=True, frozen=True):
    """`hard` bound of rejection in multiples of the soft one, `slope` of R beyond that.

    `gap`: seconds without an accepted observation after which two that agree are believed; `patience`:
    seconds of agreement after which they are believed in any case.
    """

    hard: Annotated[float, Meta(ge=1.0)] = 1e3
    slope: Annotated[float, Meta(ge=1.0)] = 1.5
    gap: Annotated[float, Meta(ge=0.0)] = 5.0
    patience: Annotated[float, Meta(ge=0.0)] = 5.0


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
    table : GateTable
    large : dict of str to (float, float)
        By channel: how large the disagreement must be to suspect the filter without a gap
        (smaller ones are left to the inflated R: a fix that is a few metres wrong for some
        seconds is common, a filter that is 30 m wrong beside good fixes is not), and beyond what
        it is the reading that is absurd (no filter beside good fixes is 60 m/s wrong).
    """

    table: GateTable = field(default_factory=GateTable)
    large: dict[str, tuple[float, float]] = field(
        default_factory=lambda: {"position": (30.0, math.inf), "velocity": (3.0, 60.0)}
    )
    accepted: dict[str, float] = field(default_factory=dict)
    runs: dict[str, _Run] = field(default_factory=dict)
    Table: ClassVar[type[GateTable]] = GateTable
    role: ClassVar[Role] = "test"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R as stated, inflated, or none; see `Adaptation.judge`."""
        channel, time, z, _, r, nis = innovation
        soft = SOFT.get(z.size) or chi_square_quantile(0.99, z.size)
        if nis <= soft:
            self.accepted[channel] = time
            self.runs.pop(channel, None)
            return Verdict(r)
        run = self._extend(channel, time, z, np.sqrt(np.diag(r)))
        if self._believe(channel, run, z):
            self.accepted[channel] = time
            self.runs.pop(channel, None)
            return Verdict(r, widen=True)
        if not nis <= soft * self.table.hard:
            return Verdict(None)
        return Verdict(r * (self.table.slope * nis / soft))

    def _extend(self, channel: str, time: float, z: Array, sd: Array) -> _Run:
        run = self.runs.get(channel)
        gap = time - self.accepted.get(channel, time) > self.table.gap
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
            and run.last - run.start >= self.table.patience
        )

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Gate
        """
        return type(self)(self.table, self.large, dict(self.accepted), dict(self.runs))
