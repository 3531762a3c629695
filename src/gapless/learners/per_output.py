"""Several outputs from a regressor that knows but one."""

from __future__ import annotations

from typing import Any, ClassVar, Self

from sklearn.base import clone

from gapless.learners.base import OutputByOutput, as_good_as
from gapless.learners.svr import MeanLossSVR


class PerOutput(OutputByOutput):
    """A copy of the regressor for each output; scikit-learn's MultiOutputRegressor refuses 1-D targets.

    Parameters
    ----------
    estimator : estimator, optional
        SVR if None.

    Attributes
    ----------
    estimators_ : list of estimators
        One an output.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {"estimator": "no_validation"}

    def __init__(self, estimator: Any = None) -> None:
        self.estimator = estimator

    def __sklearn_tags__(self) -> Any:
        return as_good_as(super().__sklearn_tags__(), self._chosen())

    def _chosen(self) -> Any:
        return MeanLossSVR() if self.estimator is None else self.estimator

    def fit(self, X: Any, y: Any, **fit_params: Any) -> Self:
        """Fit every output.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        **fit_params
            For the regressor.

        Returns
        -------
        PerOutput
        """
        X, targets, _ = self._checked(X, y)
        self.estimators_ = [clone(self._chosen()).fit(X, column, **fit_params) for column in targets.T]
        return self
