"""The chi-square robust factor: an improbable fix is made just probable, an impossible one is dropped."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.filters.quantile import chi_square_quantile
from gapless.trip.recording import Array

NEWTON = 50
"""Steps at most; convex and falling, the function is met in a handful."""


class ChiSquareTable(Struct, forbid_unknown_fields=True, frozen=True):
    """Significance levels: beyond `inflate` R grows, beyond `reject` the observation is dropped."""

    inflate: Annotated[float, Meta(gt=0.0, lt=1.0)] = 0.01
    reject: Annotated[float, Meta(ge=0.0, lt=1.0)] = 1e-4


@dataclass
class ChiSquare:
    """Two thresholds on gamma = v' S^-1 v (aslinezhad2020, sec. 2.3; Zhao, Qiu and Feng 2016; Chang 2014).

    Parameters
    ----------
    table : ChiSquareTable
        `reject` = 0 drops nothing.
    """

    table: ChiSquareTable = field(default_factory=ChiSquareTable)
    Table: ClassVar[type[ChiSquareTable]] = ChiSquareTable
    role: ClassVar[Role] = "test"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = False

    def judge(self, innovation: Innovation) -> Verdict:
        """R times beta, with beta = 1, from Newton's method, or infinite; see `Adaptation.judge`."""
        t, m = self.table, innovation.z.size
        bound = chi_square_quantile(1.0 - t.inflate, m)
        if innovation.nis <= bound:
            return Verdict(innovation.r)
        if t.reject > 0.0 and not innovation.nis <= chi_square_quantile(1.0 - min(t.reject, t.inflate), m):
            return Verdict(None)
        return Verdict(innovation.r * robust_factor(innovation.z, innovation.hph, innovation.r, bound))

    def copy(self) -> Self:
        """Itself: it remembers nothing."""
        return self


def robust_factor(z: Array, hph: Array, r: Array, bound: float) -> float:
    """The beta at which v' (H P H' + beta R)^-1 v is the bound (Chang 2014), by Newton's method from 1.

    Parameters
    ----------
    z : ndarray, shape (m,)
        v, beyond the bound at beta = 1.
    hph, r : ndarray, shape (m, m)
    bound : float

    Returns
    -------
    float
        beta <- beta + (gamma(beta) - bound) / (v' S^-1 R S^-1 v). Gamma is convex and falls with beta, so
        each step falls short of the root and none passes it.
    """
    beta = 1.0
    for _ in range(NEWTON):
        y = np.linalg.solve(hph + beta * r, z)
        excess = float(z @ y) - bound
        if excess <= 1e-9 * bound:
            break
        beta += excess / float(y @ r @ y)
    return beta
