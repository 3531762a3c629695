"""Quantities that take turns in inputs and outputs, each learned from its own past alone."""

from __future__ import annotations

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from sklearn.utils._param_validation import Integral, Interval

from gapless.learners.base import Learner, answers
from gapless.learners.rbf import RBFNetwork
from gapless.trip.recording import Array


class ByPart(Learner):
    """A copy of the regressor for each part; columns belong to the parts in turn, `width` at a time.

    Two RBF networks, one for the position and one for the velocity error, are what ASFP has
    (Semeniuk and Noureldin 2006, as wang2018 runs it): a row (east, north, v_e, v_n, east, ...) has two
    parts of width two.

    Parameters
    ----------
    estimator : estimator
    width : int
        Columns of a part that stand side by side.
    parts : int

    Attributes
    ----------
    estimators_ : list of estimators
        One for each part that has outputs.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "estimator": "no_validation",
        "width": [Interval(Integral, 1, None, closed="left")],
        "parts": [Interval(Integral, 1, None, closed="left")],
    }

    def __init__(self, estimator: Any, width: int = 2, parts: int = 2) -> None:
        self.estimator = estimator
        self.width = width
        self.parts = parts

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.regressor_tags.poor_score = True  # an output may hang on the inputs of another part
        return tags

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        inputs, outputs = self._of(X.shape[1]), self._of(targets.shape[1])
        need = int(outputs.max())
        if int(inputs.max()) < need:
            raise ValueError(
                f"X has {X.shape[1]} columns, none of part {need + 1}, and y has some; show all parts"
            )
        self.estimators_ = [
            clone(self.estimator).fit(X[:, inputs == part], targets[:, outputs == part])
            for part in range(need + 1)
        ]
        return self

    def _predict(self, X: Array) -> Array:
        inputs, outputs = self._of(X.shape[1]), self._of(self.n_outputs_)
        found = np.empty((len(X), self.n_outputs_))
        for part, model in enumerate(self.estimators_):
            found[:, outputs == part] = answers(model, X[:, inputs == part]).reshape(len(X), -1)
        return found

    def _of(self, columns: int) -> NDArray[np.int64]:
        """The part of each column."""
        return np.arange(columns) // self.width % self.parts


def by_part() -> ByPart:
    """Two RBF networks, for position and velocity in the plane.

    Returns
    -------
    ByPart
    """
    return ByPart(RBFNetwork())
