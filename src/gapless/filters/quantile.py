"""Quantiles of the chi-square distribution: bounds of gates, bands of averages."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np


def _lower_gamma(a: float, x: float) -> float:
    """Regularised lower incomplete gamma function P(a, x), by its series (DLMF 8.11.4)."""
    if x <= 0.0:
        return 0.0
    count = int(max(x - a, 0.0) + 40.0 * math.sqrt(x + 1.0) + 100.0)
    terms = np.cumprod(x / (a + np.arange(1.0, count)))
    return float(math.exp(a * math.log(x) - x - math.lgamma(a + 1.0)) * (1.0 + terms.sum()))


@lru_cache(256)
def chi_square_quantile(probability: float, dof: int) -> float:
    """Quantile of the chi-square distribution (so that no run has to load, or even have, SciPy).

    Parameters
    ----------
    probability : float
        In (0, 1).
    dof : int
        Degrees of freedom, at least 1.

    Returns
    -------
    float
        To 1e-9 of itself; bisection of the series of the distribution function.
    """
    low, high = 0.0, dof + 20.0 * math.sqrt(dof) + 60.0
    while high - low > 1e-10 * high:
        middle = 0.5 * (low + high)
        if _lower_gamma(0.5 * dof, 0.5 * middle) < probability:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
