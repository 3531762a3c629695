"""Sequential minimal optimisation: the dual of support vector regression, compiled.

Platt's pairs, the second chosen by second-order information (Fan, Chen & Lin 2005, *JMLR* 6). With
beta = alpha - alpha*, one variable a sample and never both of its halves: minimise
beta' K beta / 2 - y' beta + epsilon |beta|_1 over -C <= beta <= C, sum beta = 0.
"""

from __future__ import annotations

import warnings
from typing import Final

import numpy as np
from sklearn.exceptions import ConvergenceWarning

from gapless._numba import kernel
from gapless.trip.recording import Array

TOLERANCE: Final = 1e-3
"""Largest violation of the optimality conditions that is left, in units of the target."""
LIMIT: Final = 1_000_000
"""Most pairs; some hundreds are usual."""
FLAT: Final = 1e-12
"""Least curvature along a pair: two equal samples have none."""


def solve(gram: Array, target: Array, c: float, epsilon: float) -> tuple[Array, float]:
    """Coefficients and intercept of the machine.

    Parameters
    ----------
    gram : ndarray, shape (n, n)
        K, positive semidefinite.
    target : ndarray, shape (n,)
    c : float
        Bound on a coefficient: the weight of a residual beyond `epsilon`.
    epsilon : float
        Residuals below cost nothing.

    Returns
    -------
    beta : ndarray, shape (n,)
        f(x) = sum beta_i K(x_i, x) + b.
    b : float
    """
    beta, b, left = _solve(np.ascontiguousarray(gram), np.ascontiguousarray(target), c, epsilon)
    if left > TOLERANCE:
        warnings.warn(f"SVR stopped {left:.2g} from its optimum", ConvergenceWarning, stacklevel=2)
    return beta, b


@kernel
def _solve(gram: Array, target: Array, c: float, epsilon: float) -> tuple[Array, float, float]:
    n = len(target)
    beta, rest = np.zeros(n), target.copy()
    most = least = 0.0
    for _ in range(LIMIT):
        i, most = _steepest(beta, rest, c, epsilon)
        j, least, slope = _partner(gram, beta, rest, c, epsilon, i, most)
        if most - least <= TOLERANCE:
            break
        step = slope / max(gram[i, i] + gram[j, j] - 2.0 * gram[i, j], FLAT)
        # no farther than to a bound, or to zero, where the slope changes
        step = min(step, -beta[i] if beta[i] < 0.0 else c - beta[i])
        step = min(step, beta[j] if beta[j] > 0.0 else c + beta[j])
        beta[i] += step
        beta[j] -= step
        for k in range(n):
            rest[k] -= step * (gram[i, k] - gram[j, k])
    return beta, _intercept(beta, rest, c, epsilon, 0.5 * (most + least)), most - least


@kernel
def _steepest(beta: Array, rest: Array, c: float, epsilon: float) -> tuple[int, float]:
    """The sample whose coefficient gains most by growing."""
    best, most = 0, -np.inf
    for k in range(len(beta)):
        gain = rest[k] + (epsilon if beta[k] < 0.0 else -epsilon)
        if beta[k] < c and gain > most:
            best, most = k, gain
    return best, most


@kernel
def _partner(
    gram: Array, beta: Array, rest: Array, c: float, epsilon: float, i: int, most: float
) -> tuple[int, float, float]:
    """The sample that shrinks instead, for the largest decrease; the least gain of all; the pair's slope."""
    best, least, decrease, slope = i, np.inf, 0.0, 0.0
    for k in range(len(beta)):
        if beta[k] <= -c:
            continue
        gain = rest[k] + (-epsilon if beta[k] > 0.0 else epsilon)
        least = min(least, gain)
        if gain < most:
            lower = (most - gain) ** 2 / max(gram[i, i] + gram[k, k] - 2.0 * gram[i, k], FLAT)
            if lower > decrease:
                best, decrease, slope = k, lower, most - gain
    return best, least, slope


@kernel
def _intercept(beta: Array, rest: Array, c: float, epsilon: float, middle: float) -> float:
    """Mean of what free coefficients say; between the bounds where there is none."""
    total, free = 0.0, 0
    for k in range(len(beta)):
        if beta[k] != 0.0 and -c < beta[k] < c:
            total += rest[k] + (epsilon if beta[k] < 0.0 else -epsilon)
            free += 1
    return total / free if free else middle
