"""Opening: a bridge that measures what the filter is too sure of is met half way.

A filter in an outage states the speed error that its process noise explains; a tilt learned wrong on a
hill makes a larger one. Where what a bridge says is beyond what is stated, P is widened by what is
missing, up to `factor` times the stated deviation.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict


class OpeningTable(Struct, forbid_unknown_fields=True, frozen=True):
    """Most that a deviation grows by (`factor`), and a variance that it may always grow by (`least`)."""

    factor: Annotated[float, Meta(ge=1.0)] = 2.0
    least: Annotated[float, Meta(ge=0.0)] = 0.1


@dataclass
class Opening:
    """Widens P where one scalar observation finds it too narrow.

    Parameters
    ----------
    table : OpeningTable
    """

    table: OpeningTable = field(default_factory=OpeningTable)
    Table: ClassVar[type[OpeningTable]] = OpeningTable
    role: ClassVar[Role] = "recovery"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """P as it is, or wider; see `Adaptation.judge`."""
        if innovation.z.size != 1:
            return Verdict(innovation.r)
        square, stated = float(innovation.z[0]) ** 2, float(innovation.hph[0, 0])
        missing = square - float(innovation.s[0, 0])
        if not missing > 0.0:
            return Verdict(innovation.r)
        most = (self.table.factor**2 - 1.0) * stated + self.table.least
        return Verdict(innovation.r, widen=min(missing, most) / square)

    def copy(self) -> Self:
        """The same: it remembers nothing.

        Returns
        -------
        Opening
        """
        return self
