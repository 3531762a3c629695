"""Linear least squares that can go on: the one solver of all networks with a linear output.

The square-root information form (Bierman 1977): what samples say about the weights is kept as a
triangle R and a right side Z with R beta = Z. Taking in more samples is one QR decomposition, which
gives what the recursive least squares of OS-ELM (Liang et al. 2006) gives and more: it may begin
with a single sample, and nothing is squared.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gapless.trip.recording import Array


class Triangle(NamedTuple):
    """What the samples say so far.

    Parameters
    ----------
    factor : ndarray, shape (r, p)
        Upper triangular R, r <= p.
    right : ndarray, shape (r, k)
        Z.
    """

    factor: Array
    right: Array


def nothing(width: int, outputs: int) -> Triangle:
    """The triangle before the first sample.

    Parameters
    ----------
    width : int
        Columns of the design matrix.
    outputs : int

    Returns
    -------
    Triangle
    """
    return Triangle(np.zeros((0, width)), np.zeros((0, outputs)))


def absorb(known: Triangle, design: Array, targets: Array, weight: Array) -> Triangle:
    """The triangle with more samples in it.

    Parameters
    ----------
    known : Triangle
    design : ndarray, shape (n, p)
    targets : ndarray, shape (n, k)
    weight : ndarray, shape (n,)
        Of the squared residuals.

    Returns
    -------
    Triangle
    """
    root = np.sqrt(weight)[:, None]
    q, factor = np.linalg.qr(np.vstack([known.factor, root * design]))
    return Triangle(factor, q.T @ np.vstack([known.right, root * targets]))


def solve(known: Triangle, penalty: float) -> Array:
    """Weights that minimise ||A beta - T||^2 + penalty ||beta||^2; of the least norm where there are many.

    With a penalty of zero it is the Moore-Penrose solution A+ T, with one of 1/gamma
    (I/gamma + A'A)^-1 A'T, both from the singular values of R.

    Parameters
    ----------
    known : Triangle
    penalty : float
        Not negative.

    Returns
    -------
    ndarray, shape (p, k)
    """
    u, s, vt = np.linalg.svd(known.factor, full_matrices=False)
    kept = s > np.finfo(float).eps * known.factor.shape[1] * s.max(initial=0.0)
    gain = np.zeros_like(s)
    gain[kept] = s[kept] / (s[kept] ** 2 + penalty)
    beta: Array = vt.T @ (gain[:, None] * (u.T @ known.right))
    return beta
