"""Cross-validated RMS of an estimator with given parameters, for many at a time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from sklearn import config_context
from sklearn.base import clone
from sklearn.utils.parallel import delayed

from gapless.learners.base import answers, taught
from gapless.trip.recording import Array


class Fitness(NamedTuple):
    """What a set of parameters is worth.

    Parameters
    ----------
    base : estimator
    X : ndarray, shape (n, m)
    y : ndarray, shape (n,)
    folds : list of (train, test)
        Indices.
    pool : sklearn.utils.parallel.Parallel
    """

    base: Any
    X: Array
    y: Array
    folds: list[tuple[Array, Array]]
    pool: Any

    def __call__(self, tried: Sequence[dict[str, float]]) -> list[float]:
        """RMS of the residuals over all folds, for each set of parameters.

        Parameters
        ----------
        tried : sequence of dict

        Returns
        -------
        list of float
            In units of y.
        """
        jobs = max(1, min(self.pool._effective_n_jobs(), len(tried)))
        shares = [tried[i::jobs] for i in range(jobs)]
        done = self.pool(delayed(_rms)(*self[:4], share) for share in shares)
        return [done[i % jobs][i // jobs] for i in range(len(tried))]


def _rms(
    base: Any, X: Array, y: Array, folds: list[tuple[Array, Array]], tried: Sequence[dict[str, float]]
) -> list[float]:
    """One process's share; data and parameters were checked once, by whoever searches."""
    parts = [(X[train], y[train], X[test], y[test]) for train, test in folds]
    with config_context(assume_finite=True, skip_parameter_validation=True):
        return [_cross_validated(clone(base).set_params(**params), parts) for params in tried]


def _cross_validated(model: Any, parts: list[tuple[Array, Array, Array, Array]]) -> float:
    errors = [answers(taught(model, X, y), X_test) - y_test for X, y, X_test, y_test in parts]
    return float(np.sqrt(np.mean(np.concatenate(errors) ** 2)))
