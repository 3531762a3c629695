"""Clocks that leap ahead: a silence that the car's motion does not know of.

A clock that is set ahead leaves a hole in the stamps, as a pause does. What tells them apart is the car: over
a pause it moved on, over a leap it did not; and after a leap one sensor's motion comes later than another's.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from gapless.io.log import Log
from gapless.io.order import parts
from gapless.io.orientation import felt, turning_axis
from gapless.io.silence import MOST_SILENCE, in_words
from gapless.trip.motion import horizontal_velocity, offset_ned
from gapless.trip.recording import Array, Gnss, Imu, Odometer, Trajectory

_HOLE: Final = 1.5
"""Least silence beyond a usual interval that is asked about [s]: longer than stamps are late."""
_HARD: Final = 4.0
"""Braking and speeding up that few drivers exceed [m/s^2]."""
_NEAR: Final = 5.0
"""Error of a displacement between fixes [m], a few times a single point's."""
_PAIRS: Final = 3
"""Fixes on either side of a hole that are held against each other; all must agree."""
_WINDOW: Final = 300.0
"""Seconds after a hole in which two sensors' motions are compared."""
_AGREED: Final = 0.7
"""Least correlation of turns that are felt with those of the course."""
_ENOUGH: Final = 30
"""Seconds of driving, or readings, below which nothing is concluded."""
_MOST_MISFIT: Final = 5.0
"""Difference of two speeds beyond which a larger one counts no more [m/s]."""
_MOST_HOLES: Final = 200
"""Holes that are asked about, the longest first: it bounds the work on logs full of them."""


def check_positions_go_on(log: Log, path: Gnss | Trajectory) -> None:
    """Refuse positions whose stamps leap: too near each other for the speed and the time between them.

    Parameters
    ----------
    log : Log
        For the error.
    path : Gnss or Trajectory

    Raises
    ------
    RecordingError
        If the car cannot have driven so little in so long.
    """
    known = np.isfinite(path.lla).all(axis=1)
    time, lla, v_n = path.time[known], path.lla[known], path.v_n[known]
    for k, leap in _holes(time):
        a, b = k - 1 - np.arange(_PAIRS), k + np.arange(_PAIRS)
        if (
            a[-1] < 0
            or b[-1] >= len(time)
            or max(time[k - 1] - time[a[-1]], time[b[-1]] - time[k]) > 5.0 + _HOLE
        ):
            continue
        va, vb = (_velocity(time, lla, v_n, rows, side) for rows, side in ((a, -1), (b, 1)))
        gone = offset_ned(lla[b], lla[a])[:, :2]
        span = time[b] - time[a]
        far = _least_way(float(span[0]), float(np.hypot(*va[0])), float(np.hypot(*vb[0])))
        as_if = 0.5 * (va + vb) * (span - leap)[:, None]
        near = np.hypot(*(gone - as_if).T) < _NEAR + 0.2 * np.hypot(*as_if.T)
        moved, speed = float(np.hypot(*gone[0])), float(np.hypot(*va[0]))
        if near.all() and moved + _NEAR < far:
            _refuse(log, time[k], leap, f"the car moved {moved:.0f} m in {span[0]:.4g} s at {speed:.0f} m/s")


def check_sensors_go_on(imu_log: Log, imu: Imu, gnss_log: Log, gnss: Gnss) -> None:
    """Refuse an IMU or a receiver whose stamps leap against the other's: turns come later by a hole's length.

    Parameters
    ----------
    imu_log, gnss_log : Log
        For the error.
    imu : Imu
    gnss : Gnss

    Raises
    ------
    RecordingError
    """
    for log, time, sign in ((imu_log, imu.time, 1.0), (gnss_log, gnss.time, -1.0)):
        for k, leap in _holes(time):
            begin = time[k] if sign < 0.0 else time[k - 1]
            after = gnss.take((gnss.time >= begin) & (gnss.time < begin + _WINDOW))
            before = gnss.take((gnss.time < time[k - 1]) & (gnss.time > time[k - 1] - _WINDOW))
            if _agrees_moved(imu, after, sign * leap) and not _agrees_moved(imu, before, sign * leap):
                _refuse(log, time[k], leap, "turns after it agree with the other sensor's only without")
        _check_years(log, time, imu.time)


