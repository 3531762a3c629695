"""The last seconds of inertial velocity, free of corrections: what the mean over an epoch needs."""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from gapless.recording import Array

GRAVITY = 9.8
"""Enough for telling what gravity did, and what a tilt feigns [m/s^2]."""


class _Mark(NamedTuple):
    time: float
    gained: Array
    path: Array


class Trail:
    """Velocity gained since the start, and its integral, at the recent stops of the propagation.

    Parameters
    ----------
    length : float
        How far back it reaches [s]; 0 keeps nothing and costs nothing.
    """

    __slots__ = ("corrected", "length", "marks")

    def __init__(self, length: float = 0.0) -> None:
        self.length = length
        self.corrected = np.zeros(3)
        self.marks: deque[_Mark] = deque()

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
        gained, path = v_n - self.corrected, np.zeros(3)
        if self.marks:
            last = self.marks[-1]
            path = last.path + 0.5 * (gained + last.gained) * (time - last.time)
        self.marks.append(_Mark(time, gained, path))
        while len(self.marks) > 2 and self.marks[1].time < time - self.length:
            self.marks.popleft()

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
        if not self.marks:
            return np.zeros(0), np.zeros((0, 3))
        begin = self.marks[-1].time - window
        k = len(self.marks) - 1
        while k > 0 and self.marks[k].time > begin:
            k -= 1
        kept = list(self.marks)[k:]
        gained = np.array([mark.gained for mark in kept])
        return np.array([mark.time for mark in kept]), gained - gained[-1]

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
        if window <= 0.0 or len(self.marks) < 2:
            return np.zeros(3), np.zeros(3)
        now, first = self.marks[-1], self.marks[0]
        start = max(now.time - window, first.time)
        k = next(i for i in range(len(self.marks) - 1, 0, -1) if self.marks[i - 1].time <= start)
        a, b = self.marks[k - 1], self.marks[k]
        share = (start - a.time) / (b.time - a.time)
        begun = a.path + (start - a.time) * (a.gained + 0.5 * share * (b.gained - a.gained))
        span = max(now.time - start, math.ulp(1.0))
        lag = now.gained - (now.path - begun) / span
        return lag, lag - np.array([0.0, 0.0, 0.5 * GRAVITY * span])

    def copy(self) -> Trail:
        """An independent copy.

        Returns
        -------
        Trail
        """
        new = Trail(self.length)
        new.corrected, new.marks = self.corrected, self.marks.copy()
        return new
