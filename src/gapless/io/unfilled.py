"""Columns that were logged and never filled: velocities of exactly zero while the positions move."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.io.log import Log
from gapless.trip.motion import FIRST_MOTION_SPEED, offset_ned, velocity_from_positions
from gapless.trip.recording import Array, Note

_FAR: Final = 30.0
"""Way from the first fixes [m] that count as having moved: ten times a single point's noise."""
_AT_LEAST: Final = 5
"""Fixes as far as that, at least: a few may be astray."""


def without_unfilled(log: Log, lla: Array, v_n: Array, notes: list[Note]) -> Array:
    """Velocities, those left out that are zero in all three components although the car moves.

    If every velocity is zero and the positions move, there is none; if some are, those go at which the
    positions a second before and after are too far apart for a car that stands.

    Parameters
    ----------
    log : Log
        For its stamps and the note.
    lla, v_n : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m], and velocity [m/s]; NaN where there is none.
    notes : list of Note
        Appended to.

    Returns
    -------
    ndarray, shape (n, 3)
        [m/s]
    """
    zero = (v_n == 0.0).all(axis=1)
    placed = np.isfinite(lla).all(axis=1)
    if not zero.any() or placed.sum() < 2:
        return v_n
    if zero[np.isfinite(v_n).all(axis=1)].all():
        there = lla[placed]
        middle = np.median(there[:_AT_LEAST], axis=0)
        away = np.hypot(*offset_ned(there, np.broadcast_to(middle, there.shape))[:, :2].T)
        if (away > _FAR).sum() < _AT_LEAST:
            return v_n
        what = "v_north, v_east, v_down are zero in every row while the positions move: taken as not given"
        unfilled = zero
    else:
        speed = np.zeros(len(zero))
        speed[placed] = np.hypot(*velocity_from_positions(log["time"][placed], lla[placed]).T)
        unfilled = zero & (speed > FIRST_MOTION_SPEED)
        what = "v_north, v_east, v_down are zero while the positions move: taken as not given there"
    if not unfilled.any():
        return v_n
    notes.append(log.note(what, int(unfilled.sum())))
    return np.where(unfilled[:, None], np.nan, v_n)
