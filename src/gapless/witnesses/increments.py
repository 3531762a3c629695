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

SLOTS: Final = 16
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


@kernel
def excess(
    times: Array, values: Array, variances: Array, n: int, now: float, z: Array, var: Array,
    doubt: float, rate: float, bend: float, reach: float,
) -> float:  # fmt: skip
    """The largest disagreement of increments, over what is allowed.

    Parameters
    ----------
    times : ndarray, shape (slots,)
        Of the earlier readings, in order [s].
    values, variances : ndarray, shape (slots, m)
    n : int
        Slots in use.
    now : float
    z, var : ndarray, shape (m,)
        The present reading.
    doubt : float
        Deviations that noise makes.
    rate, bend, reach : float
        As in `Slack`; how far back to look [s].

    Returns
    -------
    float
        Above 1 the channel did not move as was felt.
    """
    worst = 0.0
    for i in range(n):
        dt = now - times[i]
        if dt > reach:
            continue
        far = rate * dt + 0.5 * bend * dt * dt
        off = noise = 0.0
        for j in range(min(z.size, 2)):
            off += (z[j] - values[i, j]) ** 2
            noise = max(noise, var[j] + variances[i, j])
        worst = max(worst, np.sqrt(off) / (doubt * np.sqrt(noise) + far))
        if z.size == 3:  # heights are worse than the plane, and say nothing of it
            off, noise = abs(z[2] - values[i, 2]), var[2] + variances[i, 2]
            worst = max(worst, off / (doubt * np.sqrt(noise) + far))
    return worst


@dataclass
class Increments:
    """What a channel said lately, less what was felt.

    Parameters
    ----------
    size : int
        Components that are looked at together.
    """

    size: int
    n: int = 0
    times: Array = field(default_factory=lambda: np.zeros(SLOTS))
    values: Array = field(default_factory=lambda: np.zeros((SLOTS, 0)))
    variances: Array = field(default_factory=lambda: np.zeros((SLOTS, 0)))

    def __post_init__(self) -> None:
        if self.values.shape[1] != self.size:
            self.values, self.variances = np.zeros((2, SLOTS, self.size))

    @property
    def last(self) -> float:
        """When something was kept last [s]."""
        return float(self.times[self.n - 1]) if self.n else -np.inf

    def excess(self, time: float, value: Array, var: Array, slack: Slack, doubt: float = DOUBT) -> float:
        """How far a reading is from having changed as was felt; see `excess`.

        Parameters
        ----------
        time : float
        value, var : ndarray, shape (size,)
            z + c and the variance of its noise.
        slack : Slack
        doubt : float

        Returns
        -------
        float
        """
        return float(
            excess(
                self.times, self.values, self.variances, self.n, time, value, var, doubt, slack.rate,
                slack.bend, REACH,
            )
        )  # fmt: skip

    def keep(self, time: float, value: Array, var: Array) -> None:
        """Remember a reading.

        Parameters
        ----------
        time : float
        value, var : ndarray, shape (size,)
        """
        if time - self.last < APART:
            return
        if self.n == SLOTS or (self.n and time - self.times[0] > 2.0 * REACH):
            self.times[:-1], self.values[:-1] = self.times[1:], self.values[1:]
            self.variances[:-1] = self.variances[1:]
            self.n -= 1
        self.times[self.n], self.values[self.n], self.variances[self.n] = time, value, var
        self.n += 1

    def forget(self) -> None:
        """Start anew."""
        self.n = 0

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.size, self.n, self.times.copy(), self.values.copy(), self.variances.copy())
