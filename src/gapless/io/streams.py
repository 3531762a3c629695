"""Two devices' rows in one log, shuffled: each row is unlike its neighbours and like the next but one.

Sorting a log of two drives by time makes such a log, whose stamps are in order. What tells is the means: of
one sensor those of every other row are alike, of two they are not.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.io.log import Log
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Array, Gnss, Odometer, Trajectory

_ROWS: Final = 600
"""Rows that a verdict is formed on."""
_FEW_ROWS: Final = 60
"""The same where a log is slow."""
_SURE: Final = 7.0
"""Difference of the means, in its standard deviations, that chance does not make."""
_SIZE: Final = 0.2
"""Least difference in units of the scatter: a sensor's two buffers may differ by a trace."""
_MOST: Final = 0.6
"""Share of the stretches that must say so: vibration at half the sampling rate passes by."""
_APART: Final = 0.3
"""Least distance of two receivers' places [m]."""
_FASTER: Final = 0.3
"""Least difference of two cars' speeds [m/s]."""
_PERIODS: Final = (2, 3)
"""Rows after which the same device speaks again: two as fast as each other, or one twice as fast."""
_CURE: Final = "two devices', or two drives', rows are shuffled into one file: keep those of one"


def check_one_device(log: Log, triads: Array) -> None:
    """Refuse an IMU log of two devices.

    Parameters
    ----------
    log : Log
        For the error.
    triads : ndarray, shape (n, 6)
        Rates and forces.

    Raises
    ------
    RecordingError
    """
    if _alternate(triads, _ROWS, 0.0):
        log.refuse(
            "rows belong to two devices by turns: they are like the next but one, not like the next", _CURE
        )


def check_one_odometer(log: Log, wheels: Odometer) -> None:
    """Refuse an odometer log of two drives.

    Parameters
    ----------
    log : Log
        For the error.
    wheels : Odometer

    Raises
    ------
    RecordingError
    """
    if _alternate(wheels.speed[:, None], _FEW_ROWS, _FASTER):
        log.refuse(
            "speeds belong to two cars by turns: they are like the next but one, not like the next", _CURE
        )


def check_one_receiver(log: Log, path: Gnss | Trajectory) -> None:
    """Refuse positions of two receivers in two places.

    Parameters
    ----------
    log : Log
        For the error.
    path : Gnss or Trajectory

    Raises
    ------
    RecordingError
    """
    lla = path.lla[np.isfinite(path.lla).all(axis=1)]
    if len(lla) < _FEW_ROWS:
        return
    ned = offset_ned(lla, np.broadcast_to(lla[0], lla.shape))
    if _alternate(ned, _FEW_ROWS, _APART):
        log.refuse(
            "positions belong to two places by turns: they are like the next but one, not like the next",
            _CURE,
        )


def _alternate(values: Array, rows: int, least: float) -> bool:
    """Whether means differ by the row's turn, in most of the log."""
    if len(values) < rows:
        return False
    for period in _PERIODS:
        kernel = np.full(period, 1.0 / period)
        if period % 2 == 0:
            kernel = 0.5 * (np.append(kernel, 0.0) + np.append(0.0, kernel))
        half = len(kernel) // 2
        around = np.column_stack([np.convolve(column, kernel, "valid") for column in values.T])
        off = values[half : half + len(around)] - around
        n = rows // period
        count = len(off) // (n * period)
        if not count:
            continue
        turns = off[: count * n * period].reshape(count, n, period, -1)
        mean, scatter = turns.mean(axis=1), turns.std(axis=1)
        size = np.abs(mean - mean.mean(axis=1, keepdims=True))  # a bend is in all of them
        sure = (size > _SURE * scatter / np.sqrt(n)) & (size > _SIZE * scatter) & (size > least)
        if np.mean(sure.any(axis=(1, 2))) > _MOST:
            return True
    return False
