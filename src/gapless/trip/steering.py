"""Where a car drove, and how its velocity changed there: accelerations and turns, as GNSS tells them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.trip.motion import horizontal_velocity
from gapless.trip.recording import Array, Gnss

STEERED_SPEED: Final = 3.0
"""Slower than this, a turn of the course says little [m/s]."""


class Steered(NamedTuple):
    """Seconds in which a car drove, and its velocity around each.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s], a second apart or more.
    before, now, after : ndarray, shape (n, 2)
        Horizontal velocity [m/s] half a window earlier, then, and half a window later.
    """

    time: Array
    before: Array
    now: Array
    after: Array

    @property
    def turned(self) -> Array:
        """How far the course turned to the right within the window [rad]."""
        a, b = self.before, self.after
        return np.asarray(np.arctan2(rightward(a, b), (a * b).sum(axis=1)))


def steered(gnss: Gnss, half: float) -> Steered:
    """Velocities around the seconds in which a car drove, as GNSS tells them.

    Parameters
    ----------
    gnss : Gnss
    half : float
        Half the window [s].

    Returns
    -------
    Steered
    """
    gnss = gnss.take(np.isfinite(gnss.lla).all(axis=1))
    v = horizontal_velocity(gnss.time, gnss.lla, gnss.v_n) if len(gnss) > 1 else np.zeros((len(gnss), 2))
    heard = np.isfinite(v).all(axis=1)
    time, v = gnss.time[heard], v[heard]
    if len(time) < 2:
        return Steered(np.zeros(0), *np.zeros((3, 0, 2)))
    at = time[0] + half + _seconds(time - time[0] - half, 1.5 * half)
    at = at[at < time[-1] - half]
    three = [np.column_stack([np.interp(at + s, time, c) for c in v.T]) for s in (-half, 0.0, half)]
    near = np.searchsorted(time, at + 1.5 * half) - np.searchsorted(time, at - 1.5 * half) >= 3
    drove = near & (np.min([np.hypot(*u.T) for u in three], axis=0) > STEERED_SPEED)
    return Steered(at[drove], *(u[drove] for u in three))


def _seconds(time: Array, reach: float) -> Array:
    """Whole seconds from zero on with a reading within reach: of a log's span, however long it is silent."""
    around = np.arange(-np.ceil(reach), np.ceil(reach) + 1.0)
    seconds = np.unique(np.floor(time)[:, None] + around)
    return np.asarray(seconds[seconds >= 0.0])


def rightward(a: Array, b: Array) -> Array:
    """How far b lies to the right of a, times both lengths.

    Parameters
    ----------
    a, b : ndarray, shape (n, 2)
        North, east.

    Returns
    -------
    ndarray, shape (n,)
    """
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
