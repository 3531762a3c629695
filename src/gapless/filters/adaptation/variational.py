"""Variational Bayes: R and the state from the same observation, R inverse-Wishart."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict, whitened
from gapless.trip.recording import Array


class VariationalTable(Struct, forbid_unknown_fields=True, frozen=True):
    """`forget` is rho; `prior` the observations that the stated R counts for at the start.

    `iterations` of the fixed point; `limit` as for Sage-Husa.
    """

    forget: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.98
    prior: Annotated[float, Meta(gt=0.0)] = 10.0
    iterations: Annotated[int, Meta(ge=2, le=50)] = 5
    limit: Annotated[float, Meta(gt=0.0)] = 10.0


@dataclass
class Variational:
    """The variational-Bayes adaptive filter (georges2015; Särkkä and Hartikainen 2013), R ~ IW(nu, V).

    With d = dim z and n = nu - d - 1, so that E[R] = V / n: predict n = rho n, V = rho V; then nu + 1, and in
    turns R = V / n, the update with it, V = V- + E[(z - h(x)) (z - h(x))'] = V- + e e' + H P+ H'. In
    observation space e = R S^-1 z and H P+ H' = A - A S^-1 A = A S^-1 R with A = H P- H'.

    Per channel and in units of the stated R, which may then change from fix to fix.

    Parameters
    ----------
    table : VariationalTable
    known : dict of str to (float, ndarray)
        By channel: n and V, in units of what is stated.
    """

    table: VariationalTable = field(default_factory=VariationalTable)
    known: dict[str, tuple[float, Array]] = field(default_factory=dict)
    Table: ClassVar[type[VariationalTable]] = VariationalTable
    role: ClassVar[Role] = "noise"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = True

    def judge(self, innovation: Innovation) -> Verdict:
        """R of the last turn; see `Adaptation.judge`."""
        t = self.table
        low, z, hph = whitened(innovation, t.limit)
        n, v = self.known.get(innovation.channel, (t.prior, t.prior * np.eye(z.size)))
        n, before = t.forget * n + 1.0, t.forget * v
        v = before
        for _ in range(t.iterations):
            r = v / n
            k = np.linalg.solve(hph + r, np.column_stack([z, r]))
            e, left = r @ k[:, 0], hph @ k[:, 1:]
            v = before + np.outer(e, e) + 0.5 * (left + left.T)
        self.known[innovation.channel] = n, v
        root = low @ np.linalg.cholesky(r)
        return Verdict(root @ root.T)

    def copy(self) -> Self:
        """An independent copy (arrays are never changed in place); see `Adaptation.copy`."""
        return type(self)(self.table, dict(self.known))
