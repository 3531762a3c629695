"""What all learners share: checked inputs, targets of one or several columns, weights of samples."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, MultiOutputMixin, RegressorMixin
from sklearn.utils import get_tags
from sklearn.utils.validation import (
    _check_sample_weight,
    check_is_fitted,
    has_fit_parameter,
    validate_data,
)

from gapless.trip.recording import Array


class Learner(MultiOutputMixin, RegressorMixin, BaseEstimator):
    """A regressor whose targets have shape (n,) or (n, k), and whose predictions have the same.

    A child says `_fit` and `_predict`, for checked arrays, and with a row of outputs a sample even
    where there is but one output.

    Attributes
    ----------
    n_features_in_ : int
    n_outputs_ : int
    """

    def fit(self, X: Any, y: Any) -> Self:
        """Learn from samples.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)

        Returns
        -------
        Learner

        Raises
        ------
        ValueError
            If the data or a parameter is not as it should be.
        """
        return self._fit(*self._checked(X, y))

    def _checked(
        self, X: Any, y: Any, sample_weight: Any = None, *, reset: bool = True
    ) -> tuple[Array, Array, Array]:
        """Inputs (n, m), targets (n, k) and positive weights (n,); samples of weight zero are gone."""
        self._validate_params()
        X, y = validate_data(self, X, y, reset=reset, dtype=np.float64, multi_output=True, y_numeric=True)
        weight = _check_sample_weight(sample_weight, X, dtype=np.float64)
        if np.any(weight < 0.0) or not np.any(weight > 0.0):
            raise ValueError("sample_weight must not be negative, nor zero throughout; mend the weights")
        targets = np.asarray(y, dtype=np.float64).reshape(len(X), -1)
        if reset:
            self.n_outputs_, self._flat = targets.shape[1], np.ndim(y) == 1
        elif targets.shape[1] != self.n_outputs_:
            raise ValueError(f"y has {targets.shape[1]} outputs and had {self.n_outputs_}; keep their number")
        used = weight > 0.0
        return X[used], targets[used], weight[used]

    def predict(self, X: Any) -> Array:
        """Predicted targets.

        Parameters
        ----------
        X : array-like, shape (n, n_features_in_)

        Returns
        -------
        ndarray, shape (n,) or (n, n_outputs_)
            As the targets of the fit.
        """
        check_is_fitted(self)
        X = validate_data(self, X, reset=False, dtype=np.float64)
        outputs = self._predict(X)
        return outputs.ravel() if self._flat else outputs

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        raise NotImplementedError

    def _predict(self, X: Array) -> Array:
        raise NotImplementedError


class TakesWeights(Learner):
    """A learner some of whose samples may count more than others."""

    def fit(self, X: Any, y: Any, sample_weight: Any = None) -> Self:
        """Learn from samples.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        sample_weight : array-like, shape (n,), optional

        Returns
        -------
        Learner

        Raises
        ------
        ValueError
            If the data or a parameter is not as it should be.
        """
        return self._fit(*self._checked(X, y, sample_weight))


class OutputByOutput(Learner):
    """A learner that makes a model of its own for every output: its `_fit` makes `estimators_`.

    Attributes
    ----------
    estimators_ : list of fitted models, one an output
    """

    def _predict(self, X: Array) -> Array:
        return np.column_stack([answers(model, X) for model in self.estimators_])


def answers(model: Any, X: Array) -> Array:
    """Predictions of a learner within another one, whose inputs were checked once, by that one.

    Parameters
    ----------
    model : fitted estimator
    X : ndarray, shape (n, m)

    Returns
    -------
    ndarray, shape (n,) or (n, k)
        What `predict` gives.
    """
    if not isinstance(model, Learner):
        return np.asarray(model.predict(X))
    outputs = model._predict(X)
    return outputs.ravel() if model._flat else outputs


def taught(model: Any, X: Array, y: Array, weight: Array | None = None) -> Any:
    """Fit a learner within another one, by which data and parameters were checked.

    Parameters
    ----------
    model : estimator
    X : ndarray, shape (n, m)
    y : ndarray, shape (n,)
    weight : ndarray, shape (n,), optional
        Positive; for those only that take any.

    Returns
    -------
    estimator
        The same.
    """
    if not isinstance(model, Learner):
        return model.fit(X, y) if weight is None else model.fit(X, y, sample_weight=weight)
    model.n_features_in_, model.n_outputs_, model._flat = X.shape[1], 1, True
    return model._fit(X, y[:, None], np.ones(len(y)) if weight is None else weight)


def as_good_as(tags: Any, inner: Any) -> Any:
    """Tags of a learner around another one, which does no better than that one does.

    Parameters
    ----------
    tags : Tags
        Its own, changed in place.
    inner : estimator

    Returns
    -------
    Tags
    """
    known = get_tags(inner).regressor_tags
    tags.regressor_tags.poor_score = known is not None and known.poor_score
    return tags


def weighable(estimator: Any) -> Any:
    """The estimator, if it takes sample weights.

    Parameters
    ----------
    estimator : estimator

    Returns
    -------
    estimator

    Raises
    ------
    ValueError
        If it does not.
    """
    if not has_fit_parameter(estimator, "sample_weight"):
        name = type(estimator).__name__
        raise ValueError(f"{name} takes no sample weights; choose RandomLayer, LSSVR, or another that does")
    return estimator
