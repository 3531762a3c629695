"""Random-layer networks against their formulas in plain numpy, and least squares that go on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import expit
from sklearn.linear_model import Ridge

from gapless.learners.least_squares import absorb, nothing, solve
from gapless.learners.random_layer import RandomLayer, elm, fourier, fourier_elm, relm, rvfl, rvfl_ridge

RNG = np.random.default_rng(0)
X, T = RNG.uniform(-1.0, 1.0, (80, 3)), RNG.normal(size=(80, 2))


def pre(model):
    return X @ model.hidden_ + model.bias_


def test_elm_is_the_pseudo_inverse_of_a_sigmoid_layer():
    model = elm().set_params(random_state=1).fit(X, T)
    hidden = expit(pre(model))
    # the layer's condition is some 1e5: beta is far less certain than what it predicts
    np.testing.assert_allclose(model.predict(X), hidden @ (np.linalg.pinv(hidden) @ T), atol=1e-9)
    assert model.hidden_.shape == (3, 20)


def test_relm_solves_the_normal_equations_of_the_paper():
    weight = RNG.uniform(0.1, 2.0, 80)
    model = relm().set_params(random_state=1, penalty=0.1).fit(X, T, sample_weight=weight)
    hidden = expit(pre(model))
    squared = np.diag(weight)
    beta = np.linalg.solve(0.1 * np.eye(20) + hidden.T @ squared @ hidden, hidden.T @ squared @ T)
    np.testing.assert_allclose(model.output_, beta, rtol=1e-8)  # a condition of 1e4, squared


@pytest.mark.parametrize("make", [rvfl, rvfl_ridge])
def test_rvfl_has_bells_and_direct_links(make):
    model = make().set_params(random_state=2).fit(X, T)
    design = np.hstack([np.exp(-(pre(model) ** 2)), X])
    wanted = (
        Ridge(alpha=model.penalty, fit_intercept=False, solver="svd").fit(design, T).predict(design)
        if model.penalty
        else design @ np.linalg.lstsq(design, T, rcond=None)[0]
    )
    np.testing.assert_allclose(model.predict(X), wanted, atol=1e-9)


def test_rvfl_learns_a_plane_exactly():
    plane = X @ np.array([[1.0], [2.0], [-3.0]])
    elsewhere = RNG.uniform(-50.0, 50.0, (9, 3))
    model = RandomLayer(nodes="gaussian", direct_links=True, random_state=0).fit(X, plane)
    np.testing.assert_allclose(model.predict(elsewhere), elsewhere @ [[1.0], [2.0], [-3.0]], atol=1e-6)


def test_fourier_nodes_are_those_of_equation_37():
    x, period = RNG.uniform(-2.0, 2.0, (5, 7)), 2.5
    wanted = np.empty_like(x)
    for i in range(7):
        column = x[:, i]
        if i == 0:
            wanted[:, i] = 1.0
        elif i % 2:
            wanted[:, i] = np.cos((i + 1) / 2 * np.pi * column / period)
        else:
            wanted[:, i] = np.sin(i / 2 * np.pi * column / period)
    np.testing.assert_allclose(fourier(x, period), wanted, atol=1e-14)  # rounding of the angles


def test_the_half_period_covers_the_training_set():
    model = fourier_elm().set_params(random_state=3).fit(X, T)
    assert np.abs(pre(model)).max() == model.half_period_


def test_going_on_gives_the_solution_of_all_samples():
    model = elm().set_params(random_state=1)
    for i in range(0, 80, 16):
        model.partial_fit(X[i : i + 16], T[i : i + 16])
    hidden = expit(pre(model))
    np.testing.assert_allclose(model.predict(X), hidden @ (np.linalg.pinv(hidden) @ T), atol=1e-9)


def test_going_on_begins_with_a_single_sample():
    """OS-ELM itself wants as many as there are nodes."""
    model = relm().set_params(random_state=1)
    for row, target in zip(X[:5], T[:5], strict=True):
        model.partial_fit(row[None], target[None])
    whole = relm().set_params(random_state=1).fit(X[:5], T[:5])
    np.testing.assert_allclose(model.predict(X), whole.predict(X), atol=1e-9)


def test_another_number_of_outputs_is_refused():
    with pytest.raises(ValueError, match="y has 1 outputs and had 2"):
        elm().fit(X, T).partial_fit(X, T[:, 0])


@pytest.mark.parametrize("weight", [-np.ones(80), np.zeros(80)])
def test_weights_that_mean_nothing_are_refused(weight):
    with pytest.raises(ValueError, match=r"(?i)sample.weight"):
        elm().fit(X, T, sample_weight=weight)


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.integers(1, 6), st.floats(0.0, 10.0))
def test_least_squares_in_pieces(seed, rows, columns, penalty):
    """Against numpy's lstsq on the rows and, for the penalty, sqrt(penalty) I below them."""
    rng = np.random.default_rng(seed)
    a, t, w = rng.normal(size=(rows, columns)), rng.normal(size=(rows, 2)), rng.uniform(0.5, 2.0, rows)
    penalty = 0.0 if penalty < 0.01 else penalty
    cut = rng.integers(0, rows + 1)
    known = absorb(nothing(columns, 2), a[:cut], t[:cut], w[:cut])
    known = absorb(known, a[cut:], t[cut:], w[cut:])
    root = np.sqrt(w)[:, None]
    below = np.sqrt(penalty) * np.eye(columns)
    wanted = np.linalg.lstsq(
        np.vstack([root * a, below]), np.vstack([root * t, np.zeros((columns, 2))]), rcond=None
    )[0]
    condition = np.linalg.cond(np.vstack([root * a, below]) if penalty else root * a)
    # rounding times the condition; a square normal matrix is badly conditioned now and then
    np.testing.assert_allclose(solve(known, penalty), wanted, atol=1e-13 * max(condition, 10.0) ** 2)


def test_the_pseudo_inverse_of_dependent_columns_has_the_least_norm():
    a = np.column_stack([X, X[:, 0]])
    beta = solve(absorb(nothing(4, 2), a, T, np.ones(80)), 0.0)
    np.testing.assert_allclose(beta, np.linalg.pinv(a) @ T, atol=1e-12)
    np.testing.assert_allclose(beta[0], beta[3], atol=1e-12)
