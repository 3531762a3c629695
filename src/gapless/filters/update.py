"""The measurement update of an error-state filter: innovation statistics, gain, Joseph form.

`z ~ H dx + v`, v ~ N(0, R). Covariances are stored flat with rows of fixed length (`row`), as the
propagation kernel wants them; the first n rows and columns count.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gapless._numba import inline, kernel
from gapless.trip.recording import Array


@inline
def cholesky(s: Array) -> Array:
    """Lower factor of a small symmetric positive definite matrix.

    Parameters
    ----------
    s : ndarray, shape (m, m)

    Returns
    -------
    ndarray, shape (m, m)
        NaN where `s` is not positive definite.
    """
    m = s.shape[0]
    low = np.zeros((m, m))
    for i in range(m):
        for j in range(i + 1):
            a = s[i, j]
            for k in range(j):
                a -= low[i, k] * low[j, k]
            low[i, j] = np.sqrt(a) if i == j else a / low[j, j]
    return low


@inline
def solve(low: Array, b: Any) -> None:
    """B = S^-1 b in place.

    Parameters
    ----------
    low : ndarray, shape (m, m)
        L of S = L L'.
    b : ndarray, shape (m,)
    """
    m = low.shape[0]
    for i in range(m):
        a = b[i]
        for k in range(i):
            a -= low[i, k] * b[k]
        b[i] = a / low[i, i]
    for r in range(m):
        i = m - 1 - r
        a = b[i]
        for k in range(i + 1, m):
            a -= low[k, i] * b[k]
        b[i] = a / low[i, i]


@kernel
def assess(p: Array, row: int, n: int, z: Array, h: Array, r: Array) -> tuple[float, Array, Array]:
    """How surprising an observation is.

    Parameters
    ----------
    p : ndarray, shape (row * row,)
        Covariance.
    row, n : int
        Stored row length; states in use.
    z : ndarray, shape (m,)
        Innovation.
    h : ndarray, shape (m, n)
    r : ndarray, shape (m, m)

    Returns
    -------
    nis : float
        z' S^-1 z.
    s : ndarray, shape (m, m)
        S = H P H' + R.
    hp : ndarray, shape (m, n)
        H P.
    """
    m = h.shape[0]
    hp, s = np.zeros((m, n)), r.copy()
    for q in range(m):
        for c in range(n):
            a = h[q, c]
            if a != 0.0:
                for j in range(n):
                    hp[q, j] += a * p[c * row + j]
    for q in range(m):
        for c in range(n):
            a = h[q, c]
            if a != 0.0:
                for i in range(m):
                    s[i, q] += hp[i, c] * a
    y = z.copy()
    solve(cholesky(s), y)
    nis = 0.0
    for i in range(m):
        nis += z[i] * y[i]
    return nis, s, hp


@kernel
def correct(
    p: Array, row: int, n: int, z: Array, h: Array, r: Array, s: Array, hp: Array, gain: float
) -> Array:
    """Estimate of the error from one observation, and P after it.

    Parameters
    ----------
    p : ndarray, shape (row * row,)
        Covariance, replaced in place by the Joseph form (I - K H) P (I - K H)' + K R K', which
        holds for any gain.
    row, n : int
        Stored row length; states in use.
    z : ndarray, shape (m,)
    h : ndarray, shape (m, n)
    r : ndarray, shape (m, m)
        As it counts, after any adaptation.
    s : ndarray, shape (m, m)
        H P H' + that R.
    hp : ndarray, shape (m, n)
        H P.
    gain : float
        Factor on the optimal gain (1, but for fading filters).

    Returns
    -------
    ndarray, shape (n,)
        dx = K z.
    """
    m = h.shape[0]
    low, k, dx = cholesky(s), hp.copy(), np.zeros(n)
    for j in range(n):
        solve(low, k[:, j])
        for q in range(m):
            k[q, j] *= gain
            dx[j] += k[q, j] * z[q]
    for i in range(n):
        for q in range(m):
            a = k[q, i]
            for j in range(n):
                p[i * row + j] -= a * hp[q, j]
    # p is (I - K H) P now; the rest of the Joseph form is - (p H' - K R) K'
    for i in range(n):
        for q in range(m):
            a = 0.0
            for c in range(n):
                a += p[i * row + c] * h[q, c]
            for c in range(m):
                a -= k[c, i] * r[c, q]
            hp[q, i] = a
    for i in range(n):
        for q in range(m):
            a = hp[q, i]
            for j in range(n):
                p[i * row + j] -= a * k[q, j]
    for i in range(n):
        for j in range(i):
            a = 0.5 * (p[i * row + j] + p[j * row + i])
            p[i * row + j] = a
            p[j * row + i] = a
    return dx
