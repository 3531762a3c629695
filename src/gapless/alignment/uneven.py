"""How uneven stamps are: by how many seconds readings are off along the track, not across it."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.alignment.clock import Curve, smooth
from gapless.trip.recording import Array

DRIVING: Final = 3.0
"""Slower than this a reading's error along the track says nothing of its stamp [m/s]."""
LONG: Final = 15.0
"""What lasts longer is drift of the path [s]."""
CLEAR: Final = 1.5
"""Along the track readings must be off by so much more than across it."""
ENOUGH: Final = 100
"""Readings below which nothing is concluded."""


class Jitter(NamedTuple):
    """Standard deviations of stamps about their mean.

    Parameters
    ----------
    white : float
        From reading to reading [s].
    lasting : float
        Over some seconds [s].
    along, across : float
        Readings' errors over the speed, along the track and across it [s].
    readings : int
    """

    white: float = 0.0
    lasting: float = 0.0
    along: float = 0.0
    across: float = 0.0
    readings: int = 0


def uneven(curve: Curve, time: Array, value: Array) -> Jitter:
    """Unevenness of the stamps of positions.

    Parameters
    ----------
    curve : Curve
        Path on the IMU clock [m].
    time : ndarray, shape (k,)
        Stamps, their offset added [s].
    value : ndarray, shape (k, 2)
        Positions [m].

    Returns
    -------
    Jitter
        Zeros where it is not clear.
    """
    there = (time > curve.time[0] + 1.0) & (time < curve.time[-1] - 1.0)
    time, value = time[there], value[there]
    if len(time) < ENOUGH:
        return Jitter()
    slope = np.gradient(curve.value, curve.time, axis=0)
    v = np.column_stack([np.interp(time, curve.time, c) for c in slope.T])
    left = value - np.column_stack([np.interp(time, curve.time, c) for c in curve.value.T])
    knots = np.arange(time[0], time[-1] + 5.0, 5.0)
    left -= np.column_stack([np.interp(time, knots, smooth(time, c, knots, LONG)) for c in left.T])
    square = (v**2).sum(axis=1)
    off = np.column_stack([(left * v).sum(axis=1), left[:, 1] * v[:, 0] - left[:, 0] * v[:, 1]])
    off /= np.maximum(square, 1.0)[:, None]
    quick = square > DRIVING**2
    three = quick[1:-1] & quick[:-2] & quick[2:]
    if three.sum() < ENOUGH:
        return Jitter()
    bent = (off[1:-1] - 0.5 * (off[:-2] + off[2:])) / np.sqrt(1.5)
    whole, quickly = _excess(off[quick]), _excess(bent[three])
    along, across = (float(s) for s in _scale(off[quick]))
    white = min(quickly, whole)
    return Jitter(white, float(np.sqrt(whole**2 - white**2)), along, across, int(quick.sum()))


def _scale(off: Array) -> Array:
    """Median absolute deviations as standard deviations, column by column."""
    return np.asarray(1.4826 * np.median(np.abs(off - np.median(off, axis=0)), axis=0))


def _excess(off: Array) -> float:
    """What the first column has more than the second; zero where it is not clear."""
    along, across = _scale(off)
    return float(np.sqrt(along**2 - across**2)) if along > CLEAR * across else 0.0
