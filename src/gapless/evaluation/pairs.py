"""Is one system better than another? Ratios of their errors on the same outages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.evaluation.resampling import Interval, Order, interval, resample
from gapless.trip.recording import Array

_EXACT: Final = 50
"""Up to so many ranks their distribution is counted out; beyond, it is normal to 1e-3."""


@dataclass(frozen=True)
class Pair:
    """One system against another over the outages that both were scored in.

    Parameters
    ----------
    count : int
        Of outages.
    median_ratio : float
        Of error by error; below 1 where the system is better.
    geometric : Interval
        Geometric mean of the ratios.
    better : float
        Share of outages with the smaller error.
    worst_ratio : float
        Largest ratio: what the system costs where it fails.
    p : float
        Two-sided, of the Wilcoxon signed-rank test on the logarithms of the ratios, or where outages
        neighbour or overlap on what `votes` makes of them.
    """

    count: int
    median_ratio: float
    geometric: Interval
    better: float
    worst_ratio: float
    p: float


def pair(errors: Array, base: Array, order: Order, seed: int = 0) -> Pair:
    """Compare errors with those of a base system.

    Parameters
    ----------
    errors, base : ndarray, shape (n,)
        Of the same outages [any unit], above zero.
    order : Order
        Of these outages.
    seed : int

    Returns
    -------
    Pair
    """
    if not len(errors):
        nothing = Interval(math.nan, math.nan, math.nan)
        return Pair(0, math.nan, nothing, math.nan, math.nan, math.nan)
    logs = np.log(errors / base)
    mean = interval(logs, resample(order, seed), lambda x: np.asarray(np.mean(x, axis=-1)))
    return Pair(
        count=len(logs),
        median_ratio=float(np.exp(np.median(logs))),
        geometric=Interval(*(math.exp(v) for v in mean)),
        better=float(np.mean(logs < 0.0)),
        worst_ratio=float(np.exp(np.max(logs))),
        p=signed_rank(votes(logs, order)),
    )


def votes(values: Array, order: Order) -> Array:
    """Means over runs of neighbouring outages, so far apart that no two of them share anything.

    `order.reach` outages in a row vote together, the next `order.reach - 1` are passed over. Where
    outages share what their reach says, that keeps a test at its level and costs little: of 60 outages
    of which two in a row overlap, the mean of the votes scatters by 6 % more than that of all.

    Parameters
    ----------
    values : ndarray, shape (n,)
    order : Order

    Returns
    -------
    ndarray
    """
    ranked, step = values[order.rows], 2 * order.reach - 1
    return np.array([ranked[k : k + order.reach].mean() for k in range(0, len(order), step)])


def signed_rank(values: Array) -> float:
    """Two-sided p value of Wilcoxon's signed-rank test that the values scatter evenly about zero.

    Counted out for at most 50 values without ties, else normal with the correction for ties
    (Wilcoxon 1945; Hollander, Wolfe and Chicken 2014, section 3.1). Zeros are left out.

    Parameters
    ----------
    values : ndarray, shape (n,)

    Returns
    -------
    float
        NaN without any value other than zero.
    """
    x = values[values != 0.0]
    n = len(x)
    if not n:
        return math.nan
    size, place, count = np.unique(np.abs(x), return_inverse=True, return_counts=True)
    ranks = (np.cumsum(count) - 0.5 * (count - 1))[place]
    positive = float(ranks[x > 0.0].sum())
    if n <= _EXACT and len(size) == n and n == len(values):
        return _counted_out(n, round(positive))
    spread = math.sqrt(n * (n + 1) * (2 * n + 1) / 24.0 - float(np.sum(count**3 - count)) / 48.0)
    return math.erfc(abs(positive - n * (n + 1) / 4.0) / spread / math.sqrt(2.0))


def _counted_out(n: int, positive: int) -> float:
    """Of all 2^n choices of signs, the share whose sum of positive ranks is as far out."""
    ways: NDArray[np.float64] = np.zeros(n * (n + 1) // 2 + 1)
    ways[0] = 1.0
    for rank in range(1, n + 1):
        ways[rank:] = ways[rank:] + ways[:-rank]
    nearer = min(positive, len(ways) - 1 - positive)
    return min(1.0, 2.0 * float(ways[: nearer + 1].sum()) / 2.0**n)


def holm(p: Sequence[float]) -> list[float]:
    """P values corrected for how many there are (Holm 1979): the smallest times n, the next times n - 1, ...

    Parameters
    ----------
    p : sequence of float
        NaN counts for nothing and stays.

    Returns
    -------
    list of float
        In the same order, at most 1.
    """
    told = sorted((value, i) for i, value in enumerate(p) if not math.isnan(value))
    found, highest = list(p), 0.0
    for k, (value, i) in enumerate(told):
        highest = max(highest, min(1.0, (len(told) - k) * value))
        found[i] = highest
    return found
