"""Intervals for figures over outages that neighbour and overlap each other: a block bootstrap."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless.trip.recording import Array

RESAMPLES: Final = 1000
"""Ends of a 95 % interval then scatter by some 3 % of its width."""
FEWEST: Final = 6
"""Fewer outages give no interval: all of five lie on one side of the median once in 16 times."""


class Interval(NamedTuple):
    """A figure with its 95 % interval; NaN ends where the outages are too few for one.

    Parameters
    ----------
    value, lo, hi : float
    """

    value: float
    lo: float
    hi: float


@dataclass(frozen=True)
class Order:
    """Outages in the order in which they neighbour each other, and how far the neighbourhood reaches.

    Parameters
    ----------
    rows : ndarray of int, shape (n,)
        Outages by recording, then by start.
    reach : int
        How many outages in a row may share what went wrong: those of one recording that begin before
        another one of their length would have fitted in after the first. 1 where all lie apart.
    """

    rows: NDArray[np.int64]
    reach: int

    @property
    def block(self) -> int:
        """Outages drawn together: twice the reach, or neighbours would be torn as often as not."""
        return 1 if self.reach == 1 else 2 * self.reach

    def __len__(self) -> int:
        return len(self.rows)


def order(recordings: Sequence[str], starts: Array, ends: Array) -> Order:
    """Sort outages and see which of them neighbour or overlap.

    Parameters
    ----------
    recordings : sequence of str, length n
    starts, ends : ndarray, shape (n,)
        [s]

    Returns
    -------
    Order
    """
    names = np.array(recordings, dtype=str)
    rows = np.lexsort((starts, names))
    reach = 1
    for name in np.unique(names):
        own = rows[names[rows] == name]
        horizon = starts[own] + 2.0 * (ends[own] - starts[own])
        ahead = np.searchsorted(starts[own], horizon, side="left") - np.arange(len(own))
        reach = max(reach, int(np.ceil(np.median(ahead)))) if len(own) else reach
    return Order(rows.astype(np.int64), reach)


def resample(order: Order, seed: int = 0, resamples: int = RESAMPLES) -> NDArray[np.int64]:
    """Outages of each resample: runs of neighbours from random places of the order, joined end to end.

    The order is closed to a circle, so that each outage is drawn as often as any other (Politis and
    Romano 1992, "A circular block-resampling procedure for stationary data").

    Parameters
    ----------
    order : Order
    seed : int
    resamples : int

    Returns
    -------
    ndarray of int, shape (resamples, n)
    """
    n, size = len(order), min(order.block, max(len(order), 1))
    count = math.ceil(n / size)
    first = np.random.default_rng(seed).integers(0, max(n, 1), (resamples, count))
    places = (first[:, :, None] + np.arange(size)) % max(n, 1)
    return np.asarray(order.rows[places.reshape(resamples, -1)[:, :n]])


def interval(
    values: Array, drawn: NDArray[np.int64], figure: Callable[[Array], Array], level: float = 0.95
) -> Interval:
    """A figure of the values, with the percentile interval of its resamples.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite.
    drawn : ndarray of int, shape (resamples, n)
        From `resample`.
    figure : callable
        Of the last axis of an array.
    level : float

    Returns
    -------
    Interval
    """
    if not len(values):
        return Interval(math.nan, math.nan, math.nan)
    value = float(figure(values))
    if len(values) < FEWEST:
        return Interval(value, math.nan, math.nan)
    tail = 50.0 * (1.0 - level)
    lo, hi = np.percentile(figure(values[drawn]), [tail, 100.0 - tail])
    return Interval(value, float(lo), float(hi))


FIGURES: Final[dict[str, Callable[[Array], Array]]] = {
    "median": lambda x: np.asarray(np.median(x, axis=-1)),
    "rms": lambda x: np.asarray(np.sqrt(np.mean(x * x, axis=-1))),
    "p90": lambda x: np.asarray(np.percentile(x, 90.0, axis=-1)),
    "p95": lambda x: np.asarray(np.percentile(x, 95.0, axis=-1)),
    "worst": lambda x: np.asarray(np.max(x, axis=-1)),
}
"""What a leaderboard says of errors over outages. No resample is worse than the worst there was, so the
upper end of the last one is no bound on what is still to come."""
