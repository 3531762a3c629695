"""Support vector regression with the paper's C."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from sklearn.utils._param_validation import Interval

from gapless.learners.base import OutputByOutput
from gapless.learners.rbf import squared_distances
from gapless.learners.smo import solve
from gapless.trip.recording import Array


class Expansion(NamedTuple):
    """A fitted machine; its parts have the names that they have in scikit-learn's SVR.

    Parameters
    ----------
    support_vectors_ : ndarray, shape (s, m)
    dual_coef_ : ndarray, shape (1, s)
    intercept_ : ndarray, shape (1,)
    """

    support_vectors_: Array
    dual_coef_: Array
    intercept_: Array


class MeanLossSVR(OutputByOutput):
    """SVR that minimises |w|^2/2 + C/l sum (xi + xi*), l the number of samples (tan2015 eq. 13).

    The C of other libraries is C/l. K(x, z) = exp(-gamma |x - z|^2). Inputs and targets should lie in [-1, 1]
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
    estimators_ : list of Expansion
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
        self.estimators_ = [self._machine(X, column) for column in targets.T]
        return self

    def _machine(self, X: Array, column: Array) -> Expansion:
        gram = np.exp(-self.gamma * squared_distances(X, X))
        beta, intercept = solve(gram, column, self.C / len(X), self.epsilon)
        used = beta != 0.0
        return Expansion(X[used], beta[None, used], np.array([intercept]))

    def _predict(self, X: Array) -> Array:
        return np.column_stack([self._one(machine, X) for machine in self.estimators_])

    def _one(self, machine: Expansion, X: Array) -> Array:
        kernel = np.exp(-self.gamma * squared_distances(X, machine.support_vectors_))
        answer: Array = kernel @ machine.dual_coef_[0] + machine.intercept_
        return answer
