"""Speeds at which combs are kept apart."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.trip.recording import Array

KNOTS: Final = (5.0, 10.0, 18.0)
"""Sums are kept apart by speed, each spectrum shared by the two knots around its own [m/s]."""


def shares(speeds: Array) -> Array:
    """How speeds are shared by the knots: linear between two, the outermost alone beyond the ends.

    Parameters
    ----------
    speeds : ndarray, shape (k,)
        [m/s]

    Returns
    -------
    ndarray, shape (k, knots)
        Sums to one.
    """
    return np.array([np.interp(speeds, KNOTS, one) for one in np.eye(len(KNOTS))]).T
