"""The genetic search: its operators against what they are for, and the search as a whole."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.linear_model import Ridge
from sklearn.model_selection import KFold, cross_val_predict
from sklearn.svm import SVR

from gapless.learners.evolution import binary, decoded, next_generation, ranked
from gapless.learners.genetic import GeneticSearchCV
from gapless.learners.svr import MeanLossSVR

RNG = np.random.default_rng(0)
X = RNG.uniform(-1.0, 1.0, (40, 2))
Y = np.column_stack([np.sin(2.0 * X[:, 0]), X[:, 1] ** 2]) + 0.05 * RNG.normal(size=(40, 2))
SMALL = {"population": 6, "generations": 4, "random_state": 3}


def gray(number, bits=16):
    """The textbook's: n XOR n/2."""
    return np.array(list(np.binary_repr(number ^ (number >> 1), bits)), dtype=np.uint8)


@given(st.integers(0, 2**16 - 1))
def test_gray_code(number):
    assert int("".join(map(str, binary(gray(number)))), 2) == number
    if number:
        assert np.sum(gray(number) != gray(number - 1)) == 1


def test_a_range_is_reached_above_and_not_below():
    ranges = {"gamma": (0.0, 1000.0), "C": (10.0, 20.0)}
    least = decoded(np.concatenate([gray(0), gray(0)]), ranges)
    most = decoded(np.concatenate([gray(2**16 - 1), gray(2**16 - 1)]), ranges)
    assert least == {"gamma": 1000.0 / 2**16, "C": 10.0 + 10.0 / 2**16}
    assert most == {"gamma": 1000.0, "C": 20.0}


def test_ranking_is_linear():
    fitness = ranked(np.array([0.3, 0.1, 0.2, 0.9, 0.5]), 1.8)
    np.testing.assert_allclose(fitness, [1.0, 1.8, 1.4, 0.2, 0.6])
    assert fitness.sum() == pytest.approx(5.0)


def test_selection_follows_the_ranking():
    people = np.eye(10, dtype=np.uint8)
    rms = np.arange(10.0)
    rng = np.random.RandomState(0)
    chosen = sum(next_generation(people, rms, 1.5, 0.0, 0.0, rng).sum(axis=0) for _ in range(4000))
    # 40,000 draws: a deviation of sqrt(np(1-p)) = 60 at most for each; five of them
    np.testing.assert_allclose(chosen, 4000 * ranked(rms, 1.5), atol=300)


def test_crossover_exchanges_the_ends_of_a_pair():
    people = np.array([[0] * 16, [1] * 16] * 50, dtype=np.uint8)
    children = next_generation(people, np.ones(100), 1.0, 1.0, 0.0, np.random.RandomState(1))
    changes = np.abs(np.diff(children.astype(int), axis=1)).sum(axis=1)
    assert changes.max() == 1  # one point
    assert 20 < np.sum(changes) < 80  # half of the pairs are of two kinds: 50 children, a deviation of 7
    points = np.abs(np.diff(children.astype(int), axis=1)).argmax(axis=1)[changes == 1]
    assert len(set(points)) > 5


def test_mutation_flips_as_many_bits_as_it_should():
    people = np.zeros((100, 200), dtype=np.uint8)
    mutated = next_generation(people, np.ones(100), 2.0, 0.7, 0.05, np.random.RandomState(2))
    assert abs(mutated.sum() - 1000) < 150  # binomial: a deviation of 31


def test_fitness_is_the_cross_validated_rms():
    """Every chromosome of the first generation, by scikit-learn's own cross validation."""
    model = GeneticSearchCV(SVR(), {"C": (0.0, 10.0)}, population=5, generations=1, random_state=0).fit(
        X, Y[:, 0]
    )
    people = np.random.RandomState(0).randint(0, 2, (5, 16)).astype(np.uint8)
    rms = []
    for person in people:
        predicted = cross_val_predict(SVR(**decoded(person, {"C": (0.0, 10.0)})), X, Y[:, 0], cv=KFold(5))
        rms.append(np.sqrt(np.mean((predicted - Y[:, 0]) ** 2)))
    np.testing.assert_allclose(model.history_[0], [[min(rms), np.mean(rms)]], rtol=1e-12)
    assert model.best_rms_[0] == pytest.approx(min(rms))
    assert model.best_params_[0] == decoded(people[np.argmin(rms)], {"C": (0.0, 10.0)})


