"""The fading filter: the past counts less, epoch by epoch."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict

EPOCH = "position"
"""The channel whose readings count epochs."""


class FadingTable(Struct, forbid_unknown_fields=True, frozen=True):
    """Its parameters; `factor` is the 1 / 0.9 of the paper's experiments."""

    factor: Annotated[float, Meta(ge=1.0, le=2.0)] = 1.0 / 0.9


@dataclass
class Fading:
    """P grows by a factor after each epoch (wang2018, eq. 18).

    P+ times s and then propagated is s Phi P+ Phi' + Q, the predicted covariance of the next epoch. The
    paper's experiments quote S = 0.9, which is s = 1 / 0.9.

    Parameters
    ----------
    table : FadingTable
    """

    table: FadingTable = field(default_factory=FadingTable)
    Table: ClassVar[type[FadingTable]] = FadingTable
    role: ClassVar[Role] = "process"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R as it is; see `Adaptation.judge`."""
        return Verdict(innovation.r, fade=self.table.factor if innovation.channel == EPOCH else 1.0)

    def copy(self) -> Self:
        """Itself: it remembers nothing."""
        return self
