"""Learners within learners: the same answers without the checks, and machines like the library's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sklearn.linear_model import Ridge
from sklearn.svm import SVR

from gapless.learners.base import answers, taught
from gapless.learners.genetic import GeneticSearchCV
from gapless.learners.rbf import RBFNetwork
from gapless.learners.svr import MeanLossSVR

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (50, 3))
Y = np.sin(3.0 * X[:, 0]) + X[:, 1] * X[:, 2]
MODELS = [lambda: RBFNetwork(5, random_state=0), lambda: MeanLossSVR(10.0, 2.0), Ridge]


@pytest.mark.parametrize("make", MODELS)
def test_what_is_taught_without_checks_answers_the_same(make):
    assert np.array_equal(answers(taught(make(), X, Y), X), make().fit(X, Y).predict(X))


def test_and_so_with_weights():
    weight = RNG.uniform(0.5, 2.0, len(X))
    ours = taught(RBFNetwork(5, random_state=0), X, Y, weight)
    assert not np.array_equal(ours.predict(X), RBFNetwork(5, random_state=0).fit(X, Y).predict(X))
    assert_allclose(taught(Ridge(), X, Y, weight).coef_, Ridge().fit(X, Y, sample_weight=weight).coef_)


@pytest.mark.parametrize(("c", "gamma"), [(10.0, 0.5), (500.0, 900.0), (1.0, 3.0)])
def test_a_machine_is_the_library_s_with_c_over_l(c, gamma):
    ours = MeanLossSVR(c, gamma, 0.01).fit(X, Y)
    theirs = SVR(C=c / len(X), gamma=gamma, epsilon=0.01).fit(X, Y)
    assert np.array_equal(ours.estimators_[0].dual_coef_, theirs.dual_coef_)  # one LIBSVM
    # two sums of fifty kernel values of up to c / l
    assert_allclose(ours.predict(X), theirs.predict(X), rtol=0.0, atol=1e-9)


def test_any_learner_can_be_searched():
    search = GeneticSearchCV(RBFNetwork(5, random_state=0), {"penalty": (0.0, 1.0)}, 4, 2, random_state=0)
    assert np.isfinite(search.fit(X, Y).best_rms_).all()
