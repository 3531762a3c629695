"""Stretches in which innovations are larger than stated, told from spikes by a median."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from gapless.trip.recording import Array

WINDOW: Final = 10.0
"""NIS are averaged over windows [s]."""
WINDOWS: Final = 6
"""The median of so many windows in a row judges."""
FAR: Final = 4.0
"""Innovations are too large for what is stated where their mean square is by this factor [1]."""


def too_large(time: Array, nis: Array) -> Iterator[tuple[float, float, float]]:
    """Stretches in which the median of means over windows is too large.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    nis : ndarray, shape (n,)
        Per degree of freedom.

    Yields
    ------
    from, until, ratio : float
        [s], [s], and by how much [1].
    """
    if not len(time):
        return
    bins = ((time - time[0]) // WINDOW).astype(int)
    counts = np.bincount(bins)
    if len(counts) < WINDOWS:
        return
    means = np.full(len(counts), np.nan)
    np.divide(np.bincount(bins, nis), counts, out=means, where=counts > 0)
    views = np.lib.stride_tricks.sliding_window_view(means, WINDOWS)
    full = np.isfinite(views).sum(axis=1) > WINDOWS // 2
    far = np.zeros(len(counts), bool)
    for k in np.flatnonzero(full):
        if np.nanmedian(views[k]) > FAR:
            far[k : k + WINDOWS] = True
    edges = np.flatnonzero(np.diff(np.concatenate([[0], far.astype(int), [0]])))
    for first, last in edges.reshape(-1, 2):
        worst = first + np.flatnonzero(means[first:last] > FAR)
        a, b = worst[0], worst[-1] + 1
        if b - a >= WINDOWS:
            until = min(float(time[0]) + b * WINDOW, float(time[-1]))
            yield float(time[0]) + a * WINDOW, until, float(np.nanmedian(means[a:b]))