def test_folds_of_the_papers_svr_divide_c_by_their_own_number():
    ranges = {"gamma": (0.0, 2.0), "C": (0.0, 500.0)}
    model = GeneticSearchCV(MeanLossSVR(), ranges, population=2, generations=1, random_state=1).fit(
        X, Y[:, 0]
    )
    best = model.best_params_[0]
    theirs = SVR(C=best["C"] / 32, gamma=best["gamma"], epsilon=0.001)  # 40 samples in five folds
    predicted = cross_val_predict(theirs, X, Y[:, 0], cv=KFold(5))
    # two solvers, each within 1e-3 of the optimum
    assert model.best_rms_[0] == pytest.approx(np.sqrt(np.mean((predicted - Y[:, 0]) ** 2)), abs=1e-3)


class Counted(Ridge):
    """Counts its fits."""

    fits = 0

    def fit(self, X, y):
        Counted.fits += 1
        return super().fit(X, y)


def test_a_chromosome_that_comes_again_is_not_fitted_again():
    Counted.fits = 0
    settings = {"population": 20, "generations": 30, "bits": 4, "tolerance": None, "random_state": 0}
    model = GeneticSearchCV(Counted(), {"alpha": (0.0, 8.0)}, **settings).fit(X, Y[:, 0])
    assert Counted.fits == 5 * model.evaluations_[0] + 1
    assert model.evaluations_[0] <= 16  # there are no more
    assert len(model.history_[0]) == 30


def test_both_cores_give_the_same_bits():
    one, two = (GeneticSearchCV(n_jobs=jobs, tolerance=None, **SMALL).fit(X, Y) for jobs in (None, 2))
    assert one.best_params_ == two.best_params_
    assert np.array_equal(one.predict(X), two.predict(X))
    assert all(np.array_equal(a, b) for a, b in zip(one.history_, two.history_, strict=True))


def test_it_stops_where_the_best_moves_no_more():
    model = GeneticSearchCV(Ridge(), {"alpha": (0.0, 1.0)}, tolerance=0.1, random_state=0).fit(X, Y)
    for history in model.history_:  # alpha hardly matters here: the second generation is like the first
        assert len(history) == 2
    forever = GeneticSearchCV(Ridge(), {"alpha": (0.0, 1.0)}, tolerance=None, **SMALL).fit(X, Y)
    assert all(len(history) == 4 for history in forever.history_)


def test_the_best_ever_seen_wins_whatever_became_of_it():
    model = GeneticSearchCV(tolerance=None, mutation=0.5, **SMALL).fit(X, Y)
    for k, history in enumerate(model.history_):
        assert model.best_rms_[k] == history[:, 0].min()
        assert np.all(history[:, 0] <= history[:, 1])


class Plane(RegressorMixin, BaseEstimator):
    """Learns nothing: what it predicts is its parameters."""

    def __init__(self, a=0.0, b=0.0):
        self.a = a
        self.b = b

    def fit(self, X, y):
        return self

    def predict(self, X):
        return X @ [self.a, self.b]


@pytest.mark.parametrize("seed", range(5))
def test_evolution_finds_what_chance_does_not(seed):
    """A population is worth more than the first one, and its best more than as many random tries."""
    ranges = {"a": (-100.0, 100.0), "b": (-100.0, 100.0)}
    y = X @ [37.0, -59.0]
    model = GeneticSearchCV(Plane(), ranges, generations=100, tolerance=None, random_state=seed).fit(X, y)
    history = model.history_[0]
    assert history[-20:, 1].mean() < 0.7 * history[0, 1]
    rng = np.random.default_rng(seed)
    tries = X @ rng.uniform(-100.0, 100.0, (2, model.evaluations_[0]))
    assert model.best_rms_[0] < np.sqrt(np.mean((tries - y[:, None]) ** 2, axis=0)).min()
