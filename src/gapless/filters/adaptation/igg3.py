"""IGG-III: each axis of an observation weighed by its residual against those of the recent past."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Self

import numpy as np
from msgspec import Meta, Struct

from gapless.filters.adaptation.base import Innovation, Role, Verdict
from gapless.trip.recording import Array

MEDIAN = 0.6745
"""Median of the absolute value of a standard normal."""
LEAST = 1e-30
"""Weight of an axis that is thrown out."""


class Igg3Table(Struct, forbid_unknown_fields=True, frozen=True):
    """`keep` is k_0, `drop` k_1 of the paper; `window` the epochs whose residuals tell the scale."""

    keep: Annotated[float, Meta(gt=0.0)] = 1.5
    drop: Annotated[float, Meta(gt=0.0)] = 5.0
    window: Annotated[int, Meta(ge=5)] = 20

    def __post_init__(self) -> None:
        if not self.keep < self.drop:
            raise ValueError(f"drop = {self.drop:g} must be more than keep = {self.keep:g}")


@dataclass
class Igg3:
    """R_i / gamma_i (tan2015, eq. 28-32; Yang 1994), gamma_i by the residual in robust standard deviations.

    With p_i = 1 / R_ii and the residual e = z - H x+ = R S^-1 z: the scale is median |sqrt(p_i) e_i| / 0.6745
    over the last epochs of a channel, for three residuals of one epoch are too few. The window starts full
    of what the filter expects of them.

    Parameters
    ----------
    table : Igg3Table
    recent : dict of str to deque of ndarray
        By channel: |sqrt(p_i) e_i| of the last epochs.
    """

    table: Igg3Table = field(default_factory=Igg3Table)
    recent: dict[str, deque[Array]] = field(default_factory=dict)
    Table: ClassVar[type[Igg3Table]] = Igg3Table
    role: ClassVar[Role] = "weight"
    bends_gain: ClassVar[bool] = False
    reckons_optimal: ClassVar[bool] = True

    def judge(self, innovation: Innovation) -> Verdict:
        """R with the doubtful axes' variances enlarged; see `Adaptation.judge`."""
        z, s, r = innovation.z, innovation.s, innovation.r
        sd = np.sqrt(np.diag(r))
        size = np.abs(r @ np.linalg.solve(s, z)) / sd
        recent = self.recent.get(innovation.channel)
        if recent is None:
            expected = MEDIAN * np.sqrt(np.diag(r @ np.linalg.solve(s, r))) / sd
            recent = deque([expected] * self.table.window, self.table.window)
            self.recent[innovation.channel] = recent
        recent.append(size)
        scale = float(np.median(np.array(recent))) / MEDIAN
        share = 1.0 / np.sqrt(weights(size / max(scale, 1e-300), self.table.keep, self.table.drop))
        return Verdict(innovation.r if (share == 1.0).all() else share[:, None] * r * share)

    def copy(self) -> Self:
        """An independent copy; see `Adaptation.copy`."""
        return type(self)(self.table, {name: recent.copy() for name, recent in self.recent.items()})


def weights(s: Array, keep: float, drop: float) -> Array:
    """The three parts of IGG-III's weight function (Yang 1994).

    Parameters
    ----------
    s : ndarray, shape (m,)
        Residuals in standard deviations.
    keep, drop : float
        k_0, k_1.

    Returns
    -------
    ndarray, shape (m,)
        1 up to k_0, (k_0 / s) ((k_1 - s) / (k_1 - k_0))^2 up to k_1, 1e-30 beyond.
    """
    bent = keep / np.maximum(s, keep) * (np.maximum(drop - s, 0.0) / (drop - keep)) ** 2
    return np.where(s <= keep, 1.0, np.maximum(bent, LEAST))
