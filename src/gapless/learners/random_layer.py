"""Networks with one random hidden layer and linear outputs: ELM, Fourier ELM, RELM, RVFL.

They differ in what a node computes, in whether inputs go straight to the outputs too, and in the
penalty. Inputs should lie in [-1, 1] (see `scaling`).
"""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import Any, ClassVar, Final, Self

import numpy as np
from sklearn.utils import check_random_state
from sklearn.utils._param_validation import Integral, Interval, StrOptions

from gapless.learners.base import TakesWeights
from gapless.learners.least_squares import Triangle, absorb, nothing, solve
from gapless.trip.recording import Array


def sigmoid(x: Array, half_period: float) -> Array:
    """1 / (1 + exp(-x)), as wang2018 (ELM) and Huang et al. 2006 have it.

    Parameters
    ----------
    x : ndarray, shape (n, nodes)
        Pre-activations.
    half_period : float
        Not used.

    Returns
    -------
    ndarray, shape (n, nodes)
    """
    return 0.5 + 0.5 * np.tanh(0.5 * x)


def gaussian(x: Array, half_period: float) -> Array:
    """exp(-x^2), liu2019 eq. 17.

    Parameters
    ----------
    x : ndarray, shape (n, nodes)
        Pre-activations.
    half_period : float
        Not used.

    Returns
    -------
    ndarray, shape (n, nodes)
    """
    return np.exp(-(x**2))


def fourier(x: Array, half_period: float) -> Array:
    """A function of its own for every node, wang2018 eq. 37.

    1 for node 0, cos((i+1)/2 pi x/l) for odd i, sin(i/2 pi x/l) for even i.

    Parameters
    ----------
    x : ndarray, shape (n, nodes)
        Pre-activations.
    half_period : float
        l; |x| <= l over the training set.

    Returns
    -------
    ndarray, shape (n, nodes)
    """
    node = np.arange(x.shape[1])
    angle = (node + 1) // 2 * (np.pi / half_period) * x
    return np.where((node % 2 == 1) | (node == 0), np.cos(angle), np.sin(angle))


NODES: Final[dict[str, Callable[[Array, float], Array]]] = {
    "sigmoid": sigmoid,
    "gaussian": gaussian,
    "fourier": fourier,
}


class RandomLayer(TakesWeights):
    """Hidden weights drawn once, output weights by least squares.

    With pre-activations x = X W + b, W uniform in [-width, width] and b in [0, width] (the bounds
    of Huang's and of Zhang and Suganthan's programs), nodes H = f(x) and design A = H or [H, X],
    the output weights are beta = A+ T, or (A'DA + penalty I)^-1 A'DT with D the sample weights.

    Parameters
    ----------
    n_nodes : int
        The papers take 20.
    nodes : {"sigmoid", "gaussian", "fourier"}
        What a node computes.
    direct_links : bool
        Inputs go to the outputs too (RVFL, liu2019 eq. 18).
    penalty : float
        On the squared output weights; 1/gamma of RELM, lambda of RVFL; 0 for the pseudo-inverse.
    width : float
        Of the hidden weights.
    random_state : int, RandomState or None

    Attributes
    ----------
    hidden_ : ndarray, shape (n_features_in_, n_nodes)
    bias_ : ndarray, shape (n_nodes,)
    half_period_ : float
        l of the Fourier nodes: the largest |x| of the first samples.
    output_ : ndarray, shape (n_nodes [+ n_features_in_], n_outputs_)
        beta.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "n_nodes": [Interval(Integral, 1, None, closed="left")],
        "nodes": [StrOptions(set(NODES))],
        "direct_links": ["boolean"],
        "penalty": [Interval(Real, 0.0, None, closed="left")],
        "width": [Interval(Real, 0.0, None, closed="neither")],
        "random_state": ["random_state"],
    }

    def __init__(
        self,
        n_nodes: int = 20,
        nodes: str = "sigmoid",
        direct_links: bool = False,
        penalty: float = 0.0,
        width: float = 1.0,
        random_state: Any = None,
    ) -> None:
        self.n_nodes = n_nodes
        self.nodes = nodes
        self.direct_links = direct_links
        self.penalty = penalty
        self.width = width
        self.random_state = random_state

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        # twenty waves of random direction and up to ten periods do not fit any ten inputs
        tags.regressor_tags.poor_score = self.nodes == "fourier"
        return tags

    def partial_fit(self, X: Any, y: Any, sample_weight: Any = None) -> Self:
        """Take in more samples: the outputs become those of all samples so far (OS-ELM).

        The hidden layer and the half period are those of the first call.

        Parameters
        ----------
        X : array-like, shape (n, m)
        y : array-like, shape (n,) or (n, k)
        sample_weight : array-like, shape (n,), optional

        Returns
        -------
        RandomLayer
        """
        if not hasattr(self, "output_"):
            return self.fit(X, y, sample_weight)
        return self._learn(*self._checked(X, y, sample_weight, reset=False))

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        self._draw(X)
        self._known = nothing(self._design(X).shape[1], targets.shape[1])
        return self._learn(X, targets, weight)

    def _draw(self, X: Array) -> None:
        rng = check_random_state(self.random_state)
        self.hidden_ = rng.uniform(-self.width, self.width, (X.shape[1], self.n_nodes))
        self.bias_ = rng.uniform(0.0, self.width, self.n_nodes)
        self.half_period_ = float(np.abs(X @ self.hidden_ + self.bias_).max()) or 1.0

    def _learn(self, X: Array, targets: Array, weight: Array) -> Self:
        self._known = absorb(Triangle(*self._known), self._design(X), targets, weight)
        self.output_ = solve(self._known, self.penalty)
        return self

    def _design(self, X: Array) -> Array:
        nodes = NODES[self.nodes](X @ self.hidden_ + self.bias_, self.half_period_)
        return np.hstack([nodes, X]) if self.direct_links else nodes

    def _predict(self, X: Array) -> Array:
        return self._design(X) @ self.output_


def elm() -> RandomLayer:
    """ELM: sigmoid nodes, pseudo-inverse (wang2018, section 3.3).

    Returns
    -------
    RandomLayer
    """
    return RandomLayer()


def fourier_elm() -> RandomLayer:
    """IELM: Fourier nodes, pseudo-inverse (wang2018, section 3.4).

    Returns
    -------
    RandomLayer
    """
    return RandomLayer(nodes="fourier")


def relm() -> RandomLayer:
    """RELM: sigmoid nodes, beta = (I/gamma + H'D^2 H)^-1 H'D^2 T (georges2015; Deng et al. 2009).

    The sample weights are D^2. The papers name no gamma; ours is 1000.

    Returns
    -------
    RandomLayer
    """
    return RandomLayer(penalty=1e-3)


def rvfl() -> RandomLayer:
    """RVFL: exp(-x^2) nodes and direct links, pseudo-inverse (liu2019 eq. 20).

    Returns
    -------
    RandomLayer
    """
    return RandomLayer(nodes="gaussian", direct_links=True)


def rvfl_ridge() -> RandomLayer:
    """RVFL with beta = (A'A + lambda I)^-1 A'T (liu2019 eq. 21, corrected); lambda 0.001 is ours.

    Returns
    -------
    RandomLayer
    """
    return RandomLayer(nodes="gaussian", direct_links=True, penalty=1e-3)
