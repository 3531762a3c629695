"""Whether a receiver's places and speeds tell one story: how far it went, by either."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless.trip.recording import Array

SLOTS: Final = 14
APART: Final = 0.9
"""Positions closer than this are looked at as one [s]."""
REACH: Final = 10.0
"""Over this long ways are compared [s]."""
LEAST: Final = 3.5
"""Ways over less tell nothing [s]."""
DOUBT: Final = 4.0
"""Deviations of the difference of two positions that noise makes."""
LAXITY: Final = 0.4
"""Error of a mean velocity that is no contradiction [m/s]."""
UNHEARD: Final = 3.0
"""A receiver without velocities for so long tells one story only [s]."""


@dataclass
class Story:
    """A receiver's positions beside the way that its velocities add up to.

    Parameters
    ----------
    rows : ndarray, shape (slots, 5)
        Time [s], position north and east, way by velocities north and east [m]; replaced, never changed.
    n : int
        Rows in use.
    way : ndarray, shape (2,)
        By velocities, so far [m].
    time : float
        Of the last velocity [s].
    v_n : ndarray, shape (2,)
        [m/s]
    """

    rows: Array = field(default_factory=lambda: np.zeros((SLOTS, 5)))
    n: int = 0
    way: Array = field(default_factory=lambda: np.zeros(2))
    time: float = -math.inf
    v_n: Array = field(default_factory=lambda: np.zeros(2))
    torn: bool = False
    since: float = math.inf
    drove: bool = False

    def moved(self, time: float, v_n: Array) -> None:
        """Take in a velocity.

        Parameters
        ----------
        time : float
            [s]
        v_n : ndarray, shape (2,)
            North, east [m/s].
        """
        if time - self.time > UNHEARD:
            self.n, self.since = 0, math.inf
        else:
            self.way = self.way + 0.5 * (time - self.time) * (v_n + self.v_n)
        self.time, self.v_n = time, v_n

    def stood(self, time: float, place: Array, sd: float) -> None:
        """Take in a position, and see whether the ways to it agree.

        Parameters
        ----------
        time : float
            [s]
        place : ndarray, shape (2,)
            North, east of anywhere [m].
        sd : float
            Of its noise [m].
        """
        if time - self.time > UNHEARD:
            self.torn, self.since, self.n = False, math.inf, 0
            return
        here = np.array([time, *place, *(self.way + (time - self.time) * self.v_n)])
        past = self.rows[: self.n]
        past = past[(time - past[:, 0] < REACH) & (time - past[:, 0] >= LEAST)]
        if len(past):
            step = here - past
            off = np.hypot(step[:, 1] - step[:, 3], step[:, 2] - step[:, 4])
            torn = bool((off > DOUBT * math.sqrt(2.0) * sd + LAXITY * step[:, 0]).any())
            self.since = math.inf if torn else min(self.since, time)
            self.torn, self.drove = torn, bool(np.hypot(step[0, 1], step[0, 2]) > 3.0 * step[0, 0])
        if not self.n or time - self.rows[self.n - 1, 0] >= APART:
            rows = self.rows.copy()
            if self.n == SLOTS:
                rows[:-1] = self.rows[1:]
                self.n -= 1
            rows[self.n] = here
            self.rows, self.n = rows, self.n + 1

    def copy(self) -> Self:
        """An independent copy."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        return new
