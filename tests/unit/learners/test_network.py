"""The feed-forward network: its gradient, and with one output it is scikit-learn's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sklearn.neural_network import MLPRegressor

from gapless.learners import make
from gapless.learners.network import Perceptron, misfit, unpacked

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (60, 4))
Y = np.column_stack([np.sin(3.0 * X[:, 0]), X[:, 1] * X[:, 2]])
SIZE = 4 * 5 + 5 * 2 + 5 + 2


def test_the_gradient_is_that_of_the_misfit():
    weights, step = RNG.uniform(-1.0, 1.0, SIZE), 1e-6
    gradient = misfit(weights, X, Y, 5, 0.1)[1]
    for k in range(SIZE):
        aside = np.zeros(SIZE)
        aside[k] = step
        up, down = (misfit(weights + way * aside, X, Y, 5, 0.1)[0] for way in (1.0, -1.0))
        # central differences: rounding of values near 1 over twice the step
        assert gradient[k] == pytest.approx((up - down) / (2.0 * step), abs=1e-9)


def test_parts_are_views():
    weights = np.zeros(SIZE)
    for part in unpacked(weights, 4, 5, 2):
        part += 1.0
    assert (weights == 1.0).all()


def test_all_outputs_are_those_of_one_network():
    fitted = make("mlp", {"n_nodes": 6, "max_iter": 5}).fit(X, Y).regressor_
    assert isinstance(fitted, Perceptron)
    assert fitted.layers_.output.shape == (6, 2)


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")
def test_with_one_output_it_is_the_library_s():
    ours = Perceptron(n_nodes=6, max_iter=30, random_state=3).fit(X, Y[:, 0]).predict(X)
    same = {"activation": "tanh", "solver": "lbfgs", "alpha": 1e-3, "tol": 1e-6, "max_iter": 30}
    theirs = MLPRegressor(hidden_layer_sizes=(6,), random_state=3, **same).fit(X, Y[:, 0]).predict(X)
    # one sum is rounded otherwise; over thirty steps that stays as small
    assert_allclose(ours, theirs, rtol=0.0, atol=1e-8)
