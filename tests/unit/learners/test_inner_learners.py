"""Learners within learners: the same answers without the checks, and machines like the library's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sklearn.linear_model import Ridge

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


def test_any_learner_can_be_searched():
    search = GeneticSearchCV(RBFNetwork(5, random_state=0), {"penalty": (0.0, 1.0)}, 4, 2, random_state=0)
    assert np.isfinite(search.fit(X, Y).best_rms_).all()
