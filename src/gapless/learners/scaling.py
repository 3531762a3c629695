"""Inputs and targets in [-1, 1] around any regressor."""

from __future__ import annotations

import warnings
from contextlib import AbstractContextManager
from functools import cache
from typing import Any, ClassVar, Self

import numpy as np
from sklearn.base import clone
from sklearn.exceptions import ConvergenceWarning
from sklearn.preprocessing import MinMaxScaler
from sklearn.utils.metaestimators import available_if
from threadpoolctl import ThreadpoolController

from gapless.learners.base import Learner, answers, as_good_as
from gapless.learners.random_layer import relm
from gapless.trip.recording import Array


def _goes_on(scaled: Any) -> bool:
    return hasattr(scaled._chosen(), "partial_fit")


@cache
def _pools() -> Any:
    return ThreadpoolController()


def one_thread() -> AbstractContextManager[Any]:
    """Within it the numerical libraries use one thread.

    Matrices of a hundred rows are no work to share: on a busy machine a second thread made fits ten
    to sixty times slower. And sums have an order that does not depend on the number of cores.

    Returns
    -------
    context manager
    """
    limit: AbstractContextManager[Any] = _pools().limit(limits=1)
    return limit


class Scaled(Learner):
    """A regressor that sees inputs and targets in [-1, 1], and answers in the targets' own units.

    The bounds are those of the first samples; later ones may lie beyond them. It learns in one thread.

    Parameters
    ----------
    regressor : estimator, optional
        Takes as many outputs as there are; RELM if None.

    Attributes
    ----------
    regressor_ : estimator
        Fitted.
    inputs_, targets_ : MinMaxScaler
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {"regressor": "no_validation"}

    def __init__(self, regressor: Any = None) -> None:
        self.regressor = regressor

    def __sklearn_tags__(self) -> Any:
        return as_good_as(super().__sklearn_tags__(), self._chosen())

    def _chosen(self) -> Any:
        return relm() if self.regressor is None else self.regressor

    def fit(self, X: Any, y: Any, **fit_params: Any) -> Self:
        """Find the bounds and fit the regressor.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        **fit_params
            For the regressor.

        Returns
        -------
        Scaled
        """
        X, targets, _ = self._checked(X, y)
        self.inputs_ = MinMaxScaler((-1.0, 1.0)).fit(X)
        self.targets_ = MinMaxScaler((-1.0, 1.0)).fit(targets)
        self.regressor_ = clone(self._chosen())
        with one_thread(), warnings.catch_warnings():
            # iterations are a budget: to use it up is no mishap
            warnings.simplefilter("ignore", ConvergenceWarning)
            self.regressor_.fit(*self._scaled(X, targets), **fit_params)
        return self

    @available_if(_goes_on)  # type: ignore[untyped-decorator]  # scikit-learn has no types
    def partial_fit(self, X: Any, y: Any, **fit_params: Any) -> Self:
        """Go on with more samples, where the regressor can; the bounds stay.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        **fit_params
            For the regressor.

        Returns
        -------
        Scaled
        """
        if not hasattr(self, "regressor_"):
            return self.fit(X, y, **fit_params)
        X, targets, _ = self._checked(X, y, reset=False)
        with one_thread():
            self.regressor_.partial_fit(*self._scaled(X, targets), **fit_params)
        return self

    def _scaled(self, X: Array, targets: Array) -> tuple[Array, Array]:
        scaled = self.targets_.transform(targets)
        return self.inputs_.transform(X), scaled.ravel() if self._flat else scaled

    def _predict(self, X: Array) -> Array:
        outputs = answers(self.regressor_, X * self.inputs_.scale_ + self.inputs_.min_)
        answer: Array = (np.reshape(outputs, (len(X), -1)) - self.targets_.min_) / self.targets_.scale_
        return answer
