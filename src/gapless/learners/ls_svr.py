"""Least-squares support vector regression, in closed form (Suykens et al. 2002)."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Self

import numpy as np
from sklearn.utils._param_validation import Interval

from gapless.learners.base import TakesWeights
from gapless.learners.rbf import squared_distances
from gapless.trip.recording import Array


class LSSVR(TakesWeights):
    """LS-SVR with K(x, z) = exp(-gamma |x - z|^2).

    It minimises |w|^2/2 + C/2 sum v_i e_i^2 with v the sample weights, whose solution is
    ``[[0, 1'], [1, K + diag(1 / (C v))]] [b; alpha] = [0; y]`` (Suykens et al. 2002, eq. 3.5 and 3.11).
    With M = K + diag(1/(C v)), b = 1'M^-1 y / 1'M^-1 1 and alpha = M^-1 (y - b): all outputs share
    one factorisation. Inputs and targets should lie in [-1, 1] (see `scaling`).

    Parameters
    ----------
    C : float
        Weight of the errors; Suykens' gamma.
    gamma : float
        Of the kernel; 1/sigma^2 in Suykens' notation.

    Attributes
    ----------
    support_ : ndarray, shape (n, n_features_in_)
    alpha_ : ndarray, shape (n, n_outputs_)
    intercept_ : ndarray, shape (n_outputs_,)
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "C": [Interval(Real, 0.0, None, closed="neither")],
        "gamma": [Interval(Real, 0.0, None, closed="neither")],
    }

    def __init__(self, C: float = 100.0, gamma: float = 0.5) -> None:
        self.C = C
        self.gamma = gamma

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        matrix = self._kernel(X, X) + np.diag(1.0 / (self.C * weight))
        solved = np.linalg.solve(matrix, np.column_stack([np.ones(len(X)), targets]))
        self.intercept_ = solved[:, 1:].sum(axis=0) / solved[:, 0].sum()
        self.alpha_ = solved[:, 1:] - solved[:, :1] * self.intercept_
        self.support_ = X
        return self

    def _kernel(self, a: Array, b: Array) -> Array:
        return np.exp(-self.gamma * squared_distances(a, b))

    def _predict(self, X: Array) -> Array:
        answer: Array = self._kernel(X, self.support_) @ self.alpha_ + self.intercept_
        return answer
