"""The template of a car, and how well a spectrum fits it at a speed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from gapless._numba import kernel
from gapless.bridges.orders import CHANNELS, LOWEST, ORDERS, STEP, WIDTH, Spectrum
from gapless.trip.recording import Array

BEYOND: Final = 1.5
"""What is so many deviations off the comb and off none is no more news: another line lies there, or a gap."""


@dataclass(frozen=True, eq=False)
class Comb:
    """The template of a car.

    Parameters
    ----------
    height : ndarray, shape (6, orders)
        Log power of the comb above what is around it, shrunk by its standard error.
    error : ndarray, shape (6, orders)
        That standard error.
    variance : ndarray, shape (6,)
        Of a single spectrum's log power, by channel.
    mean : ndarray, shape (6, BINS)
        Mean spectrum over frequency: what stays where it is when the speed changes.
    levels : ndarray, shape (knots, 3)
        How loud driving is; see `loudness`.
    """

    height: Array
    error: Array
    variance: Array
    mean: Array
    levels: Array

    @cached_property
    def weight(self) -> Array:
        """T / s^2, shape (orders, 6)."""
        return np.ascontiguousarray((self.height / self.variance[:, None]).T)

    @cached_property
    def cost(self) -> Array:
        """Sum over channels of T^2 / (2 s^2), shape (orders,)."""
        return np.asarray(0.5 * (self.weight * self.height.T).sum(axis=1))

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Least and most that a spectrum's log power counts with, shape (orders, 6) each."""
        height, far = np.ascontiguousarray(self.height.T), BEYOND * np.sqrt(self.variance)
        return np.minimum(height, 0.0) - far, np.maximum(height, 0.0) + far

    def evidence(self, heard: Spectrum, speeds: Array) -> Array:
        """Log likelihood of speeds against that of no comb, as the kernel below has it.

        Parameters
        ----------
        heard : Spectrum
        speeds : ndarray, shape (k,)
            [m/s]

        Returns
        -------
        ndarray, shape (k,)
        """
        left = np.ascontiguousarray((heard.log - self.mean).T)
        return evidence(left, heard.top, self.weight, self.cost, *self.bounds, speeds)


@kernel
def evidence(
    log: Array, top: float, weight: Array, cost: Array, least: Array, most: Array, speeds: Array
) -> Array:
    """Log likelihood of speeds against that of no comb at all.

    Sum over channels and orders of (y T - T^2 / 2) / s^2: y ~ N(T, s^2) against N(0, s^2), as far as y is
    likely enough of either.

    Parameters
    ----------
    log : ndarray, shape (BINS, 6)
        A whitened spectrum less the mean one.
    top : float
        As in `Spectrum`.
    weight : ndarray, shape (orders, 6)
        T / s^2 of the template.
    cost : ndarray, shape (orders,)
        Sum over channels of T^2 / (2 s^2).
    least, most : ndarray, shape (orders, 6)
        Between these y is what it is; beyond, it is they.
    speeds : ndarray, shape (k,)
        [m/s]

    Returns
    -------
    ndarray, shape (k,)
        Neighbouring orders are taken for independent, which they are not: to be tempered.
    """
    found = np.zeros(speeds.size)
    for i in range(speeds.size):
        total = 0.0
        for j in range(ORDERS):
            if cost[j] == 0.0:
                continue
            f = (LOWEST + STEP * j) * speeds[i] / WIDTH
            if f * WIDTH >= top:
                break
            k = int(f)
            w = f - k
            for c in range(CHANNELS):
                y = log[k, c] + w * (log[k + 1, c] - log[k, c])
                total += min(max(y, least[j, c]), most[j, c]) * weight[j, c]
            total -= cost[j]
        found[i] = total
    return found
