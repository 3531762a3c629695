"""Whether a channel changed as the inertial sensors felt: the only thing that needs no belief in either.

A filter's error is continuous: it grows as accelerations that it got wrong do. What a channel says that
leaps against the inertial motion was said wrongly, however healthy the channel calls itself. With z the
innovation and c the corrections so far as the channel sees them, z + c changes by the channel's own
change less the inertial one, whatever the filter believes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple, Self

import numpy as np

from gapless._numba import kernel
from gapless.trip.recording import Array

SLOTS: Final = 18
"""Readings that are kept."""
APART: Final = 0.45
"""Readings closer than this are looked at as one [s]."""
REACH: Final = 8.0
"""Over this long increments are held against each other [s]."""
DOUBT: Final = 5.0
"""Deviations of the difference of two readings that noise makes."""


class Slack(NamedTuple):
    """By how much increments may differ beyond the readings' noise, after dt seconds.

    Parameters
    ----------
    rate : float
        Times dt: an error of the filter's velocity for a position, of its acceleration for a velocity.
    bend : float
        Times dt^2 / 2.
    """

    rate: float
    bend: float = 0.0


TURNED: Final = 0.5
"""Where lengths of changes agree to this share of what is allowed, it is their direction that is wrong."""


@kernel
def excess(
    rows: Array, n: int, now: float, z: Array, raw: Array, var: Array,
    doubt: float, rate: float, bend: float, reach: float,
) -> float:  # fmt: skip
    """The largest disagreement of increments, over what is allowed.

    Parameters
    ----------
    rows : ndarray, shape (slots, 1 + 3 m)
        Earlier readings in order: time [s]; less what was felt; as they were said; variance of noise.
    n : int
        Rows in use.
    now : float
    z, raw, var : ndarray, shape (m,)
        The present reading.
    doubt : float
        Deviations that noise makes.
    rate, bend, reach : float
        As in `Slack`; how far back to look [s].

    Returns
    -------
    float
        Above 1 the channel did not move as was felt. Where it moved by as much, but in another direction,
        that is no contradiction: a receiver does not err so, a filter whose heading is wrong does.
    """
    m = z.size
    worst = 0.0
    for i in range(n):
        dt = now - rows[i, 0]
        if dt > reach:
            continue
        off = noise = said = felt = 0.0
        for j in range(min(m, 2)):
            d, e = z[j] - rows[i, 1 + j], raw[j] - rows[i, 1 + m + j]
            off, said, felt = off + d * d, said + e * e, felt + (e - d) ** 2
            noise = max(noise, var[j] + rows[i, 1 + 2 * m + j])
        far = rate * dt + 0.5 * bend * dt * dt
        allowed = doubt * np.sqrt(noise) + far
        off, said, felt = np.sqrt(off), np.sqrt(said), np.sqrt(felt)
        if m == 1 or abs(said - felt) > TURNED * allowed or felt < allowed:
            worst = max(worst, off / allowed)
        if m == 3:  # heights are worse than the plane, and say nothing of it
            off, noise = abs(z[2] - rows[i, 3]), var[2] + rows[i, 9]
            worst = max(worst, off / (doubt * np.sqrt(noise) + far))
    return worst


@kernel
def moved(
    rows: Array, n: int, now: float, z: Array, raw: Array, var: Array,
    doubt: float, rate: float, bend: float, since: float,
) -> bool:  # fmt: skip
    """Whether there was any motion to follow: a channel that stands still agrees with a car that does.

    Parameters
    ----------
    rows, n, now, z, raw, var, doubt, rate, bend
        As for `excess`.
    since : float
        Readings from then on [s].

    Returns
    -------
    bool
        Whether one that stood still would have been found out.
    """
    m = z.size
    for i in range(n):
        if rows[i, 0] < since:
            continue
        felt = noise = 0.0
        for j in range(min(m, 2)):
            felt += (raw[j] - rows[i, 1 + m + j] - z[j] + rows[i, 1 + j]) ** 2
            noise = max(noise, var[j] + rows[i, 1 + 2 * m + j])
        dt = now - rows[i, 0]
        if np.sqrt(felt) > doubt * np.sqrt(noise) + rate * dt + 0.5 * bend * dt * dt:
            return True
    return False


@dataclass
class Increments:
    """What a channel said lately, less what was felt.

    Parameters
    ----------
    size : int
        Components of a reading.
    n : int
        Readings that are kept.
    rows : ndarray, shape (slots, 1 + 3 size)
        As `excess` takes them; replaced, never changed.
    """

    size: int
    n: int = 0
    rows: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        if not self.rows.size:
            self.rows = np.zeros((SLOTS, 1 + 3 * self.size))

    @property
    def last(self) -> float:
        """When something was kept last [s]."""
        return float(self.rows[self.n - 1, 0]) if self.n else -np.inf

    def excess(
        self, time: float, value: Array, raw: Array, var: Array, slack: Slack, doubt: float = DOUBT
    ) -> float:
        """How far a reading is from having changed as was felt; see `excess`.

        Parameters
        ----------
        time : float
        value, raw, var : ndarray, shape (size,)
            z + c, what was said in the same unit, and the variance of its noise.
        slack : Slack
        doubt : float

        Returns
        -------
        float
        """
        return float(excess(self.rows, self.n, time, value, raw, var, doubt, slack.rate, slack.bend, REACH))

    def moved(self, time: float, value: Array, raw: Array, var: Array, slack: Slack, since: float) -> bool:
        """Whether the car moved between a reading since some time and this one; see `moved`."""
        return bool(moved(self.rows, self.n, time, value, raw, var, DOUBT, *slack, since))

    def change(self, time: float, value: Array, raw: Array, span: tuple[float, float]) -> Array | None:
        """How much was said and was felt since a reading of some seconds ago.

        Parameters
        ----------
        time : float
        value, raw : ndarray, shape (size,)
        span : tuple of 2 float
            Least and most seconds.

        Returns
        -------
        ndarray, shape (2, size), or None
            Change as said, and as felt.
        """
        ages = time - self.rows[: self.n, 0]
        fit = np.flatnonzero((ages >= span[0]) & (ages <= span[1]))
        if not len(fit):
            return None
        row, m = self.rows[fit[-1]], self.size
        said = raw - row[1 + m : 1 + 2 * m]
        return np.stack([said, said - (value - row[1 : 1 + m])])

    def keep(self, time: float, value: Array, raw: Array, var: Array) -> None:
        """Remember a reading.

        Parameters
        ----------
        time : float
        value, raw, var : ndarray, shape (size,)
        """
        if time - self.last < APART:
            return
        rows = self.rows.copy()
        if self.n == SLOTS:
            rows[:-1] = self.rows[1:]
            self.n -= 1
        rows[self.n] = np.concatenate([[time], value, raw, var])
        self.rows, self.n = rows, self.n + 1

    def forget(self) -> None:
        """Start anew."""
        self.n = 0

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.size, self.n, self.rows)
