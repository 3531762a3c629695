"""Search of parameters by a genetic algorithm (tan2015, section 3.2)."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any, ClassVar, Self

import numpy as np
from sklearn.base import clone
from sklearn.model_selection import check_cv
from sklearn.utils import check_random_state
from sklearn.utils._param_validation import Integral, Interval
from sklearn.utils.parallel import Parallel

from gapless.learners.base import OutputByOutput
from gapless.learners.evolution import Bits, decoded, next_generation
from gapless.learners.fitness import Fitness
from gapless.learners.svr import MeanLossSVR
from gapless.trip.recording import Array


class GeneticSearchCV(OutputByOutput):
    """Parameters that make the cross-validated RMS small, found by evolution.

    Chromosomes are Gray codes of `bits` bits a parameter. Each generation is ranked by RMS, selected
    by roulette, crossed at one point and mutated bit by bit; it ends when the best RMS of two
    successive generations differs by less than `tolerance`, or after `generations`. Nobody is kept by
    right: the paper has no elitism. The best chromosome ever seen wins, and the estimator is fitted
    with it to all samples. Every output is searched by itself, as in the paper's Table 2. A chromosome
    that comes again is not fitted again, and the same seed gives the same bits whatever `n_jobs`.

    Parameters
    ----------
    estimator : estimator, optional
        SVR with the paper's C if None.
    ranges : mapping of str to (low, high), optional
        For each parameter, of which high can be reached and low cannot; the paper's if None.
    population : int
    generations : int
        At most.
    bits : int
        A parameter.
    pressure : float
        sp of the ranking: how many offspring the best is expected to have.
    crossover : float
        Probability a pair.
    mutation : float
        Probability a bit.
    tolerance : float or None
        Of the stop rule, in units of the target; None never stops early.
    cv : int or splitter
        Folds.
    n_jobs : int, optional
        Processes.
    random_state : int, RandomState or None

    Attributes
    ----------
    estimators_ : list of estimators
        One an output, fitted with the best parameters.
    best_params_ : list of dict
    best_rms_ : ndarray, shape (n_outputs_,)
    evaluations_ : ndarray, shape (n_outputs_,)
        Chromosomes that were fitted.
    history_ : list of ndarray, shape (generations run, 2)
        Best and mean RMS of every generation.
    """

    RANGES: ClassVar[dict[str, tuple[float, float]]] = {"gamma": (0.0, 1000.0), "C": (0.0, 500.0)}

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "estimator": "no_validation",
        "ranges": [Mapping, None],
        "population": [Interval(Integral, 2, None, closed="left")],
        "generations": [Interval(Integral, 1, None, closed="left")],
        "bits": [Interval(Integral, 1, 52, closed="both")],
        "pressure": [Interval(Real, 1.0, 2.0, closed="both")],
        "crossover": [Interval(Real, 0.0, 1.0, closed="both")],
        "mutation": [Interval(Real, 0.0, 1.0, closed="both")],
        "tolerance": [Interval(Real, 0.0, None, closed="neither"), None],
        "cv": ["cv_object"],
        "n_jobs": [Integral, None],
        "random_state": ["random_state"],
    }

    def __init__(
        self,
        estimator: Any = None,
        ranges: Mapping[str, tuple[float, float]] | None = None,
        population: int = 20,
        generations: int = 200,
        bits: int = 16,
        pressure: float = 2.0,
        crossover: float = 0.7,
        mutation: float = 0.05,
        tolerance: float | None = 0.001,
        cv: Any = 5,
        n_jobs: int | None = None,
        random_state: Any = None,
    ) -> None:
        self.estimator = estimator
        self.ranges = ranges
        self.population = population
        self.generations = generations
        self.bits = bits
        self.pressure = pressure
        self.crossover = crossover
        self.mutation = mutation
        self.tolerance = tolerance
        self.cv = cv
        self.n_jobs = n_jobs
        self.random_state = random_state

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        rng = check_random_state(self.random_state)
        base = MeanLossSVR() if self.estimator is None else self.estimator
        models, found = [], []
        with Parallel(n_jobs=self.n_jobs) as pool:
            for column in targets.T:
                folds = list(check_cv(self.cv).split(X, column))
                fitness = Fitness(base, X, column, folds, pool)
                found.append(self._search(fitness, rng))
                models.append(clone(base).set_params(**found[-1][0]).fit(X, column))
        self.best_params_ = [params for params, *_ in found]
        self.best_rms_ = np.array([rms for _, rms, *_ in found])
        self.evaluations_ = np.array([count for *_, count, _ in found])
        self.history_ = [history for *_, history in found]
        self.estimators_ = models
        return self

    def _search(self, fitness: Fitness, rng: Any) -> tuple[dict[str, float], float, int, Array]:
        """Best parameters, their RMS, how many were tried, and best and mean RMS by generation."""
        ranges = self.RANGES if self.ranges is None else self.ranges
        people: Bits = rng.randint(0, 2, (self.population, self.bits * len(ranges))).astype(np.uint8)
        seen: dict[bytes, tuple[float, dict[str, float]]] = {}
        history: list[tuple[float, float]] = []
        while True:
            new = {person.tobytes(): person for person in people if person.tobytes() not in seen}
            tried = [decoded(person, ranges) for person in new.values()]
            seen.update(zip(new, zip(fitness(tried), tried, strict=True), strict=True))
            rms = np.array([seen[person.tobytes()][0] for person in people])
            history.append((float(rms.min()), float(rms.mean())))
            if len(history) == self.generations or self._settled(history):
                break
            people = next_generation(people, rms, self.pressure, self.crossover, self.mutation, rng)
        best_rms, params = min(seen.values(), key=lambda entry: entry[0])
        return params, best_rms, len(seen), np.array(history)

    def _settled(self, history: list[tuple[float, float]]) -> bool:
        if self.tolerance is None or len(history) < 2:
            return False
        return abs(history[-1][0] - history[-2][0]) < self.tolerance


def ga_svr() -> GeneticSearchCV:
    """GA-SVR: gamma in (0, 1000] and C in (0, 500] by evolution (tan2015).

    Returns
    -------
    GeneticSearchCV
    """
    return GeneticSearchCV(MeanLossSVR())
