"""What the IMU felt lately, and how that changes: with it a hole in the log is bridged, and doubted.

A hole is filled by a straight line from what was felt before it, the mean of the last tenth of a second
or two, to what the sample that closes it says: no later sample is used, so that rows can be written
when it arrives. One sample shakes; it moves the end of the line by D / (D + V), with D the mean square by
which means change over such a time and V the variance of a sample about the mean of its tenth.

How wrong such a line is, is learned by drawing it where nothing is missing: at the end of every tenth of a
second for holes of `SPANS`, each axis apart. What is kept is the mean square of what the integral misses,
over how much the two sides differ: a hole between sides that differ hides more.
"""

from __future__ import annotations

from typing import Final, NamedTuple, Self

import numpy as np

from gapless._numba import kernel
from gapless.trip.events import ImuBlock
from gapless.trip.recording import Array
from gapless.units import DEG

TENTH: Final = 0.1
"""Over which means are taken [s]."""
SPANS: Final = (2, 5, 10, 20, 25)
"""Holes that are tried, in tenths of a second."""
KEPT: Final = SPANS[-1] + 2
"""Means that are kept."""
MEMORY: Final = 1200.0
"""Tenths over which a mean square forgets: two minutes."""
BUDGET: Final = np.array([0.8 * DEG, 0.8 * DEG, 2.0 * DEG, 0.4, 0.4, 0.25])
"""What a line over one second misses before anything was learned: angles [rad], velocities [m/s]; in
proportion to the time to the power of 1.5."""
PRIOR: Final = 50.0
"""For how many tenths that counts."""
LEAST: Final = 0.1
"""Never less than this share of it: after minutes at rest a car may drive off in a hole."""
TURN: Final = (2.0 * DEG, 15.0 * DEG)
"""Least and largest rate of turning that a longer hole is suspected of [rad/s]."""

_TIME, _COUNT, _SUM, _SQUARE, _FIRST, _PART = 0, 1, 2, 8, 14, 20
_MEAN, _TOTAL, _SAMPLE, _CLOCK, _WIDTH = 0, 6, 12, 18, 19
_CHANGE, _MISS, _SCATTER, _TURN = 0, len(SPANS), 2 * len(SPANS), 2 * len(SPANS) + 1


class Filling(NamedTuple):
    """A hole bridged.

    Parameters
    ----------
    block : ImuBlock
        Samples in it.
    doubt : ndarray, shape (4,)
        Variances a second of what they say: of the angle about the down axis of b [rad^2/s], of the
        velocity in b [m^2/s^3].
    tilt : ndarray, shape (2,)
        Variances of roll and pitch at the end [rad^2]. What tilts a car shows in the forces too, whose
        doubt holds it; through the way there it would count twice.
    """

    block: ImuBlock
    doubt: Array
    tilt: Array


