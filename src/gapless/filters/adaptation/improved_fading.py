"""The improved fading filter: trust in new data grows while innovations do."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.filters.adaptation.fading import EPOCH


class ImprovedFadingTable(Struct, forbid_unknown_fields=True, frozen=True):
    """`step` u, `ratio` m and `least` S_min of the paper; `floor` keeps a ratio of two small sizes finite."""

    step: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.01
    ratio: Annotated[float, Meta(gt=1.0)] = 1.3
    least: Annotated[float, Meta(gt=0.5, le=1.0)] = 0.6
    floor: Annotated[float, Meta(gt=0.0)] = 0.1


@dataclass
class ImprovedFading:
    """Process noise and gain grow by 1 / S (wang2018, eq. 22-27, their signs put right).

    sigma^2 = tr(R^-1 v v') / dim(v); beta = -1 where it grew by `ratio` or more since the last epoch, else
    +1; S = clip(S + u beta, S_min, 1); P- = Phi P Phi' + Q / S; K = (1 / S) P- H' (H P- H' + R)^-1. The gain
    is not the optimal one, so the update must be the Joseph form. The Q of the way to an epoch is that of
    the S of the epoch before: an S from innovations that are still to come would see the future.

    Parameters
    ----------
    table : ImprovedFadingTable
    scale : float
        S.
    size : float
        sigma^2 of the last epoch; infinite before the first.

    Notes
    -----
    Below S = 0.5 the gain exceeds twice the optimal one, and an update by exact fixes would enlarge errors.
    """

    table: ImprovedFadingTable = field(default_factory=ImprovedFadingTable)
    scale: float = 1.0
    size: float = np.inf
    Table: ClassVar[type[ImprovedFadingTable]] = ImprovedFadingTable
    role: ClassVar[Role] = "process"
    bends_gain: ClassVar[bool] = True
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R as it is, gain and process noise by 1 / S; see `Adaptation.judge`."""
        if innovation.channel == EPOCH:
            t, z = self.table, innovation.z
            size = float(z @ np.linalg.solve(innovation.r, z)) / z.size
            beta = -1.0 if size / max(self.size, t.floor) >= t.ratio else 1.0
            self.scale = min(max(self.scale + t.step * beta, t.least), 1.0)
            self.size = size
        return Verdict(innovation.r, gain=1.0 / self.scale, noise=1.0 / self.scale)

    def copy(self) -> Self:
        """An independent copy; see `Adaptation.copy`."""
        return type(self)(self.table, self.scale, self.size)
