"""As many points as a screen can show: envelopes of series, simplified tracks."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.trip.recording import Array

Stretch = tuple[float, float]
POINTS: Final = 8000
"""Rows of a chart over time: some per pixel of the widest screen, for a look closer."""


def envelope(
    time: Array, columns: Array, points: int = POINTS, focus: Sequence[Stretch] = ()
) -> tuple[Array, Array]:
    """Smallest and largest value per bucket of rows, in the order in which they occur.

    Parameters
    ----------
    time : ndarray, shape (n,)
    columns : ndarray, shape (n, k)
        NaN where unknown.
    points : int
        Most rows to return, about.
    focus : sequence of (float, float)
        Stretches of time that share half of the points among them: their buckets are finer.

    Returns
    -------
    time : ndarray, shape (m,)
        Two of each bucket: of its first and of its middle row. All, if n <= points.
    columns : ndarray, shape (m, k)
        No extreme of any column is lost.
    """
    n = len(time)
    if n <= points:
        return time, columns
    edges = _edges(time, points // 2, focus)
    width = np.diff(edges)
    rows = np.minimum(edges[:-1, None] + np.arange(int(width.max())), edges[1:, None] - 1)
    found = np.column_stack([_extremes(column[rows]) for column in columns.T])
    middle = (edges[:-1] + edges[1:]) // 2
    twice = np.column_stack([np.full(len(width), True), width > 1]).ravel()
    return time[np.column_stack([edges[:-1], middle]).ravel()[twice]], found[twice]


def _extremes(block: Array) -> Array:
    """Smallest and largest of each row of a block, one after the other as they occur in it."""
    unknown = np.isnan(block)
    low = np.where(unknown, np.inf, block).argmin(axis=1)
    high = np.where(unknown, -np.inf, block).argmax(axis=1)
    pair = np.stack([np.minimum(low, high), np.maximum(low, high)], axis=1)
    return np.take_along_axis(block, pair, axis=1).ravel()


def _edges(time: Array, buckets: int, focus: Sequence[Stretch]) -> NDArray[np.int64]:
    """First rows of buckets, and the end: none of one row where two fit, half of them in the focus."""
    n = len(time)
    inside = np.zeros(n, bool)
    for a, b in focus:
        inside[np.searchsorted(time, a) : np.searchsorted(time, b)] = True
    fine = int(inside.sum())
    share = min(buckets // 2, fine // 2)
    rates = (min(buckets - share, n - fine) / max(n - fine, 1), share / max(fine, 1))
    cuts = [0, *(np.flatnonzero(np.diff(inside)) + 1).tolist(), n]
    pieces = []
    for a, b in pairwise(cuts):
        k = max(1, min((b - a) // 2, round((b - a) * rates[int(inside[a])])))
        pieces.append(np.linspace(a, b, k + 1).astype(int)[:-1])
    return np.concatenate([*pieces, [n]])


def scatter(size: Array, points: int = 3000) -> NDArray[np.int64]:
    """Rows of a cloud of dots: evenly spaced ones that keep its density, and its outliers.

    Parameters
    ----------
    size : ndarray, shape (n,)
        How far out each dot lies; NaN counts as not at all.
    points : int
        Most rows to keep; a tenth of them go to the largest.

    Returns
    -------
    ndarray of int
        Indices of the rows kept, increasing.
    """
    n = len(size)
    if n <= points:
        return np.arange(n)
    far = np.argsort(np.nan_to_num(size))[n - points // 10 :]
    even = np.linspace(0, n - 1, points - len(far)).astype(int)
    return np.union1d(even, far)


def simplify(time: Array, xy: Array, points: int = 4000, tolerance: float = 0.1) -> NDArray[np.int64]:
    """Rows of a track that draw it, and place it in time, as the whole would.

    Top-down time-ratio simplification (Meratnia & de By 2004): the segment whose worst row lies
    furthest from where a straight, even motion would have it is split there, until every row
    is nearer than `tolerance` or the points are used up.

    Parameters
    ----------
    time : ndarray, shape (n,)
    xy : ndarray, shape (n, 2)
        Finite [m].
    points : int
        Most rows to keep.
    tolerance : float
        [m]

    Returns
    -------
    ndarray of int
        Indices of the rows kept, increasing.
    """
    n = len(time)
    if n <= 2:
        return np.arange(n)

    def worst(a: int, b: int) -> tuple[float, int, int, int]:
        weight = ((time[a : b + 1] - time[a]) / (time[b] - time[a]))[:, None]
        off = xy[a : b + 1] - (xy[a] + weight * (xy[b] - xy[a]))
        far = np.hypot(off[:, 0], off[:, 1])
        k = int(far.argmax())
        return -float(far[k]), a + k, a, b

    kept, queue = {0, n - 1}, [worst(0, n - 1)]
    while queue and len(kept) < points:
        far, middle, a, b = heapq.heappop(queue)
        if -far <= tolerance:
            break
        kept.add(middle)
        for pair in ((a, middle), (middle, b)):
            if pair[1] - pair[0] > 1:
                heapq.heappush(queue, worst(*pair))
    return np.array(sorted(kept))
