"""The innovation gate: doubt softly, reject only the absurd, never lock good fixes out for good.

An observation beyond the soft bound has its R inflated in proportion, so a fix that is a little
off still counts a little; beyond the hard bound it is rejected. Where surprising observations agree
with each other for long enough, they get in (`relock`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

from msgspec import Meta

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.filters.adaptation.relock import Relock, RelockTable, soft_bound


class GateTable(RelockTable, forbid_unknown_fields=True, frozen=True):
    """`hard` bound of rejection in multiples of the soft one, `slope` of R beyond that.

    `gap` and `patience` are those of `relock`.
    """

    hard: Annotated[float, Meta(ge=1.0)] = 1e3
    slope: Annotated[float, Meta(ge=1.0)] = 1.5


@dataclass
class Gate:
    """One gate for all channels.

    Parameters
    ----------
    table : GateTable
    relock : Relock, optional
        Its memory of surprises.
    """

    table: GateTable = field(default_factory=GateTable)
    relock: Relock | None = None
    Table: ClassVar[type[GateTable]] = GateTable
    role: ClassVar[Role] = "test"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def __post_init__(self) -> None:
        self.relock = self.relock or Relock(self.table)

    def judge(self, innovation: Innovation) -> Verdict:
        """R as stated, inflated, or none; see `Adaptation.judge`."""
        assert self.relock is not None
        verdict = self.relock.judge(innovation)
        nis, soft = innovation.nis, soft_bound(innovation.z.size)
        if nis <= soft or verdict.widen:
            return verdict
        if not nis <= soft * self.table.hard:
            return Verdict(None)
        return Verdict(innovation.r * (self.table.slope * nis / soft))

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Gate
        """
        assert self.relock is not None
        return type(self)(self.table, self.relock.copy())
