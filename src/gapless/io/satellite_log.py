"""A GNSS log made sound: rows without a fix, order, fix codes, standard deviations, units."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless import earth
from gapless.io.log import Log
from gapless.io.order import in_order, one_an_epoch
from gapless.io.plausible import check_velocity
from gapless.io.streams import check_one_receiver
from gapless.io.unfilled import without_unfilled
from gapless.trip.recording import Array, Gnss, Note
from gapless.units import DEG

POSITION: Final = ("lat", "lon", "height")
VELOCITY: Final = ("v_north", "v_east", "v_down")
SD_POSITION: Final = ("sd_north", "sd_east", "sd_down")
SD_VELOCITY: Final = ("sd_v_north", "sd_v_east", "sd_v_down")
GNSS_COLUMNS: Final = ("time", *POSITION, *VELOCITY, *SD_POSITION, *SD_VELOCITY, "fix")

DEFAULT_SD: Final = {
    1: (3.0, 3.0, 6.0),
    2: (1.5, 1.5, 3.0),
    4: (0.02, 0.02, 0.04),
    5: (0.5, 0.5, 1.0),
}
"""Standard deviation north, east, down [m] by fix code where the receiver states none."""
DEFAULT_SD_VELOCITY: Final = (0.1, 0.1, 0.2)
"""The same for a Doppler velocity [m/s]."""
FLOOR_SD: Final = 0.005
"""Smallest credible standard deviation of a position [m]."""
FLOOR_SD_VELOCITY: Final = 0.02
"""The same of a velocity [m/s]."""
_ABSURD_SD: Final = 1000.0
"""A standard deviation [m or m/s] that means "unknown": 9999 and the like."""
_SPARE: Final = 0.1
"""Share of rows out of range beyond which a log is refused."""


def gnss_from_log(log: Log) -> tuple[Gnss, list[Note]]:
    """Fixes of a log, stamps as logged.

    Rows are put in order by `in_order`; of several with one stamp the first is kept.

    Parameters
    ----------
    log : Log
        `time` [s]; `lat`, `lon` [deg], `height` [m]; optionally `v_north..down` [m/s], standard
        deviations `sd_...` and `sd_v_...`, and `fix` (NMEA quality; 0, 6, 7 and 8 are no fix).

    Returns
    -------
    gnss : Gnss
    notes : list of Note
        What was mended.

    Raises
    ------
    RecordingError
        If columns or numbers are missing, out of range or out of order beyond mending.
    """
    log.require(("time", *POSITION))
    log.together(VELOCITY)
    notes: list[Note] = []
    log = _rows_with_fix(log, _fix_codes(log, notes), notes)
    log = one_an_epoch(in_order(log, notes), notes)
    fix = log["fix"].astype(np.int64)
    lla, v_n = log.stack(POSITION), log.stack(VELOCITY)
    lla[~np.isfinite(lla).all(axis=1)] = np.nan
    v_n[~np.isfinite(v_n).all(axis=1)] = np.nan
    lla[:, :2] *= DEG
    lla[:, 1] = earth.longitude(lla[:, 1])
    v_n = without_unfilled(log, lla, v_n, notes)
    default = np.array([DEFAULT_SD[int(code)] for code in fix])
    sd = _credible(log, SD_POSITION, default, FLOOR_SD, np.isfinite(lla), notes)
    default = np.broadcast_to(DEFAULT_SD_VELOCITY, v_n.shape)
    sd_v = _credible(log, SD_VELOCITY, default, FLOOR_SD_VELOCITY, np.isfinite(v_n), notes)
    gnss = Gnss(log["time"], lla, sd, v_n, sd_v, fix)
    check_one_receiver(log, gnss)
    check_velocity(log, gnss)
    return gnss, notes


MOST_LATITUDE: Final = 89.9
"""Latitude [deg] up to which north, east and heading serve to navigate.

