"""When surprising fixes agree with each other, the filter is the suspect: widen P, and let them in.

A rule that drops improbable fixes would drop them for good once the filter is surely wrong, after an
outage most of all. This one goes before it, and is part of the gate.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Final, NamedTuple, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.filters.quantile import chi_square_quantile
from gapless.trip.recording import Array

SOFT = {1: 6.63, 2: 9.21, 3: 11.34, 6: 16.81}
"""99 % quantiles of chi-square by dimension: beyond them an observation is surprising."""
LARGE = {"position": (30.0, math.inf), "velocity": (3.0, 60.0)}
"""By channel: how large the disagreement must be to suspect the filter without a gap (smaller ones are
left to an inflated R: a fix that is a few metres wrong for some seconds is common, a filter that is 30 m
wrong beside good fixes is not), and beyond what it is the reading that is absurd (no filter beside good
fixes is 60 m/s wrong)."""

OBSTINATE: Final = 20.0
"""For so long must fixes that another sensor denies agree with each other; receivers err for less [s]."""


class RelockTable(Struct, forbid_unknown_fields=True, frozen=True):
    """`gap`: seconds without an accepted observation after which two that agree are believed.

    `patience`: seconds of agreement after which they are believed in any case.
    """

    gap: Annotated[float, Meta(ge=0.0)] = 5.0
    patience: Annotated[float, Meta(ge=0.0)] = 5.0


class _Run(NamedTuple):
    """Surprising observations in a row that agree with each other."""

    start: float
    length: int
    last: float
    z: Array
    after_gap: bool


def soft_bound(size: int) -> float:
    """The 99 % quantile of chi-square.

    Parameters
    ----------
    size : int
        Degrees of freedom.

    Returns
    -------
    float
    """
    return SOFT.get(size) or chi_square_quantile(0.99, size)


@dataclass
class Relock:
    """Believes surprising fixes that agree for long enough.

    Parameters
    ----------
    table : RelockTable
    """

    table: RelockTable = field(default_factory=RelockTable)
    accepted: dict[str, float] = field(default_factory=dict)
    runs: dict[str, _Run] = field(default_factory=dict)
    Table: ClassVar[type[RelockTable]] = RelockTable
    role: ClassVar[Role] = "recovery"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R as stated, with or without doubt in the filter; see `Adaptation.judge`."""
        channel, time, z, _, r, nis, denied = innovation
        doubted = nis > soft_bound(z.size) or math.isnan(nis)
        if doubted:
            run = self._extend(channel, time, z, np.sqrt(np.diag(r)))
            if not self._believe(channel, run, z, denied):
                return Verdict(r)
        self.accepted[channel] = time
        self.runs.pop(channel, None)
        return Verdict(r, widen=doubted)

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

    def _believe(self, channel: str, run: _Run, z: Array, denied: bool) -> bool:
        if channel not in LARGE or (denied and run.last - run.start < OBSTINATE):
            return False
        if run.after_gap:
            return run.length >= 2 and run.last - run.start >= 0.5
        least, most = LARGE[channel]
        return (
            least < float(np.linalg.norm(z[:2])) < most
            and run.length >= 4
            and run.last - run.start >= self.table.patience
        )

    def copy(self) -> Self:
        """An independent rule; see `Adaptation.copy`."""
        return type(self)(self.table, dict(self.accepted), dict(self.runs))
