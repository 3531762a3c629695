"""The dual's solver against LIBSVM, and against the conditions of an optimum."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.exceptions import ConvergenceWarning
from sklearn.metrics.pairwise import rbf_kernel
from sklearn.svm import SVR

from gapless.learners import smo
from gapless.learners.svr import MeanLossSVR


def samples(seed, n):
    rng = np.random.default_rng(seed)
    x = np.clip(0.4 * rng.normal(size=(n, 6)), -1.0, 1.0)
    return x, np.sin(x @ rng.normal(size=6)) + 0.3 * rng.normal(size=n)


@pytest.mark.parametrize("gamma", [0.02, 0.5, 8.0, 300.0])
@pytest.mark.parametrize("c", [0.5, 50.0, 500.0])
@pytest.mark.parametrize("epsilon", [0.0, 0.001, 0.1])
def test_answers_are_those_of_libsvm(gamma, c, epsilon):
    x, y = samples(3, 80)
    ours = MeanLossSVR(C=c, gamma=gamma, epsilon=epsilon).fit(x, y)
    theirs = SVR(C=c / 80, gamma=gamma, epsilon=epsilon, tol=smo.TOLERANCE).fit(x, y)
    at = np.random.default_rng(5).uniform(-1.0, 1.0, (200, 6))
    # both stop where no condition is violated by more than 1e-3: some of these, in either
    np.testing.assert_allclose(ours.predict(at), theirs.predict(at), atol=5e-3)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    n=st.integers(2, 60),
    gamma=st.floats(1e-3, 1e3),
    c=st.floats(1e-3, 100.0),
    epsilon=st.floats(0.0, 0.5),
)
def test_conditions_of_an_optimum_hold(seed, n, gamma, c, epsilon):
    x, y = samples(seed, n)
    gram = rbf_kernel(x, gamma=gamma)
    beta, b = smo.solve(gram, y, c, epsilon)
    slack = 1e-9 * max(1.0, c)  # sums of some hundred steps
    assert abs(beta.sum()) < slack * n
    assert np.abs(beta).max() <= c + slack
    off = y - gram @ beta - b
    tol = smo.TOLERANCE + 1e-9 * n * c
    free = (np.abs(beta) > slack) & (np.abs(beta) < c - slack)
    np.testing.assert_allclose(off[free], np.sign(beta[free]) * epsilon, atol=tol)
    assert np.all(np.abs(off[np.abs(beta) <= slack]) <= epsilon + tol)  # those within the tube
    bound = np.abs(beta) >= c - slack
    assert np.all(off[bound] * np.sign(beta[bound]) >= epsilon - tol)


def test_equal_samples_with_other_targets_do_not_stop_it():
    x, y = np.zeros((6, 2)), np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    beta, b = smo.solve(rbf_kernel(x), y, 1.0, 0.1)
    np.testing.assert_allclose(np.abs(beta), 1.0)  # every one of them is out of reach
    assert 0.1 <= b <= 0.9


def test_one_that_does_not_arrive_says_so(monkeypatch):
    monkeypatch.setattr(smo, "_solve", lambda *args: (np.zeros(2), 0.0, 0.2))
    with pytest.warns(ConvergenceWarning, match=r"SVR stopped 0\.2 from its optimum"):
        smo.solve(np.eye(2), np.ones(2), 1.0, 0.1)