Meridians converge by tan(lat) / R: at 89.9, 11 km from the pole, by 5 degrees a kilometre driven east, and
100 m of position error are 0.5 degrees of heading, as much as the filter knows it to. Simulated drives of
some km that begin at up to 89.89 are navigated as well as at 48, their clocks told; nothing broke at 89.95
either, but from there a drive reaches the pole itself, where there is no north.
"""


def check_positions(log: Log) -> NDArray[np.bool_]:
    """Which rows hold a position on earth.

    Parameters
    ----------
    log : Log

    Returns
    -------
    ndarray of bool, shape (n,)

    Raises
    ------
    RecordingError
        If more than a tenth of the positions are impossible, or too near a pole.
    """
    lat, lon, height = (log[name] for name in POSITION)
    there = np.isfinite(lat) & np.isfinite(lon) & np.isfinite(height)
    polar = there & (np.abs(lat) > MOST_LATITUDE) & (np.abs(lat) <= 90.0) & (lon >= -180.0) & (lon <= 360.0)
    if polar.sum() > max(2.0, _SPARE * there.sum()):
        k = int(np.argmax(polar))
        log.refuse(
            f"lat {lat[k]:.7g} is within {90.0 - MOST_LATITUDE:.1g} degrees of a pole, "
            "where north and heading turn with every metre",
            f"navigation holds up to {MOST_LATITUDE:g} degrees; give the part of the drive that lies below",
            k,
        )
    possible = (np.abs(lat) <= MOST_LATITUDE) & (lon >= -180.0) & (lon <= 360.0) & (np.abs(height) < 1e5)
    wrong = there & ~possible
    if wrong.sum() > max(2.0, _SPARE * there.sum()):
        k = int(np.argmax(wrong))
        cure = "check the order and units of the columns (deg, deg, m)"
        if abs(lat[k]) <= 360.0 and abs(lon[k]) <= 90.0:
            cure = "lat and lon look exchanged: swap the columns"
        log.refuse(f"no place on earth: lat {lat[k]:.7g}, lon {lon[k]:.7g}, height {height[k]:.5g}", cure, k)
    usable: NDArray[np.bool_] = there & possible & ((lat != 0.0) | (lon != 0.0))
    return usable


def _fix_codes(log: Log, notes: list[Note]) -> Array:
    """1, 2, 4, 5, or 0 for no fix."""
    if "fix" not in log:
        notes.append(log.note("no fix code; taken as single point", len(log)))
        return np.ones(len(log))
    stated = log["fix"]
    missing = ~np.isfinite(stated)
    if missing.any():
        notes.append(log.note("rows without a fix code; taken as single point", int(missing.sum())))
    fix = np.where(missing | (stated == 3), 1.0, stated)
    return np.where(np.isin(fix, list(DEFAULT_SD)), fix, 0.0)


def _rows_with_fix(log: Log, fix: Array, notes: list[Note]) -> Log:
    placed = check_positions(log)
    moving = np.isfinite(log.stack(VELOCITY)).all(axis=1)
    keep = np.isfinite(log["time"]) & (placed | moving) & (fix > 0)
    bad, null = int((~keep).sum()), keep & (log["lat"] == 0.0) & (log["lon"] == 0.0)
    if keep.sum() < 2:
        log.refuse(f"{int(keep.sum())} of {len(log)} rows hold a fix", "give a log of two fixes or more")
    if bad:
        notes.append(log.note("rows without a usable fix dropped", bad))
    if null.any():
        notes.append(log.note("positions at latitude 0, longitude 0 taken as not given", int(null.sum())))
    hidden = {name: np.where(placed, log[name], np.nan) for name in POSITION}
    return replace(log, columns={**log.columns, **hidden, "fix": fix}).take(keep)


def _credible(
    log: Log,
    names: tuple[str, ...],
    default: Array,
    floor: float,
    there: NDArray[np.bool_],
    notes: list[Note],
) -> Array:
    """Stated standard deviations where they can be believed, the default elsewhere."""
    if not there.any():
        return np.full(default.shape, np.nan)
    stated = log.stack(names)
    wrong = there & ~((stated > 0.0) & (stated < _ABSURD_SD))
    low = there & ~wrong & (stated < floor)
    stated = np.where(wrong, default, np.maximum(stated, floor))
    label = f"{names[0]}, {names[1]}, {names[2]}"
    used = ", ".join(f"{x:g}" for x in np.median(default, axis=0))
    if wrong.any():
        what = f"{label} missing, zero or absurd; taken as the fix code's usual, {used}"
        notes.append(log.note(what, int(wrong.any(axis=1).sum())))
    if low.any():
        notes.append(log.note(f"{label} below {floor:g}; raised to it", int(low.any(axis=1).sum())))
    return np.where(there, stated, np.nan)
