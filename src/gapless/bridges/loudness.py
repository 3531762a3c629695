"""How loud driving is: a window far quieter than this car's driving is one of a car that stands.

A car that stands shakes too, with its engine, its fan or its noise; what its spectrum has of a comb is
chance, but it is not nothing. That it is quiet tells it from a driving car's as no spectrum does.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.bridges.knots import KNOTS, shares
from gapless.trip.recording import Array

FEW: Final = 3.0
"""Spectra as loud as the window in question that those heard are mixed with: it begins at no news."""
SPREAD: Final = 0.5
"""Standard deviation of theirs: a smooth road against a rough one."""
ALLOWED: Final = 1.0
"""Quieter by so many deviations is no news: slow driving is quieter than what was learned from."""

SILENT: Final = np.zeros((len(KNOTS), 3))
"""Sums over no spectra: how many, of their loudness, of its square, by speed."""


def louder(sums: Array, keep: float, level: float, share: Array) -> Array:
    """The sums with one more spectrum.

    Parameters
    ----------
    sums : ndarray, shape (knots, 3)
        As `SILENT`.
    keep : float
        What is left of each spectrum before.
    level : float
        Loudness of the new one.
    share : ndarray, shape (knots,)
        How its speed is shared by the knots.

    Returns
    -------
    ndarray, shape (knots, 3)
    """
    return np.asarray(sums * keep + np.outer(share, (1.0, level, level * level)))


def too_quiet(sums: Array, level: float, speeds: Array) -> Array:
    """Log likelihood that a window so quiet loses against a stop's if the car drives.

    Loudness at a speed is normal with the mean and the variance of what was learned there, but louder
    than that, or little quieter, is as likely as the mean: one-sided.

    Parameters
    ----------
    sums : ndarray, shape (knots, 3)
    level : float
    speeds : ndarray, shape (k,)
        [m/s]

    Returns
    -------
    ndarray, shape (k,)
        Zero or less.
    """
    n, first, second = (shares(speeds) @ sums).T
    quieter = (first - n * level) / (n + FEW)
    spread = np.maximum(second - first**2 / np.maximum(n, 1e-9), 0.0)
    sd = np.sqrt((spread + FEW * SPREAD**2) / (n + FEW))
    return np.asarray(-0.5 * np.maximum(quieter / sd - ALLOWED, 0.0) ** 2)
