"""What a car's spectra have in common over orders: gathered with forgetting, and the comb that is left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gapless._numba import kernel
from gapless.bridges.knots import KNOTS, shares
from gapless.bridges.loudness import SILENT, louder
from gapless.bridges.orders import BINS, CHANNELS, LOWEST, ORDERS, STEP, WIDTH, Spectrum, gather
from gapless.bridges.template import Comb
from gapless.trip.recording import Array

FORGET: Final = 300.0
"""Spectra after which one counts a third."""
DOUBT: Final = 3.0
"""Spectra without a comb that a template is mixed with: it begins at none."""
TREND: Final = 15
"""Half width of the moving mean over orders, taken twice, that is no comb [steps]."""
SMOOTH: Final = 2
"""Half width of the moving mean over the bins of the mean spectrum."""
SPEED_BIN, SPEED_BINS = 0.5, 140
"""Speeds are counted in so many bins of this width [m/s]."""
_BINS: Final = shares(np.asarray(SPEED_BIN * (np.arange(SPEED_BINS) + 0.5), float))
"""How the bins of speed are shared by the knots."""


@dataclass
class Memory:
    """Sums over spectra; arrays are replaced, never changed, so that copies may share them.

    Parameters
    ----------
    top : float
        Of the spectra [Hz].
    total, count, square : ndarray, shape (knots, 6, orders), (knots, orders), (6,)
        Sums over orders of log power and of spectra, by speed; of squares.
    mean : ndarray, shape (6, BINS)
        Sum over spectra by frequency.
    speeds : ndarray, shape (SPEED_BINS,)
        Spectra by speed.
    levels : ndarray, shape (knots, 3)
        Sums of how loud they were; see `loudness`.
    windows : float
    """

    top: float
    total: Array
    count: Array
    square: Array
    mean: Array
    speeds: Array
    levels: Array
    windows: float = 0.0

    @classmethod
    def empty(cls, top: float) -> Memory:
        """Nothing heard yet.

        Parameters
        ----------
        top : float

        Returns
        -------
        Memory
        """
        shape, by_speed = (CHANNELS, ORDERS), len(KNOTS)
        return cls(
            top,
            np.zeros((by_speed, *shape)),
            np.zeros((by_speed, ORDERS)),
            np.zeros(CHANNELS),
            np.zeros((CHANNELS, BINS)),
            np.zeros(SPEED_BINS),
            SILENT,
        )

    def after(self, heard: Spectrum) -> Memory:
        """The memory with one more spectrum.

        Parameters
        ----------
        heard : Spectrum

        Returns
        -------
        Memory
        """
        keep = np.exp(-1.0 / FORGET)
        new, seen, square = np.zeros((CHANNELS, ORDERS)), np.zeros(ORDERS), self.square * keep
        gather(heard.log, heard.top, heard.speed, new, seen, square)
        share = shares(np.array([heard.speed]))[0]
        total = self.total * keep + share[:, None, None] * new
        count = self.count * keep + share[:, None] * seen
        speeds = self.speeds * keep
        speeds[min(SPEED_BINS - 1, int(heard.speed / SPEED_BIN))] += 1.0
        mean, windows = self.mean * keep + heard.log, self.windows * keep + 1.0
        levels = louder(self.levels, keep, heard.level, share)
        return Memory(heard.top, total, count, square, mean, speeds, levels, windows)

    def comb(self) -> Comb:
        """What is left over orders when the mean spectrum and the trend are taken away, at all speeds.

        Returns
        -------
        Comb
        """
        left = self.left()
        return left.comb(*left.common())

    def left(self) -> Left:
        """The sums less what the mean spectrum alone would have put there.

        Returns
        -------
        Left
        """
        mean = moving_mean(self.mean / max(self.windows, 1.0), SMOOTH)
        driven = _BINS.T * self.speeds
        fixed = np.array([unmoved(mean, self.top, speeds) for speeds in driven])
        count = self.count.sum(axis=0)
        spread = self.square - (fixed.sum(axis=0) ** 2 / np.maximum(count, 1.0)).sum(axis=1)
        variance = np.maximum(spread / max(count.sum(), 1.0), 0.05)
        return Left(self.total - fixed, self.count, variance, mean, self.levels)


@dataclass(frozen=True, eq=False)
class Left:
    """Sums over orders without what does not move with the speed.

    Parameters
    ----------
    total : ndarray, shape (knots, 6, orders)
    count : ndarray, shape (knots, orders)
    variance : ndarray, shape (6,)
        Of a single spectrum's log power.
    mean : ndarray, shape (6, BINS)
        The mean spectrum.
    levels : ndarray, shape (knots, 3)
        How loud they were.
    """

    total: Array
    count: Array
    variance: Array
    mean: Array
    levels: Array

    def common(self) -> tuple[Array, Array]:
        """Spectra that count, `DOUBT` among them, and the mean over all speeds without its trend.

        Returns
        -------
        count : ndarray, shape (orders,)
        raw : ndarray, shape (6, orders)
        """
        count = self.count.sum(axis=0) + DOUBT
        return count, without_trend(self.total.sum(axis=0) / count)

    def comb(self, count: Array, raw: Array) -> Comb:
        """The comb at all speeds.

        Parameters
        ----------
        count, raw : ndarray
            From `common`.

        Returns
        -------
        Comb
        """
        doubt = self.variance[:, None] / count
        return Comb(shrunk(raw, doubt), np.sqrt(doubt), self.variance, self.mean, self.levels)


def shrunk(raw: Array, doubt: Array) -> Array:
    """What could be chance becomes zero.

    Parameters
    ----------
    raw : ndarray
    doubt : ndarray
        Its squared standard error.

    Returns
    -------
    ndarray
    """
    return np.asarray(raw * np.maximum(0.0, 1.0 - doubt / np.maximum(raw**2, 1e-12)))


def without_trend(rows: Array) -> Array:
    """Less the moving mean over `TREND` orders either way, taken twice.

    Parameters
    ----------
    rows : ndarray, shape (m, n)

    Returns
    -------
    ndarray, shape (m, n)
    """
    return np.asarray(rows - moving_mean(moving_mean(rows, TREND), TREND))


@kernel
def unmoved(mean: Array, top: float, speeds: Array) -> Array:
    """What the mean spectrum alone would have put into the sums over orders.

    Parameters
    ----------
    mean : ndarray, shape (6, BINS)
    top : float
        [Hz]
    speeds : ndarray, shape (SPEED_BINS,)
        Spectra by speed.

    Returns
    -------
    ndarray, shape (6, orders)
    """
    out = np.zeros((CHANNELS, ORDERS))
    for b in range(SPEED_BINS):
        if speeds[b] > 1e-9:
            for j in range(ORDERS):
                f = (LOWEST + STEP * j) * (b + 0.5) * SPEED_BIN / WIDTH
                if f * WIDTH >= top:
                    break
                k = int(f)
                w = f - k
                for c in range(CHANNELS):
                    out[c, j] += speeds[b] * ((1.0 - w) * mean[c, k] + w * mean[c, k + 1])
    return out


def moving_mean(rows: Array, half: int) -> Array:
    """Mean over 2 half + 1 columns, the outermost repeated beyond the ends.

    Parameters
    ----------
    rows : ndarray, shape (m, n)
    half : int

    Returns
    -------
    ndarray, shape (m, n)
    """
    wide = np.pad(rows, ((0, 0), (half + 1, half)), mode="edge")
    total = wide.cumsum(axis=1)
    return np.asarray((total[:, 2 * half + 1 :] - total[:, : -2 * half - 1]) / (2 * half + 1))
