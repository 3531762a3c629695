"""Support vector regression with the paper's C."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Self

import numpy as np
from sklearn.svm import SVR
from sklearn.utils._param_validation import Interval

from gapless.learners.base import OutputByOutput
from gapless.learners.rbf import squared_distances
from gapless.recording import Array


class MeanLossSVR(OutputByOutput):
    """SVR that minimises |w|^2/2 + C/l sum (xi + xi*), l the number of samples (tan2015 eq. 13).

    A library's C is C/l. K(x, z) = exp(-gamma |x - z|^2). Inputs and targets should lie in [-1, 1]
    (see `scaling`).

    Parameters
    ----------
    C : float
        In (0, 500] in the paper.
    gamma : float
        In (0, 1000] in the paper.
    epsilon : float
        Residuals below cost nothing. The paper names none; nearly all its samples are support
        vectors (its Table 2), so it must be small.

    Attributes
    ----------
    estimators_ : list of sklearn.svm.SVR
        One an output.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "C": [Interval(Real, 0.0, None, closed="neither")],
        "gamma": [Interval(Real, 0.0, None, closed="neither")],
        "epsilon": [Interval(Real, 0.0, None, closed="left")],
    }

    def __init__(self, C: float = 100.0, gamma: float = 0.5, epsilon: float = 0.001) -> None:
        self.C = C
        self.gamma = gamma
        self.epsilon = epsilon

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        own = {"C": self.C / len(X), "gamma": self.gamma, "epsilon": self.epsilon}
        self.estimators_ = [SVR(**own).fit(X, column) for column in targets.T]
        return self

    def _predict(self, X: Array) -> Array:
        return np.column_stack([self._one(svr, X) for svr in self.estimators_])

    def _one(self, svr: Any, X: Array) -> Array:
        """The kernel expansion: the library's own takes ten times as long, checking what is checked."""
        kernel = np.exp(-self.gamma * squared_distances(X, svr.support_vectors_))
        answer: Array = kernel @ svr.dual_coef_[0] + svr.intercept_
        return answer
