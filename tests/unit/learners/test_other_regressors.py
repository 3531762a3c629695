"""RBF network, LS-SVR, SVR, residual weights, boosting, scaling: against formulas and scikit-learn."""

import numpy as np
import pytest
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.gaussian_process.kernels import RBF
from sklearn.metrics.pairwise import rbf_kernel
from sklearn.svm import SVR

from gapless.learners.adaboost_rt import AdaBoostRT
from gapless.learners.ls_svr import LSSVR
from gapless.learners.random_layer import RandomLayer
from gapless.learners.rbf import RBFNetwork, spacing
from gapless.learners.scaling import Scaled
from gapless.learners.svr import MeanLossSVR
from gapless.learners.weighting import ResidualWeighted, residual_weights

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (60, 2))
Y = np.column_stack([np.sin(3.0 * X[:, 0]), X[:, 0] * X[:, 1]])


def test_rbf_network_is_linear_least_squares_on_its_bells():
    model = RBFNetwork(random_state=0).fit(X, Y)
    bells = np.column_stack(
        [RBF(s)(X, c[None])[:, 0] for c, s in zip(model.centres_, model.widths_, strict=True)]
    )
    design = np.column_stack([bells, np.ones(60)])
    # bells that overlap: a condition of some 1e4, and squared distances as differences of squares
    np.testing.assert_allclose(model.predict(X), design @ (np.linalg.pinv(design) @ Y), atol=1e-8)


def test_widths_come_from_the_two_nearest_centres():
    centres = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])
    wanted = np.sqrt([(9 + 16) / 2, (9 + 25) / 2, (16 + 25) / 2])
    np.testing.assert_allclose(spacing(centres), wanted)


def test_rbf_network_uses_no_more_nodes_than_there_are_different_samples():
    model = RBFNetwork().fit(np.repeat([[0.0], [1.0], [2.0]], 5, axis=0), np.repeat([1.0, 2.0, 4.0], 5))
    np.testing.assert_allclose(model.predict([[0.0], [1.0], [2.0]]), [1.0, 2.0, 4.0], atol=1e-9)
    assert len(model.centres_) == 3


def test_ls_svr_solves_its_linear_system():
    weight = RNG.uniform(0.5, 2.0, 60)
    model = LSSVR(C=10.0, gamma=0.7).fit(X, Y, sample_weight=weight)
    kernel = rbf_kernel(X, X, gamma=0.7)
    ridged = kernel + np.diag(0.1 / weight)
    system = np.block([[np.zeros((1, 1)), np.ones((1, 60))], [np.ones((60, 1)), ridged]])
    solution = np.linalg.solve(system, np.vstack([np.zeros((1, 2)), Y]))
    np.testing.assert_allclose(model.intercept_, solution[0], atol=1e-10)
    np.testing.assert_allclose(model.alpha_, solution[1:], atol=1e-9)
    np.testing.assert_allclose(model.predict(X), kernel @ solution[1:] + solution[0], atol=1e-9)


def test_svr_takes_the_papers_c():
    ours = MeanLossSVR(C=120.0, gamma=0.7, epsilon=0.01).fit(X, Y)
    for k in range(2):
        theirs = SVR(C=2.0, gamma=0.7, epsilon=0.01).fit(X, Y[:, k])
        np.testing.assert_allclose(ours.predict(X)[:, k], theirs.predict(X), atol=5e-3)  # see test_smo.py


def test_residual_weights_fall_from_one_to_almost_nothing():
    residual = np.concatenate([np.linspace(-1.0, 1.0, 101), [5.0]])
    low, high = np.quantile(residual, [0.25, 0.75], method="inverted_cdf")
    s = (high - low) / 1.349
    weights = residual_weights(np.append(residual, 2.75 * s), np.ones(103))
    assert np.all(weights[:101] == 1.0)
    assert weights[101] == 1e-4
    # half way down the ramp; one more residual moves a quartile by one step of 0.02
    assert weights[102] == pytest.approx(0.5, abs=0.15)


