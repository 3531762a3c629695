"""The last seconds of inertial velocity, free of corrections: what the mean over an epoch needs."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless._numba import inline, kernel
from gapless.recording import Array

GRAVITY = 9.8
"""Enough for telling what gravity did, and what a tilt feigns [m/s^2]."""
SPARE: Final = 64
"""Rows that are free after a trail grew."""


@inline
def full(store: Array, ends: NDArray[np.int64]) -> bool:
    """Whether not one mark more finds room; what is no longer wanted makes room first.

    Parameters
    ----------
    store, ends
        As `Trail` keeps them.

    Returns
    -------
    bool
    """
    if ends[1] == store.shape[0] and ends[0] > 0:
        for i in range(ends[0], ends[1]):
            for j in range(7):
                store[i - ends[0], j] = store[i, j]
        ends[0], ends[1] = 0, ends[1] - ends[0]
    return bool(ends[1] == store.shape[0])


@inline
def note(
    store: Array, ends: NDArray[np.int64], length: float, corrected: Array, time: float, v_n: Array
) -> None:
    """Take the present velocity in, where there is room; see `Trail.mark`.

    Parameters
    ----------
    store, ends, length, corrected
        As `Trail` keeps them.
    time : float
        [s]
    v_n : ndarray, shape (3,)
        [m/s]
    """
    k = ends[1]
    store[k, 0] = time
    for j in range(3):
        gained = v_n[j] - corrected[j]
        store[k, 1 + j], store[k, 4 + j] = gained, 0.0
        if k > ends[0]:
            mean = 0.5 * (gained + store[k - 1, 1 + j])
            store[k, 4 + j] = store[k - 1, 4 + j] + mean * (time - store[k - 1, 0])
    ends[1] = k + 1
    while ends[1] - ends[0] > 2 and store[ends[0] + 1, 0] < time - length:
        ends[0] += 1


@kernel
def _note(
    store: Array, ends: NDArray[np.int64], length: float, corrected: Array, time: float, v_n: Array
) -> bool:
    if full(store, ends):
        return False
    note(store, ends, length, corrected, time, v_n)
    return True


class Mark(NamedTuple):
    """A stop of the propagation.

    Parameters
    ----------
    time : float
        [s]
    gained, path : ndarray, shape (3,)
        Velocity gained since the start [m/s], and its integral [m].
    """

    time: float
    gained: Array
    path: Array


class Trail:
    """Velocity gained since the start, and its integral, at the recent stops of the propagation.

    Parameters
    ----------
    length : float
        How far back it reaches [s]; 0 keeps nothing and costs nothing.

    Attributes
    ----------
    store : ndarray, shape (k, 7)
        Time, velocity gained, path of each mark; rows outside `ends` are none.
    ends : ndarray of int, shape (2,)
        First row, and one after the last.
    corrected : ndarray, shape (3,)
        Sum of all corrections [m/s].
    """

    __slots__ = ("corrected", "ends", "length", "store")

    def __init__(self, length: float = 0.0) -> None:
        self.length = length
        self.corrected = np.zeros(3)
        self.store = np.empty((SPARE if length > 0.0 else 0, 7))
        self.ends = np.zeros(2, np.int64)

    @property
    def marks(self) -> list[Mark]:
        """Those kept, in order of time."""
        return [Mark(float(row[0]), row[1:4], row[4:]) for row in self._kept]

    @property
    def _kept(self) -> Array:
        first, end = self.ends.tolist()
        return self.store[first:end]

    def mark(self, time: float, v_n: Array) -> None:
        """Take the present velocity in.

        Parameters
        ----------
        time : float
            [s]
        v_n : ndarray, shape (3,)
            Velocity, with all corrections so far [m/s].
        """
        while self.length > 0.0 and not _note(self.store, self.ends, self.length, self.corrected, time, v_n):
            self.grow()

    def grow(self) -> None:
        """Make room for more."""
        kept = self._kept
        self.store = np.empty((2 * len(kept) + SPARE, 7))
        self.store[: len(kept)] = kept
        self.ends = np.array([0, len(kept)])

    def shift(self, dv: Array) -> None:
        """Note a correction of the velocity, which is no motion.

        Parameters
        ----------
        dv : ndarray, shape (3,)
            [m/s]
        """
        if self.length > 0.0:
            self.corrected += dv

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
        kept = self._kept
        if not len(kept):
            return np.zeros(0), np.zeros((0, 3))
        times = kept[:, 0]
        k = max(0, int(np.searchsorted(times, times[-1] - window, side="right")) - 1)
        return times[k:].copy(), kept[k:, 1:4] - kept[-1, 1:4]

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
        kept = self._kept
        if window <= 0.0 or len(kept) < 2:
            return np.zeros(3), np.zeros(3)
        times, gained, path = kept[:, 0], kept[:, 1:4], kept[:, 4:]
        now = float(times[-1])
        start = max(now - window, float(times[0]))
        k = min(int(np.searchsorted(times, start, side="right")), len(kept) - 1)
        late = start - float(times[k - 1])
        share = late / (float(times[k]) - float(times[k - 1]))
        begun = path[k - 1] + late * (gained[k - 1] + 0.5 * share * (gained[k] - gained[k - 1]))
        span = max(now - start, math.ulp(1.0))
        lag = gained[-1] - (path[-1] - begun) / span
        return lag, lag - np.array([0.0, 0.0, 0.5 * GRAVITY * span])

    def copy(self) -> Trail:
        """An independent copy.

        Returns
        -------
        Trail
        """
        new = object.__new__(Trail)
        new.length, new.corrected = self.length, self.corrected.copy()
        new.store, new.ends = self.store.copy(), self.ends.copy()
        return new
