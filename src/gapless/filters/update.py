"""The measurement update of an error-state filter: innovation statistics, gain, Joseph form.

`z ~ H dx + v`, v ~ N(0, R). Covariances are stored flat with rows of fixed length (`row`), as the
propagation kernel wants them; the first n rows and columns count.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gapless._numba import inline, kernel
from gapless.recording import Array


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
def _predicted(p: Array, row: int, n: int, h: Array, r: Array) -> tuple[Array, Array]:
    """P H' and S = H P H' + R."""
    m = h.shape[0]
    pht = np.zeros((n, m))
    for i in range(n):
        for k in range(n):
            a = p[i * row + k]
            for j in range(m):
                pht[i, j] += a * h[j, k]
    s = r.copy()
    for i in range(m):
        for k in range(n):
            a = h[i, k]
            if a != 0.0:
                for j in range(m):
                    s[i, j] += a * pht[k, j]
    return pht, s


@kernel
def assess(p: Array, row: int, n: int, z: Array, h: Array, r: Array) -> tuple[float, Array]:
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
    """
    _, s = _predicted(p, row, n, h, r)
    low = cholesky(s)
    nis = 0.0
    y = np.empty_like(z)
    for i in range(z.size):
        a = z[i]
        for k in range(i):
            a -= low[i, k] * y[k]
        y[i] = a / low[i, i]
        nis += y[i] * y[i]
    return nis, s


@kernel
def correct(p: Array, row: int, n: int, z: Array, h: Array, r: Array, gain: float) -> Array:
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
    gain : float
        Factor on the optimal gain (1, but for fading filters).

    Returns
    -------
    ndarray, shape (n,)
        dx = K z.
    """
    m = h.shape[0]
    pht, s = _predicted(p, row, n, h, r)
    low = cholesky(s)
    k = np.empty((n, m))
    for i in range(n):
        for j in range(m):
            a = pht[i, j]
            for q in range(j):
                a -= k[i, q] * low[j, q]
            k[i, j] = a / low[j, j]
        for jj in range(m):
            j = m - 1 - jj
            a = k[i, j]
            for q in range(j + 1, m):
                a -= k[i, q] * low[q, j]
            k[i, j] = a / low[j, j]
    dx = np.zeros(n)
    for i in range(n):
        for j in range(m):
            k[i, j] *= gain
            dx[i] += k[i, j] * z[j]
    _joseph(p, row, n, h, r, k, pht)
    return dx


@inline
def _joseph(p: Any, row: Any, n: Any, h: Any, r: Any, k: Any, pht: Any) -> None:
    """P = (I - K H) P (I - K H)' + K R K', as T = P - K (H P), then T - (T H') K' + K R K'."""
    m = h.shape[0]
    for i in range(n):
        for j in range(n):
            for q in range(m):
                p[i * row + j] -= k[i, q] * pht[j, q]
    tht = np.zeros((n, m))
    for i in range(n):
        for c in range(n):
            a = p[i * row + c]
            for q in range(m):
                tht[i, q] += a * h[q, c]
        for q in range(m):
            for c in range(m):
                tht[i, q] -= k[i, c] * r[c, q]
    for i in range(n):
        for j in range(i + 1):
            a = 0.5 * (p[i * row + j] + p[j * row + i])
            for q in range(m):
                a -= 0.5 * (tht[i, q] * k[j, q] + tht[j, q] * k[i, q])
            p[i * row + j] = a
            p[j * row + i] = a
