"""Least-squares support vector regression, in closed form (Suykens et al. 2002)."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Self

import numpy as np
from sklearn.utils._param_validation import Interval

from gapless.learners.base import Learner
from gapless.learners.rbf import squared_distances
from gapless.recording import Array


class LSSVR(Learner):
    """LS-SVR with K(x, z) = exp(-gamma |x - z|^2).

    It minimises |w|^2/2 + C/2 sum v_i e_i^2 with v the sample weights, whose solution is
    ``[[0, 1'], [1, K + diag(1 / (C v))]] [b; alpha] = [0; y]`` (Suykens et al. 2002, eq. 3.5 and 3.11).
    All outputs share one factorisation. Inputs and targets should lie in [-1, 1] (see `scaling`).

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

    def fit(self, X: Any, y: Any, sample_weight: Any = None) -> Self:
        """Solve for the dual weights.

        With M = K + diag(1/(C v)), b = 1'M^-1 y / 1'M^-1 1 and alpha = M^-1 (y - b).

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        sample_weight : array-like, shape (n,), optional

        Returns
        -------
        LSSVR
        """
        X, targets, weight = self._checked(X, y, sample_weight)
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
