"""Cubature points of a covariance, and what a function makes of them.

The third-degree rule of Arasaratnam and Haykin (2009): 2n points at +-sqrt(n) times the columns of a
Cholesky factor L of P, of equal weight. Of each pair only half the difference and the middle matter: the
differences give the statistically linearised matrix cov(y, x) P^-1 and its part of cov(y), the middles give
the mean and what is not linear.
"""

from __future__ import annotations

import numpy as np

from gapless._numba import kernel
from gapless.trip.recording import Array

NOTHING = 1e-13
"""A pivot smaller than this share of its variance is rounding: the state depends on those before."""


@kernel
def factor(p: Array, row: int, n: int) -> Array:
    """Lower Cholesky factor of a covariance that may be singular.

    Parameters
    ----------
    p : ndarray, shape (row * row,)
    row, n : int
        Stored row length; states in use.

    Returns
    -------
    ndarray, shape (n, n)
        With columns of zeros where nothing new is uncertain.
    """
    low = np.zeros((n, n))
    for j in range(n):
        a = p[j * row + j]
        for k in range(j):
            a -= low[j, k] * low[j, k]
        if a > NOTHING * p[j * row + j]:
            pivot = np.sqrt(a)
            low[j, j] = pivot
            for i in range(j + 1, n):
                b = p[i * row + j]
                for k in range(j):
                    b -= low[i, k] * low[j, k]
                low[i, j] = b / pivot
    return low


@kernel
def linearised(half: Array, low: Array) -> Array:
    """Statistical linear regression of a function on its points (Särkkä 2013, sec. 6).

    Parameters
    ----------
    half : ndarray, shape (n, m)
        Half the difference of the function's values at each pair of points.
    low : ndarray, shape (n, n)
        L of P = L L'.

    Returns
    -------
    ndarray, shape (m, n)
        cov(y, x) P^-1 = half' L^-1 / sqrt(n); zero for what is not uncertain.
    """
    n, m = half.shape
    found, share = np.zeros((n, m)), 1.0 / np.sqrt(n)
    for back in range(n):
        j = n - 1 - back
        if low[j, j] > 0.0:
            row = found[j]
            for r in range(m):
                row[r] = half[j, r] * share
            for i in range(j + 1, n):
                a = low[i, j]
                for r in range(m):
                    row[r] -= a * found[i, r]
            a = 1.0 / low[j, j]
            for r in range(m):
                row[r] *= a
    return found.T.copy()


@kernel
def scatter(middle: Array) -> tuple[Array, Array]:
    """Mean of the pairs' middles, and their covariance: the share of cov(y) that is not linear.

    Parameters
    ----------
    middle : ndarray, shape (n, m)

    Returns
    -------
    mean : ndarray, shape (m,)
    extra : ndarray, shape (m, m)
    """
    n, m = middle.shape
    mean, off, extra, share = np.zeros(m), np.empty(m), np.zeros((m, m)), 1.0 / n
    for i in range(n):
        for r in range(m):
            mean[r] += share * middle[i, r]
    for i in range(n):
        for r in range(m):
            off[r] = middle[i, r] - mean[r]
        for r in range(m):
            a = share * off[r]
            for c in range(m):
                extra[r, c] += a * off[c]
    return mean, extra