def check_wheels_go_on(log: Log, wheels: Odometer, gnss: Gnss) -> None:
    """Refuse an odometer whose stamps leap: its speeds come later than the fixes' by a hole's length.

    Parameters
    ----------
    log : Log
        For the error.
    wheels : Odometer
    gnss : Gnss

    Raises
    ------
    RecordingError
    """
    known = gnss.take(np.isfinite(gnss.lla).all(axis=1))
    if len(known) < _ENOUGH:
        return
    speed = np.hypot(*horizontal_velocity(known.time, known.lla, known.v_n).T)
    time, speed = known.time[np.isfinite(speed)], speed[np.isfinite(speed)]
    for k, leap in _holes(wheels.time):
        rows = (time >= wheels.time[k - 1]) & (time < wheels.time[k - 1] + _WINDOW)
        if rows.sum() < _ENOUGH:
            continue
        late = wheels.time[k:], np.abs(wheels.speed[k:])
        plain, moved = (
            float(np.clip(np.abs(np.interp(time[rows] + by, *late) - speed[rows]), 0.0, _MOST_MISFIT).mean())
            for by in (0.0, leap)
        )
        if plain > 0.5 and moved < 0.5 * plain:
            _refuse(log, wheels.time[k], leap, "speeds after it agree with the fixes' only without")


def _holes(time: Array) -> list[tuple[int, float]]:
    """Rows after a silence, and how much longer it was than usual [s]."""
    if len(time) < 3:
        return []
    step = np.diff(time)
    longer = step - float(np.median(step))
    rows = np.flatnonzero(longer >= _HOLE)
    rows = np.sort(rows[np.argsort(longer[rows])[::-1][:_MOST_HOLES]])
    return [(int(k) + 1, float(longer[k])) for k in rows]


def _velocity(time: Array, lla: Array, v_n: Array, rows: NDArray[np.int64], side: int) -> Array:
    """Horizontal velocity at some rows: as measured, or by positions a second or more to one side."""
    other = np.searchsorted(time, time[rows] + side * 1.0 - 1e-6)
    other = np.clip(other - (side < 0), 0, len(time) - 1)
    span = np.where(other == rows, np.nan, time[other] - time[rows])
    span[np.abs(span) > 3.0] = np.nan
    way = offset_ned(lla[other], lla[rows])[:, :2] / span[:, None]
    return np.where(np.isfinite(v_n[rows, :2]), v_n[rows, :2], way)


def _least_way(span: float, before: float, after: float) -> float:
    """Shortest way [m] of a car that drove at one speed before and at another after."""
    slowest = max(0.5 * (before + after - _HARD * span), 0.0)
    return (before**2 + after**2 - 2.0 * slowest**2) / (2.0 * _HARD)


def _agrees_moved(imu: Imu, gnss: Gnss, later: float) -> bool:
    """Whether turns agree, and leave half as much unexplained as those of stamps that are not moved."""
    moved = _turning(imu, gnss, later)
    return moved > _AGREED and 1.0 - moved**2 < 0.5 * (1.0 - _turning(imu, gnss, 0.0) ** 2)


def _turning(imu: Imu, gnss: Gnss, later: float) -> float:
    """How well turns that are felt agree with those of the course, its stamps moved."""
    told = felt(imu, replace(gnss, time=gnss.time + later))
    return turning_axis(told).correlation if len(told.turn) >= _ENOUGH else 0.0


def _check_years(log: Log, time: Array, imu: Array) -> None:
    """Refuse a log that leapt out of the IMU's time, and goes on there for as long as the IMU does."""
    for k, leap in _holes(time):
        left, goes_on = float(imu[-1] - time[k - 1]), float(time[-1] - time[k])
        if (
            leap > MOST_SILENCE
            and time[k] > imu[-1]
            and left > 60.0
            and abs(left - goes_on) < 30.0 + 0.1 * left
        ):
            _refuse(log, time[k], leap, "the IMU's goes on")


def _refuse(log: Log, time: float, leap: float, why: str) -> NoReturn:
    k = int(np.flatnonzero(log["time"] == time)[0])
    cure = f"{parts(log, np.array([k]))}; or take {leap:.6g} s off from there on, in each log that leapt"
    log.refuse(f"the clock leaps ahead by {in_words(leap)} here ({why})", cure, k)