def test_weights_make_a_fit_that_does_not_mind_outliers():
    y = X @ [1.0, -2.0]
    struck = y.copy()
    struck[::10] += 50.0
    plain = RandomLayer(direct_links=True, nodes="gaussian", n_nodes=3, penalty=1e-3, random_state=0)
    errors = [np.abs(m.fit(X, struck).predict(X) - y).max() for m in (plain, ResidualWeighted(plain))]
    assert errors[1] < 0.2 * errors[0]  # once weighted; the first fit was bent by 5 on average


class Mean(RegressorMixin, BaseEstimator):
    """Weighted mean of the targets, which one can boost by hand."""

    def fit(self, X, y, sample_weight):
        self.mean_ = np.average(y, weights=sample_weight)
        self.weights_ = np.array(sample_weight)
        return self

    def predict(self, X):
        return np.full(len(X), self.mean_)


def by_hand(y, rounds, phi, r):
    """AdaBoost.RT over means, as the page says it, loop by loop."""
    n = len(y)
    d, s, out, votes, phis, last = np.full(n, 1.0 / n), y.std(), [], [], [], None
    for _ in range(rounds):
        f = float(np.sum(d * y))
        e = np.abs(f - y) / s
        eps = min(max(sum(d[i] for i in range(n) if e[i] > phi), 1e-6), 1.0 - 1e-6)
        d = np.array([d[i] * (eps if e[i] <= phi else 1.0) for i in range(n)])
        d /= d.sum()
        out.append(f)
        votes.append(np.log(1.0 / eps))
        phis.append(phi)
        rmse = np.sqrt(np.mean(e**2))
        if last is not None and rmse != last:
            lam = min(r * abs(rmse - last) / rmse, r)
            phi *= 1.0 - lam if rmse < last else 1.0 + lam
        last = rmse
    return np.dot(out, votes) / sum(votes), phis


def test_boosting_by_hand():
    y = np.random.default_rng(1).normal(size=20)
    x = np.zeros((20, 1))
    model = AdaBoostRT(Mean(), rounds=8, threshold=0.5).fit(x, y)
    wanted, phis = by_hand(y, 8, 0.5, 0.5)
    assert len(set(phis)) > 4  # it does adapt
    np.testing.assert_allclose(model.predict(x), wanted, rtol=1e-12)
    np.testing.assert_allclose(model.thresholds_[0], phis, rtol=1e-12)


def test_boosted_samples_weigh_one_on_average():
    """A penalty means the same in the first round and in the last."""
    model = AdaBoostRT(Mean(), rounds=4).fit(X, Y[:, 0])
    for learner in model.estimators_[0].models:
        assert learner.weights_.mean() == pytest.approx(1.0)


def test_every_output_is_boosted_by_itself():
    both = AdaBoostRT(Mean(), rounds=5).fit(X, Y)
    for k in range(2):
        alone = AdaBoostRT(Mean(), rounds=5).fit(X, Y[:, k])
        assert np.array_equal(both.predict(X)[:, k], alone.predict(X))


def test_boosting_what_takes_no_weights_is_refused():
    with pytest.raises(ValueError, match="RBFNetwork takes no sample weights; choose RandomLayer"):
        AdaBoostRT(RBFNetwork()).fit(X, Y)


class Spy(RegressorMixin, BaseEstimator):
    """Keeps what it is shown."""

    def fit(self, X, y):
        self.shown_ = X, y
        return self

    def predict(self, X):
        return X[:, :2]


def test_scaled_shows_inputs_and_targets_between_minus_one_and_one():
    model = Scaled(Spy()).fit(1e3 * X + 7.0, 5.0 * Y - 2.0)
    for shown in model.regressor_.shown_:
        np.testing.assert_allclose([shown.min(0), shown.max(0)], [[-1.0, -1.0], [1.0, 1.0]], atol=1e-12)
    low, high = (5.0 * Y - 2.0).min(0), (5.0 * Y - 2.0).max(0)
    first = (1e3 * X + 7.0)[:1]
    wanted = low + (high - low) * (model.regressor_.shown_[0][:1] + 1.0) / 2.0
    np.testing.assert_allclose(model.predict(first), wanted, rtol=1e-12)


def test_scaled_goes_on_only_where_its_regressor_does():
    assert hasattr(Scaled(RandomLayer()), "partial_fit")
    assert not hasattr(Scaled(LSSVR()), "partial_fit")
