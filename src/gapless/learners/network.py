"""The feed-forward network of aslinezhad2020: one hidden layer, as small as the paper's data allow."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from scipy.optimize import minimize
from sklearn.utils import check_random_state
from sklearn.utils._param_validation import Integral, Interval

from gapless.learners.base import Learner
from gapless.trip.recording import Array


class Layers(NamedTuple):
    """Weights of a network: hidden.T @ x + bias, tanh, output.T @ that + constant.

    Parameters
    ----------
    hidden : ndarray, shape (m, n_nodes)
    output : ndarray, shape (n_nodes, k)
    bias : ndarray, shape (n_nodes,)
    constant : ndarray, shape (k,)
    """

    hidden: Array
    output: Array
    bias: Array
    constant: Array


class Perceptron(Learner):
    """A hidden layer of tanh nodes and a linear output, trained as a whole by L-BFGS.

    It minimises (sum of squared residuals + penalty |w|^2) / 2n, w all weights but bias and constant, from
    the uniform weights of Glorot and Bengio 2010 (eq. 16), drawn for bias and constant too. All outputs are
    those of one network, and their squared residuals are summed (aslinezhad2020, eq. 30). The paper names
    neither layer nor method ("back-propagation"). On some hundred samples a quasi-Newton method needs no
    learning rate and gives the same result whatever their order.

    Parameters
    ----------
    n_nodes : int
        In the hidden layer.
    penalty : float
        On the squared weights.
    max_iter : int
        The budget: a fit that reaches it keeps what it has.
    tolerance : float
        Ends the search, on the largest component of the gradient.
    random_state : int, RandomState or None
        Of the first weights.

    Attributes
    ----------
    layers_ : Layers
    n_iter_ : int
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "n_nodes": [Interval(Integral, 1, None, closed="left")],
        "penalty": [Interval(Real, 0.0, None, closed="left")],
        "max_iter": [Interval(Integral, 1, None, closed="left")],
        "tolerance": [Interval(Real, 0.0, None, closed="left")],
        "random_state": ["random_state"],
    }

    def __init__(
        self,
        n_nodes: int = 20,
        penalty: float = 1e-3,
        max_iter: int = 500,
        tolerance: float = 1e-6,
        random_state: Any = None,
    ) -> None:
        self.n_nodes = n_nodes
        self.penalty = penalty
        self.max_iter = max_iter
        self.tolerance = tolerance
        self.random_state = random_state

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        sizes = X.shape[1], self.n_nodes, targets.shape[1]
        found = minimize(
            misfit, self._first(*sizes), (X, targets, self.n_nodes, self.penalty),
            method="L-BFGS-B", jac=True,
            options={"maxiter": self.max_iter, "gtol": self.tolerance, "maxfun": 30 * self.max_iter},
        )  # fmt: skip
        self.layers_, self.n_iter_ = unpacked(found.x, *sizes), int(found.nit)
        return self

    def _first(self, inputs: int, nodes: int, outputs: int) -> Array:
        rng = check_random_state(self.random_state)
        drawn: list[tuple[Array, Array]] = []
        for fan_in, fan_out in ((inputs, nodes), (nodes, outputs)):
            bound = np.sqrt(6.0 / (fan_in + fan_out))
            drawn.append((rng.uniform(-bound, bound, (fan_in, fan_out)), rng.uniform(-bound, bound, fan_out)))
        (hidden, bias), (output, constant) = drawn
        return np.concatenate([part.ravel() for part in Layers(hidden, output, bias, constant)])

    def _predict(self, X: Array) -> Array:
        w = self.layers_
        answer: Array = np.tanh(X @ w.hidden + w.bias) @ w.output + w.constant
        return answer


def unpacked(weights: Array, inputs: int, nodes: int, outputs: int) -> Layers:
    """Weights by layer; views.

    Parameters
    ----------
    weights : ndarray, shape (inputs nodes + nodes outputs + nodes + outputs,)
    inputs, nodes, outputs : int

    Returns
    -------
    Layers
    """
    a = inputs * nodes
    b = a + nodes * outputs
    c = b + nodes
    return Layers(
        weights[:a].reshape(inputs, nodes), weights[a:b].reshape(nodes, outputs), weights[b:c], weights[c:]
    )


def misfit(weights: Array, X: Array, targets: Array, nodes: int, penalty: float) -> tuple[float, Array]:
    """What a network minimises, and its gradient by back-propagation (aslinezhad2020, eq. 28 to 30).

    Parameters
    ----------
    weights : ndarray, shape (m nodes + nodes k + nodes + k,)
    X : ndarray, shape (n, m)
    targets : ndarray, shape (n, k)
    nodes : int
    penalty : float

    Returns
    -------
    value : float
    gradient : ndarray, as `weights`
    """
    n, sizes = len(X), (X.shape[1], nodes, targets.shape[1])
    w = unpacked(weights, *sizes)
    z = X @ w.hidden
    z += w.bias
    np.tanh(z, out=z)
    delta = z @ w.output
    delta += w.constant
    delta -= targets
    size = sum(float(np.dot(part, part)) for part in (w.hidden.ravel(), w.output.ravel()))
    value = 0.5 * (float(np.vdot(delta, delta)) + penalty * size) / n
    back = delta @ w.output.T
    back *= 1.0 - z**2
    gradient = np.empty_like(weights)
    g = unpacked(gradient, *sizes)
    np.add(X.T @ back, penalty * w.hidden, out=g.hidden)
    np.add(z.T @ delta, penalty * w.output, out=g.output)
    np.add.reduce(back, axis=0, out=g.bias)
    np.add.reduce(delta, axis=0, out=g.constant)
    gradient /= n
    return value, gradient