class Lately:
    """The last seconds of an IMU as means over tenths of a second, and how well lines bridged them.

    Attributes
    ----------
    turning : float
        Root mean square of the rate about the vertical axis of the box, within `TURN` [rad/s].
    """

    __slots__ = ("_counts", "_learned", "_part", "_ring")

    def __init__(self) -> None:
        self._part = np.zeros(_PART)
        self._ring = np.zeros((KEPT, _WIDTH))
        self._counts = np.zeros(2)
        self._learned = np.zeros((_TURN + 1, 6))
        seconds = TENTH * np.array(SPANS)[:, None]
        self._learned[_MISS:_SCATTER] = np.square(BUDGET * seconds**1.5)
        self._learned[_CHANGE:_MISS] = 12.0 * self._learned[_MISS:_SCATTER] / seconds**2
        self._learned[_TURN] = TURN[1] ** 2

    @property
    def turning(self) -> float:
        """See the class."""
        return float(np.clip(np.sqrt(self._learned[_TURN, 2]), *TURN))

    def feel(self, block: ImuBlock) -> None:
        """Take in samples that follow the last ones.

        Parameters
        ----------
        block : ImuBlock
            Without holes.
        """
        _feel(*block[1:], self._part, self._ring, self._counts, self._learned, _BUDGETS)

    def across(self, begin: float, sample: ImuBlock) -> Filling:
        """Bridge a hole; what was felt before it is then forgotten, but what was learned is not.

        Parameters
        ----------
        begin : float
            Where it begins [s].
        sample : ImuBlock
            The one sample that closes it.

        Returns
        -------
        Filling
            At about the rate that the sample's interval names.
        """
        usual, end = float(sample.dt[0]), float(sample.time[0] - sample.dt[0])
        silent = end - begin
        n = max(1, round(silent / usual))
        closes = np.hstack([sample.dtheta[0], sample.dvel[0]]) / usual
        before = self._before(closes)
        change = self._between(_CHANGE, silent + TENTH)
        share = change / (change + self._learned[_SCATTER] + 1e-30)
        step = share * (closes - before)
        local = 0.5 * (1.0 + share * (1.0 - share) + step**2 / change)
        missed = self._between(_MISS, silent) * local
        felt = (before + step * ((np.arange(n) + 0.5) / n)[:, None]) * (silent / n)
        time = begin + silent * np.arange(1, n + 1) / n
        time[-1] = end
        block = ImuBlock(time, np.full(n, silent / n), felt[:, :3].copy(), felt[:, 3:].copy())
        self.forget()
        return Filling(block, missed[2:] / silent, missed[:2])

    def forget(self) -> None:
        """What was felt does not lead up to what follows."""
        self._part[:] = 0.0
        self._counts[0] = 0.0

    def _before(self, otherwise: Array) -> Array:
        """Mean rate and force of the tenth that is not over, and of the one before; raw."""
        time, total = self._part[_TIME], self._part[_SUM:_SQUARE].copy()
        if self._counts[0] > 0.0:
            time += TENTH
            total += TENTH * self._ring[int(self._counts[0] - 1.0) % KEPT, _MEAN:_TOTAL]
        return total / time if time > 0.0 else otherwise

    def _between(self, row: int, seconds: float) -> Array:
        """Mean square of a hole's length, from those of `SPANS`: roots lie on lines through zero."""
        at = np.concatenate([[0.0], TENTH * np.array(SPANS)])
        roots = np.sqrt(self._learned[row : row + len(SPANS)].T)
        return np.array([np.interp(seconds, at, [0.0, *root]) ** 2 for root in roots])

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Lately
        """
        new = object.__new__(type(self))
        new._part, new._ring = self._part.copy(), self._ring.copy()
        new._counts, new._learned = self._counts.copy(), self._learned.copy()
        return new


_BUDGETS: Final = np.square(LEAST * BUDGET * (TENTH * np.array(SPANS)[:, None]) ** 1.5)


@kernel
def _feel(
    dt: Array,
    dtheta: Array,
    dvel: Array,
    part: Array,
    ring: Array,
    counts: Array,
    learned: Array,
    least: Array,
) -> None:
    """Samples into tenths; what a tenth that is full tells is learned. `least`: of the misses."""
    for k in range(dt.size):
        for i in range(6):
            rise = dtheta[k, i] if i < 3 else dvel[k, i - 3]
            if part[_COUNT] == 0.0:
                part[_FIRST + i] = rise / dt[k]
            part[_SUM + i] += rise
            part[_SQUARE + i] += (rise / dt[k] - part[_FIRST + i]) ** 2
        part[_TIME] += dt[k]
        part[_COUNT] += 1.0
        if part[_TIME] >= TENTH - 1e-7:
            _close(part, ring, counts)
            _learn(part, ring, counts, learned, least)
            part[:] = 0.0


@kernel
def _close(part: Array, ring: Array, counts: Array) -> None:
    """A full tenth into the ring."""
    n = int(counts[0])
    last, row = ring[(n - 1) % KEPT], ring[n % KEPT]
    for i in range(6):
        row[_MEAN + i] = part[_SUM + i] / part[_TIME]
        row[_TOTAL + i] = part[_SUM + i] + (last[_TOTAL + i] if n > 0 else 0.0)
        row[_SAMPLE + i] = part[_FIRST + i]
    row[_CLOCK] = part[_TIME] + (last[_CLOCK] if n > 0 else 0.0)
    counts[0] += 1.0
    counts[1] += 1.0


@kernel
def _learn(part: Array, ring: Array, counts: Array, learned: Array, least: Array) -> None:
    """What lines over the tenths before the last would have missed, and how much they had to span."""
    n, weight = int(counts[0]) - 1, 1.0 / min(counts[1] + PRIOR, MEMORY)
    now, samples = ring[n % KEPT], part[_COUNT]
    for i in range(6):
        if samples > 1.0:
            off = now[_MEAN + i] - part[_FIRST + i]
            scatter = (part[_SQUARE + i] - samples * off * off) / (samples - 1.0)
            # no prior for it: the first is taken as it is
            share = 1.0 / min(counts[1], MEMORY)
            learned[_SCATTER, i] += share * (max(scatter, 0.0) - learned[_SCATTER, i])
        learned[_TURN, i] += weight * (now[_MEAN + i] ** 2 - learned[_TURN, i])
    for j in range(len(SPANS)):
        if SPANS[j] + 1 > n:
            continue
        before, last = ring[(n - SPANS[j] - 1) % KEPT], ring[(n - 1) % KEPT]
        seconds = last[_CLOCK] - before[_CLOCK]
        for i in range(6):
            change = learned[_CHANGE + j, i]
            share = change / (change + learned[_SCATTER, i] + 1e-30)
            step = share * (now[_SAMPLE + i] - before[_MEAN + i])
            missed = last[_TOTAL + i] - before[_TOTAL + i] - seconds * (before[_MEAN + i] + 0.5 * step)
            local = 0.5 * (1.0 + share * (1.0 - share) + step * step / (change + 1e-30))
            found = learned[_MISS + j, i] + weight * (missed * missed / local - learned[_MISS + j, i])
            learned[_MISS + j, i] = max(found, least[j, i])
            apart = now[_MEAN + i] - before[_MEAN + i]
            learned[_CHANGE + j, i] = change + weight * (apart * apart - change)
