"""The stamps of an IMU log: their nominal interval, ticks that repeat, gaps.

Everything here is causal but for one thing: the nominal interval is taken from the first 1000
rows. A mended stamp depends on those and on the stamps before it, never on later ones.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.trip.recording import Array

HEAD: Final = 1000
"""Rows that the nominal interval is taken from (10 s at 100 Hz)."""
GAIN: Final = 0.02
"""Share of the difference between stamp and expected time that the clock filter takes over.

A tick of q leaves about q sqrt(GAIN / 24) of jitter: 0.3 ms for 10 ms. A clock off by 1e-4 is
followed with a lag of 1e-4 / GAIN = 0.5 % of an interval.
"""


def nominal_interval(time: Array) -> float:
    """Interval between samples, from the first `HEAD` rows.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Logged stamps [s], never going back, n >= 2.

    Returns
    -------
    float
        [s]: the median; where ticks repeat or come in bursts, the mean without gaps.
    """
    step = np.diff(time[: HEAD + 1])
    middle = float(np.median(step))
    if step.min() >= 0.5 * middle > 0.0:
        return middle
    largest = 10.0 * max(middle, float(step.mean()))
    return float(step[step <= largest].mean())


def gap_length(period: float) -> float:
    """Shortest silence that counts as a gap: max(5 intervals, 0.5 s).

    Parameters
    ----------
    period : float
        Nominal interval [s].

    Returns
    -------
    float
        [s]
    """
    return max(5.0 * period, 0.5)


def hole_length(period: float) -> float:
    """Shortest silence that the next sample does not cover: max(5 intervals, 0.1 s).

    Parameters
    ----------
    period : float
        Nominal interval [s].

    Returns
    -------
    float
        [s]
    """
    return max(5.0 * period, 0.1)


def even_stamps(time: Array, period: float) -> tuple[Array, int]:
    """Increasing stamps from a clock that ticks more coarsely than the samples come.

    A first-order clock filter advances by the nominal interval and moves by `GAIN` towards the
    logged stamp; it jumps to a stamp that is ahead by more than two ticks. Its time is taken from
    the first interval that is shorter than half the nominal one, in steps of half an interval or
    more, so that stamps increase; stamps before are returned as they are.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Logged stamps [s], never going back.
    period : float
        Nominal interval [s].

    Returns
    -------
    stamps : ndarray, shape (n,)
        [s]; mended row k depends on rows 0..max(k, HEAD) only.
    begin : int
        First row that the filter set; n if none.
    """
    short = np.diff(time) < 0.5 * period
    n = len(time)
    if not short.any():
        return time, n
    begin = int(np.argmax(short)) + 1
    step = np.diff(time[: HEAD + 1])
    jump = 2.0 * float(step[step <= gap_length(period)].max(initial=period))
    out = time.tolist()
    clock = out[0]
    for k in range(1, n):
        ahead = out[k] - clock - period
        clock = out[k] if ahead > jump else clock + period + GAIN * ahead
        if k >= begin:
            out[k] = max(clock, out[k - 1] + 0.5 * period)
    return np.array(out), begin


def intervals(time: Array, period: float) -> tuple[Array, NDArray[np.bool_]]:
    """Length of the interval that each sample covers.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Increasing stamps [s].
    period : float
        Nominal interval [s].

    Returns
    -------
    dt : ndarray, shape (n,)
        [s]: the stamp difference; the nominal interval for the first row and after a hole, so that
        `time[k] - dt[k] > time[k - 1]` shows the hole.
    hole : ndarray of bool, shape (n,)
        Rows that follow a hole.
    """
    dt = np.diff(time, prepend=time[0] - period)
    hole = dt > hole_length(period)
    dt[hole] = period
    dt[0] = period
    return dt, hole
