"""What holds for every learner: scikit-learn's own contract, seeds, shapes, units, saving."""

from unittest import SkipTest

import numpy as np
import pytest
from sklearn.utils.estimator_checks import estimator_checks_generator
from sklearn.utils.validation import has_fit_parameter

from gapless.learners import LEARNERS, make
from gapless.learners.adaboost_rt import AdaBoostRT
from gapless.learners.nar import NAR
from gapless.learners.per_output import PerOutput
from gapless.learners.random_layer import RandomLayer
from gapless.learners.saved import dumps, loads
from gapless.learners.weighting import ResidualWeighted

SMALL = {
    "ga_svr": {"population": 4, "generations": 2, "ranges": {"gamma": (0.0, 0.2), "C": (0.0, 500.0)}},
    "erelm": {"rounds": 3},
    "mlp": {"max_iter": 15},
}
"""The same methods on a smaller budget: the checks fit each some hundred times."""
LIBRARY = ["sklearn.linear_model.Ridge", "sklearn.svm.SVR"]
"""One with several outputs and one with a single one."""

NAMES = [*LEARNERS, *LIBRARY]


def small(name, seed=1):
    return make(name, SMALL.get(name), seed)


def samples(outputs, seed=0, n=60):
    """Inputs and targets in units of their own, far from [-1, 1]."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-3.0, 30.0, (n, 4))
    y = np.column_stack([5e3 + 20.0 * x[:, 0], 1e-3 * np.sin(x[:, 1] / 10.0), x[:, 2] - x[:, 3]])
    return x, y[:, 0] if outputs == 0 else y[:, :outputs]


CHECKED = {name: small(name) for name in NAMES}
CHECKED |= {f"{name} alone": small(name).regressor for name in LEARNERS}
CHECKED |= {
    "AdaBoostRT of weighted RELM": AdaBoostRT(ResidualWeighted(RandomLayer(penalty=1e-3)), rounds=3),
    "NAR": NAR(make("relm"), order=1),
    "NAR, auto": NAR(make("relm"), order="auto"),
    "NAR of RBF networks": NAR(make("rbf"), order=2),
    "PerOutput": PerOutput(),
    "ByPart of Ridge, one column each": make(
        "by_part", {"estimator": "sklearn.linear_model.Ridge", "width": 1}
    ).regressor,
}


@pytest.mark.filterwarnings("ignore")  # the checks feed what a user would be warned of
@pytest.mark.parametrize("name", CHECKED)
def test_scikit_learns_contract(name):
    failed = []
    for estimator, check in estimator_checks_generator(CHECKED[name]):
        try:
            check(estimator)
        except SkipTest:  # of array libraries that are not here
            continue
        except Exception as error:
            failed.append(f"{check.func.__name__}: {error!s:.200}")
    assert not failed, "\n".join(failed)


@pytest.mark.parametrize("outputs", [0, 1, 3])
@pytest.mark.parametrize("name", NAMES)
def test_predictions_have_the_shape_of_the_targets(name, outputs):
    x, y = samples(outputs)
    assert small(name).fit(x, y).predict(x[:7]).shape == y[:7].shape


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_gives_the_same_bits_and_another_others(name):
    x, y = samples(2)
    first, second = (small(name, 7).fit(x, y).predict(x) for _ in range(2))
    assert np.array_equal(first, second)
    if any("random_state" in key for key in small(name).get_params()) and name not in LIBRARY:
        assert not np.array_equal(first, small(name, 8).fit(x, y).predict(x))


@pytest.mark.parametrize("name", NAMES)
def test_units_do_not_matter(name):
    """Metres or kilometres, each column its own: the same predictions, in the other unit."""
    x, y = samples(3)
    factor = np.array([2.0, 0.25, 8.0, 4.0])  # powers of two: rounding is the same
    there = small(name).fit(x, y).predict(x)
    here = small(name).fit(x * factor, y * 2.0).predict(x * factor)
    # what rounding leaves is blown up by iterations at most, and by singular values near the cut
    np.testing.assert_allclose(here, 2.0 * there, rtol=1e-6, atol=1e-6 * np.ptp(y, axis=0).min())


@pytest.mark.parametrize("name", NAMES)
def test_a_plain_relation_is_learned(name):
    """Better than the mean by far on samples not seen; a floor that a broken learner does not reach."""
    rng = np.random.default_rng(3)
    x = rng.uniform(-1.0, 1.0, (150, 2))
    y = np.column_stack([1.0 + x[:, 0] + 0.5 * x[:, 1], 0.3 * x[:, 0] - x[:, 1]])
    model = small(name).fit(x[:100], y[:100])
    least = 0.6 if name == "fourier_elm" else 0.9  # waves in random directions are no planes
    assert model.score(x[100:], y[100:]) > least


@pytest.mark.parametrize("outputs", [0, 2])
@pytest.mark.parametrize("name", NAMES)
def test_a_saved_learner_predicts_the_same_bits(name, outputs):
    x, y = samples(outputs)
    model = small(name).fit(x, y)
    again = loads(dumps(model), n_features=4)
    other = samples(outputs, seed=1)[0]
    assert np.array_equal(again.predict(other), model.predict(other))
    assert dumps(again) == dumps(model)


# the MLP goes on by steps that depend on the order
@pytest.mark.parametrize("name", [n for n in NAMES if hasattr(small(n), "partial_fit")])
def test_samples_one_by_one_or_all_at_once_give_the_same(name):
    """From the first samples on, whose bounds and periods are kept."""
    x, y = samples(2)
    once, pieces = (small(name).partial_fit(x[:20], y[:20]) for _ in range(2))
    once.partial_fit(x[20:], y[20:])
    for rows in np.split(np.arange(20, len(x)), [1, 2, 15]):
        pieces.partial_fit(x[rows], y[rows])
    # two orders of the same QR: rounding, times the condition of the hidden layer (1e6 and more)
    span = np.ptp(y, axis=0)
    np.testing.assert_allclose(pieces.predict(x) / span, once.predict(x) / span, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    "name", [n for n in LEARNERS if has_fit_parameter(small(n).regressor, "sample_weight")]
)
def test_a_weight_of_two_is_a_sample_twice(name):
    x, y = samples(0)
    weight = np.random.default_rng(5).integers(0, 3, len(x)).astype(float)
    learner = small(name).regressor
    x, y = x / 30.0, (y - y.mean()) / np.ptp(y)
    weighted = learner.fit(x, y, sample_weight=weight).predict(x)
    repeated = learner.fit(np.repeat(x, weight.astype(int), 0), np.repeat(y, weight.astype(int))).predict(x)
    np.testing.assert_allclose(weighted, repeated, atol=1e-6)  # rounding, as above
