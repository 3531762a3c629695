"""An IMU log made sound: rows without a value, stamps and units; what cannot be mended is refused."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.io.clock import even_stamps, hole_length, intervals, nominal_interval
from gapless.io.log import Log
from gapless.io.order import in_order
from gapless.io.silence import check_silence
from gapless.io.streams import check_one_device
from gapless.trip.events import GAP
from gapless.trip.recording import Array, Imu, Note

GYRO: Final = ("gyro_x", "gyro_y", "gyro_z")
ACCEL: Final = ("accel_x", "accel_y", "accel_z")
DTHETA: Final = ("dtheta_x", "dtheta_y", "dtheta_z")
DVEL: Final = ("dvel_x", "dvel_y", "dvel_z")
IMU_COLUMNS: Final = ("time", *GYRO, *ACCEL, "dt")

_MOST_GYRO: Final = 70.0
"""Largest rate [rad/s] that a row may hold: 4000 deg/s, the widest range of MEMS gyros."""
_MOST_ACCEL: Final = 400.0
"""Largest specific force [m/s^2]: 40 g, beyond the 16 g of consumer accelerometers."""
_BUSY_GYRO: Final = 3.5
"""Rate [rad/s] that a vehicle exceeds in less than 1 % of its rows (200 deg/s); a log in deg/s of a
drive with turns exceeds it (the seven test drives: 13 to 31 deg/s)."""
_GRAVITY_BAND: Final = (7.0, 12.5)
"""Where the median specific force [m/s^2] of any vehicle lies, biases of 1 m/s^2 included."""
_UNSTEADY: Final = 0.6
"""Gravity is steady: a force that scatters (16 to 84 %) by more of its size has none in it."""
_SAMPLES: Final = 20_000
"""Rows, evenly spread, that the units are judged by."""
_STUCK: Final = 1000
"""Rows without any change from which on a sensor is taken for dead."""
_SPARE: Final = 0.2
"""Share of rows without a value beyond which a log is refused."""
_SPARE_SPIKES: Final = 1e-3
"""Share of rows with impossible values beyond which a log is refused."""


def imu_from_rates(log: Log, axes: Array | None = None) -> tuple[Imu, list[Note]]:
    """Increments of a log of sampled rates.

    Parameters
    ----------
    log : Log
        `time` [s], `gyro_x..z` [rad/s], `accel_x..z` [m/s^2]; `dt` [s] where the intervals are
        known (then stamps are taken as they are).
    axes : ndarray, shape (3, 3), optional
        Logged axes to forward-right-down.

    Returns
    -------
    imu : Imu
    notes : list of Note
        What was mended.

    Raises
    ------
    RecordingError
        If a column or its numbers are missing, stamps go back, or units cannot be right.
    """
    log.require(("time", *GYRO, *ACCEL))
    log, notes = _sound_rows(log, GYRO, ACCEL)
    gyro, accel = log.stack(GYRO), log.stack(ACCEL)
    _check_units(log, gyro, accel)
    check_one_device(log, np.column_stack([gyro, accel]))
    if "dt" in log:
        time, dt, mended = _given_intervals(log)
    else:
        time, dt, mended = _stamps(log)
    notes += mended
    if axes is not None:
        gyro, accel = gyro @ axes.T, accel @ axes.T
    return Imu.from_rates(time, gyro, accel, dt), notes


def imu_from_increments(log: Log) -> tuple[Imu, list[Note]]:
    """A log of increments, each over the interval that ends at its stamp.

    Where rows are missing, an increment covers its own interval only or the whole time since the row
    before, whichever its velocity increment is nearer to under gravity. In the first case it is stretched
    over a short time; a longer one is a hole.

    Parameters
    ----------
    log : Log
        `time` [s], `dtheta_x..z` [rad], `dvel_x..z` [m/s], forward-right-down.

    Returns
    -------
    imu : Imu
    notes : list of Note

    Raises
    ------
    RecordingError
        As `imu_from_rates`.
    """
    log.require(("time", *DTHETA, *DVEL))
    log, notes = _sound_rows(log, DTHETA, DVEL)
    dtheta, dvel = log.stack(DTHETA), log.stack(DVEL)
    period = nominal_interval(log["time"])
    _check_units(log, dtheta / period, dvel / period)
    check_one_device(log, np.column_stack([dtheta, dvel]))
    time, dt, mended = _stamps(log)
    notes += mended
    whole = np.diff(time, prepend=time[0] - period)
    covers = (whole > dt) & (np.linalg.norm(dvel, axis=1) >= 0.5 * 9.8 * (whole + period))
    dt[covers] = whole[covers]
    late = np.flatnonzero(~covers & (dt > 1.5 * period))
    force = np.linalg.norm(dvel[late], axis=1)
    late = late[force < 0.5 * 9.8 * (dt[late] + period)]
    if len(late):
        stretch = (dt[late] / period)[:, None]
        dtheta[late] *= stretch
        dvel[late] *= stretch
        notes.append(log.note("rows lost: the next increment is stretched over their time", len(late)))
    return Imu(time, dt, dtheta, dvel), notes


def _sound_rows(log: Log, gyro: tuple[str, ...], accel: tuple[str, ...]) -> tuple[Log, list[Note]]:
    """Rows that hold numbers, once each and in order."""
    notes = []
    names = ("time", *gyro, *accel)
    whole = np.isfinite(sum(log[name] for name in names))
    bad = int((~whole).sum())
    if bad > _SPARE * len(log) or whole.sum() < 2:
        k = int(np.argmin(whole))
        log.refuse(f"{bad} of {len(log)} rows lack a value, this one first", "export the log again", k)
    if bad:
        notes.append(log.note("rows without a value dropped, bridged by the next sample", bad))
        log = log.take(whole)
    log = in_order(log, notes)
    if not np.diff(log["time"]).any():
        log.refuse("all stamps are the same", "log the time of each sample")
    _check_time_unit(log)
    check_silence(log)
    return _without_spikes(log, gyro, accel, notes), notes


def _without_spikes(log: Log, gyro: tuple[str, ...], accel: tuple[str, ...], notes: list[Note]) -> Log:
    per_second = 1.0 if gyro == GYRO else 1.0 / nominal_interval(log["time"])
    rate = per_second * np.maximum.reduce([np.abs(log[name]) for name in gyro])
    force = per_second * np.maximum.reduce([np.abs(log[name]) for name in accel])
    wild = (rate > _MOST_GYRO) | (force > _MOST_ACCEL)
    bad = int(wild.sum())
    if bad > max(3.0, _SPARE_SPIKES * len(log)) or len(log) - bad < 2:
        k = int(np.argmax(wild))
        log.refuse(
            f"impossible values in {bad} rows, here {rate[k]:.4g} rad/s and {force[k]:.4g} m/s^2",
            "check units (rad/s, m/s^2) and the order of the columns",
            k,
        )
    if bad:
        notes.append(log.note("rows with impossible values dropped, bridged by the next sample", bad))
        return log.take(~wild)
    return log


def _check_time_unit(log: Log) -> None:
    period = nominal_interval(log["time"])
    if 5e-5 <= period <= 0.5:
        return
    for unit, seconds in (("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)):
        if 5e-4 <= period * seconds <= 0.2:
            log.refuse(
                f"samples are {period:.6g} apart, so time looks like {unit}", f"multiply it by {seconds:g}"
            )
    log.refuse(
        f"samples are {period:.3g} s apart, not an IMU's rate of 2 to 20000 Hz", "check the unit of time (s)"
    )


def _check_units(log: Log, gyro: Array, accel: Array) -> None:
    some = slice(None, None, 1 + len(gyro) // _SAMPLES)
    norms = np.linalg.norm(accel[some], axis=1)
    force = float(np.median(norms))
    turn = np.linalg.norm(gyro[some], axis=1)
    low, high = _GRAVITY_BAND
    if not low <= force <= high:
        what = f"the median specific force is {force:.4g} m/s^2, not about 9.8"
        if low <= float(np.median(turn)) <= high:
            log.refuse(what + ", but the gyro's norm is", "exchange the gyro and accelerometer columns")
        if force < low and float(np.subtract(*np.percentile(norms, [84, 16]))) > _UNSTEADY * force:
            log.refuse(
                f"{what}, and changes as much: it looks like acceleration without gravity",
                "log specific force, with gravity in it",
            )
        increments = 1.0 / nominal_interval(log["time"])
        for unit, factor in (("g", 9.80665), ("milli-g", 9.80665e-3), ("increments", increments)):
            if low <= force * factor <= high:
                log.refuse(f"{what}: it looks like {unit}", f"multiply the accelerations by {factor:g}")
        log.refuse(what, "log specific force in m/s^2, gravity included, and check the order of the columns")
    for name, triad in (("gyros", gyro), ("accelerometers", accel)):
        if len(triad) > _STUCK and not np.ptp(triad, axis=0).any():
            log.refuse(f"the {name} read the same in every row", "log what they measured")
    busy = float(np.percentile(turn, 99.0))
    if busy > _BUSY_GYRO:
        log.refuse(
            f"1 % of the rates exceed {busy:.3g} rad/s, too much for a vehicle: they look like deg/s",
            "multiply the gyro columns by pi/180",
        )


def _stamps(log: Log) -> tuple[Array, Array, list[Note]]:
    """Mended stamps and the interval of each row."""
    notes = []
    period = nominal_interval(log["time"])
    time, begin = even_stamps(log["time"], period)
    if begin < len(time):
        repeats = int((np.diff(log["time"]) == 0.0).sum())
        moved = float(np.abs(time - log["time"]).max())
        what = (
            f"{repeats} stamps repeat: from row {log.number(begin)} on, a clock filter (nominal interval "
            f"{1e3 * period:.4g} ms) spaces them evenly, moving them by up to {1e3 * moved:.3g} ms"
        )
        notes.append(log.note(what, len(time) - begin))
    dt, hole = intervals(time, period)
    notes += _hole_notes(log, np.diff(time)[hole[1:]])
    late = int(((dt > 1.5 * period) & ~hole).sum())
    if late:
        notes.append(log.note("intervals longer than 1.5 nominal ones, covered by the next sample", late))
    plain = dt[(dt <= 1.5 * period) & ~hole]
    if begin == len(time) and np.ptp(plain) > 0.05 * period:
        what = f"intervals vary from {1e3 * plain.min():.3g} to {1e3 * plain.max():.3g} ms; taken as stamped"
        notes.append(log.note(what))
    return time, dt, notes


def _given_intervals(log: Log) -> tuple[Array, Array, list[Note]]:
    """Stamps and intervals as logged; stretched to the row before where rows between were dropped."""
    time, dt = log["time"], log["dt"].copy()
    silent = np.diff(time) - dt[1:]
    wrong = ~(dt > 0.0) | ~np.isfinite(dt)
    wrong[1:] |= silent < -1e-3 * np.median(dt)
    if wrong.any():
        k = int(np.argmax(wrong))
        what = f"dt is {dt[k]:.6g} s: not positive, or more than the time since the row before"
        log.refuse(what, "mend it, or leave the column out", k)
    hole = silent > hole_length(float(np.median(dt)))
    if log.rows is not None:
        lost = 1 + np.flatnonzero((np.diff(np.sort(log.rows)) > 1) & ~hole)
        dt[lost] = time[lost] - time[lost - 1]
    return time, dt, _hole_notes(log, np.diff(time)[hole])


def _hole_notes(log: Log, silent: Array) -> list[Note]:
    notes = []
    for what, some in (
        ("holes, {}; bridged by what was felt on both sides", silent[silent <= GAP]),
        ("gaps, {}; left open", silent[silent > GAP]),
    ):
        if len(some):
            lasted = f"{some.sum():.1f} s in all, the longest {some.max():.2f} s"
            notes.append(log.note(what.format(lasted), len(some)))
    return notes
