"""Whether a receiver's places and speeds tell one story: how far it went, by either."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless._numba import kernel
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


@kernel
def ways(rows: Array, n: int, here: Array, doubt: float) -> tuple[bool, bool, bool]:
    """Hold ways between places against ways that velocities add up to.

    Parameters
    ----------
    rows : ndarray, shape (SLOTS, 5)
        Time [s], place, and way by velocities so far [m].
    n : int
        Rows in use.
    here : ndarray, shape (5,)
        The present one.
    doubt : float
        What noise makes of the difference [m].

    Returns
    -------
    some, torn, drove : bool
        Whether there was anything to compare; whether any ways disagree; whether the longest was a drive.
    """
    some = torn = drove = False
    for i in range(n):
        dt = here[0] - rows[i, 0]
        if dt >= REACH or dt < LEAST:
            continue
        north, east = here[1] - rows[i, 1], here[2] - rows[i, 2]
        off = np.hypot(north - here[3] + rows[i, 3], east - here[4] + rows[i, 4])
        torn |= off > doubt + LAXITY * dt
        if not some:
            drove = np.hypot(north, east) > 3.0 * dt
        some = True
    return some, torn, drove


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
            self.forget()
            return
        here = np.array([time, *place, *(self.way + (time - self.time) * self.v_n)])
        some, torn, drove = ways(self.rows, self.n, here, DOUBT * math.sqrt(2.0) * sd)
        if some:
            self.since = math.inf if torn else min(self.since, time)
            self.torn, self.drove = torn, drove
        if not self.n or time - self.rows[self.n - 1, 0] >= APART:
            rows = self.rows.copy()
            if self.n == SLOTS:
                rows[:-1] = self.rows[1:]
                self.n -= 1
            rows[self.n] = here
            self.rows, self.n = rows, self.n + 1

    def forget(self) -> None:
        """What was torn is explained: the places so far were not believed."""
        self.torn, self.since, self.n = False, math.inf, 0

    def copy(self) -> Self:
        """An independent copy."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        return new
