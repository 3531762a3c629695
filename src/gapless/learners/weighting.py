"""Regression that trusts samples by their residuals: the weighted form of RELM, and of LS-SVR."""

from __future__ import annotations

from typing import Any, ClassVar, Final, Self

import numpy as np
from sklearn.base import clone

from gapless.learners.base import OutputByOutput, TakesWeights, weighable
from gapless.learners.random_layer import relm
from gapless.trip.recording import Array

_FULL: Final = 2.5
"""c1: trusted up to here [robust standard deviations] (Deng et al. 2009, after Suykens et al. 2002)."""
_NONE: Final = 3.0
"""c2: not trusted from here on."""
_LEAST: Final = 1e-4
"""The weight beyond c2."""


class ResidualWeighted(TakesWeights, OutputByOutput):
    """Fit, weigh the samples by their residuals, fit again.

    With s = IQR / (2 x 0.6745) of the residuals e, D_ii = 1 where |e_i/s| <= 2.5, (3 - |e_i/s|) / 0.5
    up to 3 and 1e-4 beyond; the squares of D weigh the squared residuals (Deng et al. 2009:
    ``beta = (I/gamma + H'D^2 H)^-1 H'D^2 T``). Each output has weights, and so a model, of its own.

    Parameters
    ----------
    estimator : estimator, optional
        Takes sample weights; RELM if None.

    Attributes
    ----------
    estimators_ : list of estimators
        One an output.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {"estimator": "no_validation"}

    def __init__(self, estimator: Any = None) -> None:
        self.estimator = estimator

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        base = weighable(relm() if self.estimator is None else self.estimator)
        models = []
        for column in targets.T:
            first = clone(base).fit(X, column, sample_weight=weight)
            trust = residual_weights(column - first.predict(X), weight)
            models.append(clone(base).fit(X, column, sample_weight=weight * trust**2))
        self.estimators_ = models
        return self


def residual_weights(residual: Array, weight: Array) -> Array:
    """Diagonal of D.

    Parameters
    ----------
    residual : ndarray, shape (n,)
    weight : ndarray, shape (n,)
        How often each counts for the quartiles.

    Returns
    -------
    ndarray, shape (n,)
    """
    order = np.argsort(residual, kind="stable")
    total = np.cumsum(weight[order])
    low, high = residual[order][np.searchsorted(total, np.array([0.25, 0.75]) * total[-1])]
    spread = (high - low) / (2.0 * 0.6745)
    if spread <= np.finfo(float).eps * np.abs(residual).max():  # half of the residuals are one
        return np.ones(len(residual))
    surprise = np.abs(residual) / spread
    trust: Array = np.clip((_NONE - surprise) / (_NONE - _FULL), _LEAST, 1.0)
    return trust


def weighted_relm() -> ResidualWeighted:
    """RELM weighted by residuals.

    Returns
    -------
    ResidualWeighted
    """
    return ResidualWeighted(relm())
