"""Reference and odometer logs."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless import earth
from gapless.attitude import wrap
from gapless.io.log import Log
from gapless.io.order import in_order, one_an_epoch
from gapless.io.satellite_log import POSITION, VELOCITY, check_positions
from gapless.io.streams import check_one_odometer, check_one_receiver
from gapless.trip.recording import Note, Odometer, Trajectory
from gapless.units import DEG

ATTITUDE: Final = ("roll", "pitch", "heading")
REFERENCE_COLUMNS: Final = ("time", *POSITION, *VELOCITY, *ATTITUDE)
ODOMETER_COLUMNS: Final = ("time", "speed")
_MOST_SPEED: Final = 150.0
"""Largest wheel speed [m/s] that a row may hold."""


def reference_from_log(log: Log) -> tuple[Trajectory, list[Note]]:
    """A reference trajectory; what it does not have is NaN.

    Parameters
    ----------
    log : Log
        `time` [s], `lat`, `lon` [deg], `height` [m]; optionally `v_north..down` [m/s] and `roll`,
        `pitch`, `heading` [deg] of the IMU's box.

    Returns
    -------
    trajectory : Trajectory
    notes : list of Note

    Raises
    ------
    RecordingError
        If columns or numbers are missing, out of range or out of order beyond mending.
    """
    log.require(("time", *POSITION))
    log.together(VELOCITY)
    log.together(ATTITUDE)
    log, notes = _known(log, np.isfinite(log["time"]) & check_positions(log))
    n = len(log)
    lla = log.stack(POSITION)
    lla[:, :2] *= DEG
    lla[:, 1] = earth.longitude(lla[:, 1])
    unknown = np.full((n, 9), np.nan)
    euler = log.stack(ATTITUDE) * DEG
    euler[:, [0, 2]] = wrap(euler[:, [0, 2]])
    source = np.full(n, "reference")
    path = Trajectory(log["time"], lla, log.stack(VELOCITY), euler, unknown, unknown[:, 0], source)
    check_one_receiver(log, path)
    return path, notes


def odometer_from_log(log: Log) -> tuple[Odometer, list[Note]]:
    """Wheel speeds.

    Parameters
    ----------
    log : Log
        `time` [s], `speed` [m/s].

    Returns
    -------
    odometer : Odometer
    notes : list of Note

    Raises
    ------
    RecordingError
        If columns or numbers are missing, or the speeds cannot be m/s.
    """
    log.require(ODOMETER_COLUMNS)
    speed = log["speed"]
    wild = np.abs(speed) > _MOST_SPEED
    if wild.sum() > 0.01 * len(log):
        k = int(np.argmax(wild))
        log.refuse(f"a speed of {speed[k]:.4g} m/s", "log speed in m/s", k)
    log, notes = _known(log, np.isfinite(log["time"]) & np.isfinite(speed) & ~wild)
    wheels = Odometer(log["time"], log["speed"])
    check_one_odometer(log, wheels)
    return wheels, notes


def _known(log: Log, keep: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> tuple[Log, list[Note]]:
    notes = []
    bad = int((~keep).sum())
    if keep.sum() < 2:
        log.refuse(f"{int(keep.sum())} of {len(log)} rows hold a value", "mend the log, or remove the file")
    if bad:
        notes.append(log.note("rows without a usable value dropped", bad))
        log = log.take(keep)
    return one_an_epoch(in_order(log, notes), notes), notes
