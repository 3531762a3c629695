"""The feed-forward network: its gradient, and that it is scikit-learn's, output by output."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sklearn.neural_network import MLPRegressor

from gapless.learners.network import Perceptron, misfit, unpacked

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (60, 4))
Y = np.column_stack([np.sin(3.0 * X[:, 0]), X[:, 1] * X[:, 2]])


def test_the_gradient_is_that_of_the_misfit():
    weights, step = RNG.uniform(-1.0, 1.0, 4 * 5 + 5 + 5 + 1), 1e-6
    gradient = misfit(weights, X, Y[:, :1], 5, 0.1)[1]
    for k in range(len(weights)):
        aside = np.zeros(len(weights))
        aside[k] = step
        up, down = (misfit(weights + way * aside, X, Y[:, :1], 5, 0.1)[0] for way in (1.0, -1.0))
        # central differences: rounding of values near 1 over twice the step
        assert gradient[k] == pytest.approx((up - down) / (2.0 * step), abs=1e-9)


def test_parts_are_views():
    weights = np.zeros(4 * 5 + 5 + 5 + 1)
    for part in unpacked(weights, 4, 5):
        part += 1.0
    assert (weights == 1.0).all()


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")
def test_it_is_the_library_s_network_for_each_output():
    ours = Perceptron(n_nodes=6, max_iter=30, random_state=3).fit(X, Y).predict(X)
    theirs = MLPRegressor(
        hidden_layer_sizes=(6,),
        activation="tanh",
        solver="lbfgs",
        alpha=1e-3,
        tol=1e-6,
        max_iter=30,
        random_state=3,
    )
    columns = [theirs.fit(X, column).predict(X) for column in Y.T]
    # here they agree bit for bit; libraries that round otherwise part slowly, over thirty steps
    assert_allclose(ours, np.column_stack(columns), rtol=0.0, atol=1e-8)
