"""Covariances of a position that are stated beside the filter's own."""

from __future__ import annotations

from gapless._numba import kernel
from gapless.trip.recording import Array

HOLDS = 4.0
"""A 95 % ellipse (5.99) holds what is off by the root of its variance times this, with some room."""


@kernel
def add(total: Array, response: Array, c: Array, arm: Array, off: Array) -> None:
    """Add what fixes share, what an arm in doubt does, and a place that moved.

    Parameters
    ----------
    total : ndarray, shape (3, 3)
        Changed in place.
    response : ndarray, shape (3, 3)
        As of `Wander`.
    c : ndarray, shape (3, 3)
        C_nb.
    arm : ndarray, shape (3, 3)
        Covariance of the arm in the box [m^2].
    off : ndarray, shape (3,)
        Of fixes that moved away and stay there: nobody knows yet which place is right [m].
    """
    for i in range(3):
        for j in range(3):
            total[i, j] += response[i, j] + off[i] * off[j] / HOLDS
            for k in range(3):
                for m in range(3):
                    total[i, j] += c[i, k] * arm[k, m] * c[j, m]
