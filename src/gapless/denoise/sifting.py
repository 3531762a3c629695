"""Empirical mode decomposition: a signal as a sum of modes, from the fastest to the slowest.

Huang et al. 1998 (Proc. R. Soc. A 454, 903): the mean of two cubic splines through the maxima and
the minima is taken away until what is left swings about zero. Here, as in liu2019, a fixed number
of times; the ends are mirrored after Rilling, Flandrin and Goncalves 2003 (NSIP-03).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gapless._numba import inline, long_kernel
from gapless.trip.recording import Array

SIFTINGS = 10
"""Siftings of each mode (liu2019, section 5.2)."""
MIRRORED = 2
"""Extrema of each kind that are mirrored at an end (Rilling et al. 2003)."""
_ROUNDING = 1e-12
"""A residue that spans less than this share of the signal is rounding, and is not sifted on."""


def modes(x: Array, siftings: int = SIFTINGS) -> Iterator[Array]:
    """The intrinsic mode functions of a signal, one by one, the fastest first.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Finite.
    siftings : int

    Yields
    ------
    ndarray, shape (n,)
        A new array each; it ends where what is left has fewer than three extrema.
    """
    residue = np.array(x, dtype=np.float64)
    least = _ROUNDING * float(np.ptp(residue)) if residue.size else 0.0
    while residue.size and np.ptp(residue) > least:
        mode = residue.copy()
        if not sift(mode, siftings):
            return
        residue -= mode
        yield mode


def decompose(x: Array, siftings: int = SIFTINGS) -> tuple[Array, Array]:
    """All modes of a signal, and what is left.

    Parameters
    ----------
    x : ndarray, shape (n,)
    siftings : int

    Returns
    -------
    imfs : ndarray, shape (l, n)
    residue : ndarray, shape (n,)
        The imfs and it sum up to `x`.
    """
    found = list(modes(x, siftings))
    imfs = np.array(found).reshape(len(found), len(x))
    residue = np.array(x, dtype=np.float64)
    for mode in imfs:
        residue -= mode
    return imfs, residue


@long_kernel
def sift(h: Array, siftings: int) -> bool:
    """Leave the fastest mode of a signal in its place.

    Parameters
    ----------
    h : ndarray, shape (n,)
        Replaced.
    siftings : int

    Returns
    -------
    bool
        Whether there is one: not where a sifting meets fewer than three extrema.
    """
    half = h.shape[0] // 2 + 1
    tops, bottoms = np.empty(half, np.int64), np.empty(half, np.int64)
    upper, lower = np.empty((5, half + 2 * MIRRORED)), np.empty((5, half + 2 * MIRRORED))
    for _ in range(siftings):
        nt, nb = extrema(h, tops, bottoms)
        if nt + nb < 3:
            return False
        left = _mirror(h, tops, nt, bottoms, nb, False)
        right = _mirror(h, tops, nt, bottoms, nb, True)
        above = _knots(h, tops, nt, left[0], left[1], left[2], right[0], right[1], right[2], upper)
        below = _knots(h, bottoms, nb, left[0], left[3], left[4], right[0], right[3], right[4], lower)
        _spline(upper, above)
        _spline(lower, below)
        _take_half(h, upper, above)
        _take_half(h, lower, below)
    return True


@inline
def extrema(x: Array, tops: Any, bottoms: Any) -> tuple[int, int]:
    """Where a signal turns; of a plateau, its middle sample (the earlier of two).

    Parameters
    ----------
    x : ndarray, shape (n,)
    tops, bottoms : ndarray of int, shape (n // 2 + 1,)
        Indices of maxima and minima, written here; the ends of the signal are neither.

    Returns
    -------
    tuple of 2 int
        How many of each.
    """
    nt, nb, way, begin = 0, 0, 0, 0
    for i in range(1, x.shape[0]):
        step = x[i] - x[i - 1]
        if step > 0.0:
            if way < 0:
                bottoms[nb] = (begin + i - 1) // 2
                nb += 1
            way, begin = 1, i
        elif step < 0.0:
            if way > 0:
                tops[nt] = (begin + i - 1) // 2
                nt += 1
            way, begin = -1, i
    return nt, nb


@inline
def _at(places: Any, count: int, k: int, right: bool) -> int:
    """The k-th extremum counted from an end."""
    return int(places[count - 1 - k] if right else places[k])


@inline
def _mirror(
    x: Array, tops: Any, nt: int, bottoms: Any, nb: int, right: bool
) -> tuple[int, int, bool, int, bool]:
    """About which sample an end is mirrored, and which extrema are.

    It is the outermost extremum if the end lies between it and the next one, and else the end,
    which then counts as an extremum of the other kind.

    Returns
    -------
    axis : int
    skip_tops : int
        The first maximum that is mirrored, counted from this end.
    end_is_top : bool
        Whether the end counts as a maximum.
    skip_bottoms, end_is_bottom
        The same for minima.
    """
    end = x.shape[0] - 1 if right else 0
    top, bottom = _at(tops, nt, 0, right), _at(bottoms, nb, 0, right)
    top_leads = top > bottom if right else top < bottom
    beyond = x[end] <= x[bottom] if top_leads else x[end] >= x[top]
    if beyond:
        return end, 0, not top_leads, 0, top_leads
    axis = top if top_leads else bottom
    lead = 1 if top_leads else 0
    last_top, last_bottom = min(nt - 1, lead + MIRRORED - 1), min(nb - 1, MIRRORED - lead)
    far_top = 2 * axis - _at(tops, nt, last_top, right)
    far_bottom = 2 * axis - _at(bottoms, nb, last_bottom, right)
    reaches = min(far_top, far_bottom) >= end if right else max(far_top, far_bottom) <= end
    if not reaches:
        return end, 0, False, 0, False
    return axis, lead, False, 1 - lead, False


@inline
def _knots(
    x: Array,
    places: Any,
    count: int,
    left: int,
    left_skip: int,
    left_end: bool,
    right: int,
    right_skip: int,
    right_end: bool,
    knots: Any,
) -> int:
    """Extrema of one kind with their mirror images: places in row 0, values in row 1.

    Returns
    -------
    int
        How many.
    """
    m = 0
    for k in range(MIRRORED - 1, -1, -1):
        which = left_skip + k - (1 if left_end else 0)
        if which < count:
            i = 0 if which < left_skip else places[which]
            knots[0, m], knots[1, m] = 2 * left - i, x[i]
            m += 1
    for k in range(count):
        knots[0, m], knots[1, m] = places[k], x[places[k]]
        m += 1
    for k in range(MIRRORED):
        which = right_skip + k - (1 if right_end else 0)
        if which < count:
            i = x.shape[0] - 1 if which < right_skip else places[count - 1 - which]
            knots[0, m], knots[1, m] = 2 * right - i, x[i]
            m += 1
    return m


@inline
def _spline(knots: Any, m: int) -> None:
    """Second derivatives of the cubic spline, in row 2: not-a-knot, or natural with three knots.

    Rows 3 and 4 are scratch. Textbook form: h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6
    (slope[i] - slope[i-1]), solved forwards and back; not-a-knot says that M is one straight line
    over the first two intervals, and over the last two.
    """
    t, y, bend, upper, known = knots[0], knots[1], knots[2], knots[3], knots[4]
    upper[0] = known[0] = 0.0
    for i in range(1, m - 1):
        before, after = t[i] - t[i - 1], t[i + 1] - t[i]
        below, middle, above = before, 2.0 * (before + after), after
        if m > 3 and i == 1:
            below, middle, above = 0.0, middle + before * (1.0 + before / after), after - before**2 / after
        if m > 3 and i == m - 2:
            below, middle, above = below - after**2 / before, middle + after * (1.0 + after / before), 0.0
        right = 6.0 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before)
        pivot = middle - below * upper[i - 1]
        upper[i] = above / pivot
        known[i] = (right - below * known[i - 1]) / pivot
    bend[m - 1] = 0.0
    for i in range(m - 2, 0, -1):
        bend[i] = known[i] - upper[i] * bend[i + 1]
    bend[0] = 0.0
    if m > 3:
        ratio = (t[1] - t[0]) / (t[2] - t[1])
        bend[0] = bend[1] + ratio * (bend[1] - bend[2])
        ratio = (t[m - 1] - t[m - 2]) / (t[m - 2] - t[m - 3])
        bend[m - 1] = bend[m - 2] + ratio * (bend[m - 2] - bend[m - 3])


@inline
def _take_half(h: Any, knots: Any, m: int) -> None:
    """Take half the spline away from the signal."""
    t, y, bend = knots[0], knots[1], knots[2]
    n = h.shape[0]
    for k in range(m - 1):
        width = t[k + 1] - t[k]
        begin, end = max(0, int(t[k])), int(t[k + 1])
        if k == m - 2:
            end += 1
        end = min(n, end)
        slope = (y[k + 1] - y[k]) / width - width * (2.0 * bend[k] + bend[k + 1]) / 6.0
        a, b = 0.5 * y[k], 0.5 * slope
        c, d = 0.25 * bend[k], (bend[k + 1] - bend[k]) / (12.0 * width)
        for i in range(begin, end):
            u = i - t[k]
            h[i] -= a + u * (b + u * (c + u * d))
