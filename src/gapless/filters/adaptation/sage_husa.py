"""Sage-Husa: the noise of observations from how innovations scatter."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict, whitened
from gapless.trip.recording import Array


class SageHusaTable(Struct, forbid_unknown_fields=True, frozen=True):
    """`forget` is e; `prior` the epochs that the stated R counts for at the start, 0 as in the paper.

    `floor` is the least share of the stated R (a variance), `limit` the largest innovation in its predicted
    standard deviations.
    """

    forget: Annotated[float, Meta(gt=0.0, lt=1.0)] = 0.98
    prior: Annotated[float, Meta(ge=0.0)] = 10.0
    floor: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.1
    limit: Annotated[float, Meta(gt=0.0)] = 10.0


@dataclass
class SageHusa:
    """R_k = (1 - d) R_k-1 + d (v v' - H P- H'), d = (1 - e) / (1 - e^k) (tan2015, eq. 24-27).

    After Sage and Husa (1969). Estimated per channel and in units of the stated R, which then may change
    from fix to fix; with a constant one the formula is the paper's. What is remembered may lose positive
    definiteness, as v v' - H P- H' must to be unbiased; what is given out has its eigenvalues floored.

    Parameters
    ----------
    table : SageHusaTable
    known : dict of str to (float, ndarray)
        By channel: k, and R in units of what is stated.
    """

    table: SageHusaTable = field(default_factory=SageHusaTable)
    known: dict[str, tuple[float, Array]] = field(default_factory=dict)
    Table: ClassVar[type[SageHusaTable]] = SageHusaTable
    role: ClassVar[Role] = "noise"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R as estimated with this innovation; see `Adaptation.judge`."""
        t = self.table
        low, z, hph = whitened(innovation, t.limit)
        k, r = self.known.get(innovation.channel, (t.prior, np.eye(z.size)))
        k += 1.0
        d = (1.0 - t.forget) / (1.0 - t.forget**k)
        r = (1.0 - d) * r + d * (np.outer(z, z) - hph)
        r = 0.5 * (r + r.T)
        self.known[innovation.channel] = k, r
        values, axes = np.linalg.eigh(r)
        root = low @ axes * np.sqrt(np.maximum(values, t.floor))
        return Verdict(root @ root.T)

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place); see `Adaptation.copy`."""
        return type(self)(self.table, dict(self.known))
