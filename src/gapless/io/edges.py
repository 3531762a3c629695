"""Stamps at a log's edges that belong to no part of it: a receiver before it knew the time, a torn last row.

One wild stamp makes a drive of minutes last for decades, for everything that counts in seconds. It is
dropped before anything is counted, and said; stamps inside a log are a matter of their own.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.io.log import Log
from gapless.trip.recording import Array, Note

FAR: Final = 900.0
"""Least leap [s] between a stray stamp and the rest: longer than receivers are silent on a drive."""
FAR_IMU: Final = 10.0
"""The same of an IMU, which is not silent: a few samples by themselves measure nothing."""
_USUAL: Final = 1000.0
"""A leap is as many usual intervals at least, whatever the unit of time."""
_FEW: Final = 5
"""Rows at an edge that may be strays, or one in `_SHARE` of a long log; never more than a fifth of a log."""
_SHARE: Final = 200
_DAY: Final = 86400.0


def without_strays(log: Log, far: float, notes: list[Note]) -> Log:
    """Rows but for a few at either edge that a leap parts from all others.

    Parameters
    ----------
    log : Log
        In any order; without a time it is returned as it is.
    far : float
        Least leap [s].
    notes : list of Note
        Appended to.

    Returns
    -------
    Log
    """
    if "time" not in log:
        return log
    known = np.flatnonzero(np.isfinite(log["time"]))
    n = len(known)
    few = min(max(_FEW, n // _SHARE), n // 5)
    if few == 0:
        return log
    time = log["time"][known]
    far = max(far, _USUAL * float(np.median(np.abs(np.diff(time)))))
    begin, end = _strays(time, few, far), n - _strays(time[::-1], few, far)
    for name, rows in (("first", known[:begin]), ("last", known[end:])):
        if len(rows):
            what = f"stamps at the {name} rows far from all others ({log['time'][rows[0]]:.6g} s); dropped"
            notes.append(log.note(what, len(rows)))
    if begin == 0 and end == n:
        return log
    keep = np.ones(len(log), bool)
    keep[known[:begin]] = keep[known[end:]] = False
    return log.take(keep)


def _strays(time: Array, few: int, far: float) -> int:
    """How many of a log's first rows are far from all that follow: told from within, outwards."""
    near, wild = float(np.median(time[few : 2 * few + 1])), np.zeros(few, bool)
    for k in range(few - 1, -1, -1):
        wild[k] = abs(time[k] - near) > far
        near = near if wild[k] else float(time[k])
    return few if wild.all() else int(np.argmin(wild))


def of_the_trip(log: Log, imu: Array, notes: list[Note]) -> Log:
    """Rows but for a few at either edge, stamped more than a day before the IMU's first or after its last.

    Parameters
    ----------
    log : Log
        Of another sensor.
    imu : ndarray, shape (n,)
        The IMU's stamps [s], increasing.
    notes : list of Note
        Appended to.

    Returns
    -------
    Log
        The same one where most rows are so far away: then the clocks differ.
    """
    if "time" not in log:
        return log
    time = log["time"]
    away = np.isfinite(time) & ((time < imu[0] - _DAY) | (time > imu[-1] + _DAY))
    away = np.logical_and.accumulate(away) | np.logical_and.accumulate(away[::-1])[::-1]
    if not away.any() or away.sum() > len(log) // 5:
        return log
    notes.append(log.note("rows more than a day before or after the IMU's dropped", int(away.sum())))
    return log.take(~away)
