"""Support vector regression with the paper's C."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Self

from sklearn.svm import SVR
from sklearn.utils._param_validation import Interval

from gapless.learners.base import OutputByOutput
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
