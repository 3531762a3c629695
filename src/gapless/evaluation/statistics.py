"""Figures over many errors: spread over outages, NEES and NIS with their chi-square bands."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gapless.filters.quantile import chi_square_quantile
from gapless.trip.recording import Array

_SINGULAR = 1e-12
"""Smallest eigenvalue of correlations that can be solved with: below it there is rounding only."""


@dataclass(frozen=True)
class Spread:
    """How one figure is spread over outages.

    Parameters
    ----------
    count : int
        Of finite values.
    median, p90, p95, rms, worst : float
        In the unit of the values; percentiles linear between order statistics; NaN for none.
    """

    count: int
    median: float
    p90: float
    p95: float
    rms: float
    worst: float


def spread(values: Iterable[float]) -> Spread:
    """Median, percentiles, RMS and worst of the finite values.

    Parameters
    ----------
    values : iterable of float
        Magnitudes.

    Returns
    -------
    Spread
    """
    x = np.array(list(values), float)
    x = x[np.isfinite(x)]
    if not len(x):
        return Spread(0, *(math.nan,) * 5)
    median, p90, p95 = (float(q) for q in np.percentile(x, [50.0, 90.0, 95.0]))
    return Spread(len(x), median, p90, p95, rms(x), float(x.max()))


def rms(values: Array) -> float:
    """Root mean square of the finite values; NaN if there is none.

    Parameters
    ----------
    values : ndarray

    Returns
    -------
    float
    """
    x = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(x * x))) if x.size else math.nan


def nees(error: Array, covariance: Array) -> Array:
    """Normalised estimation error squared e' P^-1 e, row by row (Bar-Shalom et al. 2001, eq. 5.4.2-3).

    Parameters
    ----------
    error : ndarray, shape (n, d)
    covariance : ndarray, shape (n, d, d)
        In the square of the error's unit.

    Returns
    -------
    ndarray, shape (n,)
        NaN where an input is not finite or the covariance is not one: see `sound`.
    """
    result = np.full(len(error), np.nan)
    known = np.flatnonzero(np.isfinite(error).all(axis=1) & sound(covariance))
    sd, correlation = _correlation(covariance[known])
    e = error[known] / sd
    result[known] = np.einsum("ni,ni->n", e, np.linalg.solve(correlation, e[..., None])[..., 0])
    return result


def sound(covariance: Array) -> NDArray[np.bool_]:
    """Whether covariances are some: finite, with variances above zero, and not singular.

    Parameters
    ----------
    covariance : ndarray, shape (n, d, d)

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    diagonal = np.diagonal(covariance, axis1=1, axis2=2)
    fine = np.asarray(np.isfinite(covariance).all(axis=(1, 2)) & (diagonal > 0.0).all(axis=1))
    rows = np.flatnonzero(fine)
    _, correlation = _correlation(covariance[rows])
    regular = np.isfinite(correlation).all(axis=(1, 2))
    fine[rows] = regular
    rows = rows[regular]
    fine[rows] = np.linalg.eigvalsh(correlation[regular])[:, 0] > _SINGULAR
    return fine


def _correlation(covariance: Array) -> tuple[Array, Array]:
    """Standard deviations, shape (n, d), and correlations: of one size, whatever is stated."""
    sd = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    with np.errstate(over="ignore", invalid="ignore"):
        return sd, covariance / sd[:, :, None] / sd[:, None, :]


@dataclass(frozen=True)
class Consistency:
    """An average NEES or NIS beside the band that an honest covariance gives it.

    Parameters
    ----------
    count : int
        Of values averaged.
    dof : int
        Degrees of freedom of each.
    mean : float
        Their average; `dof` is its expectation.
    lower, upper : float
        Two-sided band of the average for independent values: chi-square with count x dof degrees
        of freedom, divided by count (Bar-Shalom et al. 2001, eq. 5.4.2-12). Epochs of one outage
        are anything but independent: feed one value an outage, or read the band as too narrow.
    within : float
        Share of the single values below their own quantile; the level is its expectation.
    """

    count: int
    dof: int
    mean: float
    lower: float
    upper: float
    within: float

    @property
    def honest(self) -> bool:
        """Whether the average lies in its band."""
        return self.lower <= self.mean <= self.upper


def consistency(values: Array, dof: int, level: float = 0.95) -> Consistency:
    """Average of NEES or NIS values, with its two-sided chi-square band.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Those that are not finite are left out.
    dof : int
        Degrees of freedom of each.
    level : float
        Probability of the band.

    Returns
    -------
    Consistency
    """
    x = values[np.isfinite(values)]
    n = len(x)
    if not n:
        return Consistency(0, dof, *(math.nan,) * 4)
    tail = 0.5 * (1.0 - level)
    lower, upper = (chi_square_quantile(p, n * dof) / n for p in (tail, 1.0 - tail))
    within = float(np.mean(x <= chi_square_quantile(level, dof)))
    return Consistency(n, dof, float(x.mean()), lower, upper, within)
