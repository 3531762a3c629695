"""The radial basis function network: centres by k-means, widths from their spacing, linear output."""

from __future__ import annotations

import warnings
from numbers import Real
from typing import Any, ClassVar, Final, Self

import numpy as np
from sklearn.cluster import KMeans
from sklearn.exceptions import ConvergenceWarning
from sklearn.utils._param_validation import Integral, Interval

from gapless.learners.base import Learner
from gapless.learners.least_squares import absorb, nothing, solve
from gapless.trip.recording import Array

_NEIGHBOURS: Final = 2
"""Centres that a width looks at (Moody and Darken 1989, section 3)."""


class RBFNetwork(Learner):
    """Gaussian bells at centres of the inputs, and a constant, summed linearly.

    phi_j(x) = exp(-|x - c_j|^2 / (2 s_j^2)): centres c_j by k-means, widths s_j the root mean square
    distance to the two nearest other centres, output weights by least squares (Moody and Darken 1989).
    Inputs should lie in [-1, 1] (see `scaling`).

    Parameters
    ----------
    n_nodes : int
        The papers take 20; no more than there are different samples are used.
    penalty : float
        On the squared output weights; 0 for the pseudo-inverse.
    overlap : float
        Factor on the widths.
    random_state : int, RandomState or None
        Of the first centres.

    Attributes
    ----------
    centres_ : ndarray, shape (nodes, n_features_in_)
    widths_ : ndarray, shape (nodes,)
        In units of the inputs; 1 where there is but one centre.
    output_ : ndarray, shape (nodes + 1, n_outputs_)
        The last row is the constant.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "n_nodes": [Interval(Integral, 1, None, closed="left")],
        "penalty": [Interval(Real, 0.0, None, closed="left")],
        "overlap": [Interval(Real, 0.0, None, closed="neither")],
        "random_state": ["random_state"],
    }

    def __init__(
        self, n_nodes: int = 20, penalty: float = 0.0, overlap: float = 1.0, random_state: Any = None
    ) -> None:
        self.n_nodes = n_nodes
        self.penalty = penalty
        self.overlap = overlap
        self.random_state = random_state

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.regressor_tags.poor_score = True  # twenty bells do not fill ten dimensions
        return tags

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        nodes = min(self.n_nodes, len(np.unique(X, axis=0)))
        means = KMeans(nodes, n_init=1, random_state=self.random_state)
        with warnings.catch_warnings():  # rows that differ by less than rounding are one cluster
            warnings.simplefilter("ignore", ConvergenceWarning)
            self.centres_ = means.fit(X).cluster_centers_
        self.widths_ = self.overlap * spacing(self.centres_)
        design = self._design(X)
        known = absorb(nothing(design.shape[1], self.n_outputs_), design, targets, weight)
        self.output_ = solve(known, self.penalty)
        return self

    def _design(self, X: Array) -> Array:
        bells = np.exp(-squared_distances(X, self.centres_) / (2.0 * self.widths_**2))
        return np.column_stack([bells, np.ones(len(X))])

    def _predict(self, X: Array) -> Array:
        return self._design(X) @ self.output_


def squared_distances(a: Array, b: Array) -> Array:
    """Squared distances between the rows of two arrays.

    Parameters
    ----------
    a : ndarray, shape (n, m)
    b : ndarray, shape (p, m)

    Returns
    -------
    ndarray, shape (n, p)
    """
    squares: Array = (a**2).sum(1)[:, None] + (b**2).sum(1) - 2.0 * a @ b.T
    return np.maximum(squares, 0.0)


def spacing(centres: Array) -> Array:
    """Root mean square distance of each centre to its two nearest others; 1 for a single centre.

    Parameters
    ----------
    centres : ndarray, shape (p, m)

    Returns
    -------
    ndarray, shape (p,)
    """
    if len(centres) == 1:
        return np.ones(1)
    nearest = np.sort(squared_distances(centres, centres), axis=1)[:, 1 : 1 + _NEIGHBOURS]
    widths: Array = np.maximum(np.sqrt(nearest.mean(axis=1)), 1e-6)
    return widths
