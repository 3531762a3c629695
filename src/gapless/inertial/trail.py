"""The last seconds of inertial velocity, free of corrections: what the mean over an epoch needs."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gapless._numba import kernel
from gapless.trip.recording import Array

GRAVITY = 9.8
"""Enough for telling what gravity did, and what a tilt feigns [m/s^2]."""
SPARE: Final = 64
"""Rows that are free after a trail grew."""


@kernel
def _mark(store: Array, first: int, k: int, time: float, v_n: Array, corrected: Array, length: float) -> int:
    """Write row k after those from `first` on; the first that is still needed."""
    store[k, 0] = time
    dt = time - store[k - 1, 0] if k > first else 0.0
    for i in range(1, 4):
        store[k, i] = v_n[i - 1] - corrected[i - 1]
        store[k, 3 + i] = (
            store[k - 1, 3 + i] + 0.5 * (store[k, i] + store[k - 1, i]) * dt if k > first else 0.0
        )
    while k - first > 1 and store[first + 1, 0] < time - length:
        first += 1
    return first


class Trail:
    """Velocity gained since the start, and its integral, at the recent stops of the propagation.

    Parameters
    ----------
    length : float
        How far back it reaches [s]; 0 keeps nothing and costs nothing.

    Attributes
    ----------
    corrected : ndarray, shape (3,)
        Sum of all corrections of the velocity [m/s]; never changed in place.
    """

    __slots__ = ("_end", "_first", "_store", "corrected", "length")

    def __init__(self, length: float = 0.0) -> None:
        self.length = length
        self.corrected = np.zeros(3)
        self._store = np.empty((0, 7))
        self._first = self._end = 0

    @property
    def marks(self) -> Array:
        """Time [s], velocity gained [m/s] and its integral [m] at each stop, shape (k, 7)."""
        return self._store[self._first : self._end]

    def mark(self, time: float, v_n: Array) -> None:
        """Take the present velocity in.

        Parameters
        ----------
        time : float
            [s]
        v_n : ndarray, shape (3,)
            Velocity, with all corrections so far [m/s].
        """
        if self.length <= 0.0:
            return
        if self._end == len(self._store):
            self._make_room()
        self._first = _mark(self._store, self._first, self._end, time, v_n, self.corrected, self.length)
        self._end += 1

    def _make_room(self) -> None:
        kept = self.marks
        self._store = np.empty((len(kept) + SPARE, 7))
        self._store[: len(kept)] = kept
        self._first, self._end = 0, len(kept)

    def shift(self, dv: Array) -> None:
        """Note a correction of the velocity, which is no motion.

        Parameters
        ----------
        dv : ndarray, shape (3,)
            [m/s]
        """
        if self.length > 0.0:
            self.corrected = self.corrected + dv

    def behind(self, window: float) -> tuple[Array, Array]:
        """By how much past velocities fell short of the present one, were it not for corrections since.

        Parameters
        ----------
        window : float
            How far back [s].

        Returns
        -------
        times : ndarray, shape (k,)
            The last one is the present; the first lies before the window where the trail reaches so far.
        gained : ndarray, shape (k, 3)
            Velocity gained since the present, so mostly the negative of what was gained up to it [m/s].
        """
        kept = self.marks
        if not len(kept):
            return np.zeros(0), np.zeros((0, 3))
        begin = kept[-1, 0] - window
        kept = kept[max(int(kept[:, 0].searchsorted(begin, side="right")) - 1, 0) :]
        return kept[:, 0].copy(), kept[:, 1:4] - kept[-1, 1:4]

    def lag(self, window: float) -> tuple[Array, Array]:
        """By how much the present velocity exceeds its mean over a window that ends now.

        Parameters
        ----------
        window : float
            [s]; shortened to what is kept.

        Returns
        -------
        lag, lag_force : ndarray, shape (3,)
            In all, and the part that specific force gained, NED [m/s].
        """
        marks = self.marks
        if window <= 0.0 or len(marks) < 2:
            return np.zeros(3), np.zeros(3)
        times, gained, path = marks[:, 0], marks[:, 1:4], marks[:, 4:]
        start = max(times[-1] - window, times[0])
        k = min(int(times.searchsorted(start, side="right")), len(marks) - 1)
        share = (start - times[k - 1]) / (times[k] - times[k - 1])
        begun = path[k - 1] + (start - times[k - 1]) * (
            gained[k - 1] + 0.5 * share * (gained[k] - gained[k - 1])
        )
        span = max(times[-1] - start, math.ulp(1.0))
        lag = gained[-1] - (path[-1] - begun) / span
        return lag, lag - np.array([0.0, 0.0, 0.5 * GRAVITY * span])

    def copy(self) -> Trail:
        """An independent copy.

        Returns
        -------
        Trail
        """
        new = Trail(self.length)
        new.corrected = self.corrected
        if self.length > 0.0:
            new._store, new._first, new._end = self._store, self._first, self._end
            new._make_room()
        return new
