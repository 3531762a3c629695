"""How long learners train, as ratios in one run, and what the papers' refinements are worth.

    python benchmarks/learners.py [--genetic] [--accuracy] [--seeds 20]

Training is at the papers' size: 100 samples, five features, two to four outputs, 20 nodes. Learners
take turns, and medians over the turns are compared. `--genetic` times GA-SVR at its full cost: 20
chromosomes, 200 generations, three outputs, five folds, on one process and on two. `--accuracy` asks
over seeds whether ERELM beats a single RELM and LS-SVR, and GA random and grid search at equal cost;
the intervals are 95 %, by resampling seeds.
"""

from __future__ import annotations

import argparse
import statistics
import time
import warnings
from collections.abc import Callable

import numpy as np
from scipy.stats import loguniform, uniform
from sklearn.exceptions import ConvergenceWarning
from sklearn.model_selection import GridSearchCV, KFold, RandomizedSearchCV
from sklearn.neural_network import MLPRegressor

from gapless.learners import make
from gapless.learners.genetic import GeneticSearchCV
from gapless.learners.nar import lagged
from gapless.learners.scaling import Scaled
from gapless.learners.svr import MeanLossSVR

Array = np.ndarray
TURNS, SAMPLES, FEATURES = 15, 100, 5
FAST = ("elm", "fourier_elm", "rvfl", "rvfl_ridge", "relm", "weighted_relm", "erelm", "ls_svr")
RANGES = {"gamma": (0.0, 1000.0), "C": (0.0, 500.0)}
"""The paper's, for inputs and targets in [-1, 1]."""


def problem(rng: np.random.Generator, outputs: int) -> tuple[Array, Array]:
    """Something smooth, of 100 samples, and noise."""
    x = rng.uniform(-1.0, 1.0, (SAMPLES, FEATURES))
    mix = rng.normal(size=(FEATURES, outputs))
    return x, np.sin(x @ mix) + 0.3 * x[:, :1] * x[:, 1:2] + 0.05 * rng.normal(size=(SAMPLES, outputs))


def training() -> None:
    """Milliseconds of a fit, and how many fit into one of the RBF network and of the MLPs."""
    print("training, ms (median of turns), and how many times faster than")
    print(f"{'learner':>14} {'outputs':>7} {'ms':>8} {'rbf':>7} {'mlp (L-BFGS)':>13} {'mlp (Adam)':>11}")
    for outputs in (2, 4):
        x, y = problem(np.random.default_rng(outputs), outputs)
        models = {name: make(name) for name in (*FAST, "by_part", "rbf", "mlp")}
        models["mlp (Adam)"] = Scaled(MLPRegressor(hidden_layer_sizes=(20,), random_state=0))
        seconds: dict[str, list[float]] = {name: [] for name in models}
        for _ in range(TURNS):
            for name, model in models.items():
                begin = time.perf_counter()
                model.fit(x, y)
                seconds[name].append(time.perf_counter() - begin)
        median = {name: statistics.median(times) for name, times in seconds.items()}
        for name, each in median.items():
            rbf, mlp, adam = (median[other] / each for other in ("rbf", "mlp", "mlp (Adam)"))
            print(f"{name:>14} {outputs:7d} {1e3 * each:8.2f} {rbf:7.1f} {mlp:13.1f} {adam:11.1f}")


def genetic() -> None:
    """Seconds of the full search, the stop rule off."""
    x, y = problem(np.random.default_rng(7), 3)
    print("\nGA-SVR, 20 chromosomes x 200 generations x 3 outputs x 5 folds, stop rule off")
    for jobs in (1, 2):
        search = make("ga_svr", {"tolerance": None, "n_jobs": jobs}, seed=1)
        begin, cpu = time.perf_counter(), time.process_time()
        search.fit(x, y)
        wall, cpu = time.perf_counter() - begin, time.process_time() - cpu
        fits = 5 * int(search.regressor_.evaluations_.sum())
        print(f"{jobs} process(es): {wall:.1f} s for {fits} fits (this process computed for {cpu:.1f} s)")


def interval(values: list[float]) -> str:
    """Geometric mean of ratios and its 95 % interval."""
    logs = np.log(values)
    means = np.random.default_rng(0).choice(logs, (4000, len(logs))).mean(axis=1)
    low, high = np.exp(np.quantile(means, [0.025, 0.975]))
    return f"{np.exp(logs.mean()):.3f} [{low:.3f}, {high:.3f}]"


def errors_of_an_ins(rng: np.random.Generator, n: int = 400, spikes: float = 0.0) -> Array:
    """Two channels that oscillate, wander and are noisy, as an INS error is; metres, at 1 Hz."""
    t = np.arange(n)
    drift = np.cumsum(np.cumsum(rng.normal(scale=0.002, size=(n, 2)), axis=0), axis=0)
    waves = rng.uniform(1.0, 3.0, 2) * np.sin(2 * np.pi * t[:, None] / rng.uniform(40, 120, 2))
    struck = rng.uniform(size=(n, 2)) < spikes
    return drift + waves + rng.normal(scale=0.1, size=(n, 2)) + struck * rng.normal(scale=2.0, size=(n, 2))


def held_out(model: object, train: tuple[Array, Array], test: tuple[Array, Array]) -> float:
    """RMS on samples not seen, each output by its own spread."""
    error = model.fit(*train).predict(test[0]) - test[1]  # type: ignore[attr-defined]
    return float(np.sqrt(np.mean((error / train[1].std(axis=0)) ** 2)))


def boosting(seeds: int) -> None:
    """Test RMS against a single RELM's: one step ahead in a series, and a smooth function."""
    print("\nRMS on held-out samples over that of RELM (less than 1 is better)")
    names = ("erelm", "weighted_relm", "ls_svr", "elm", "rvfl_ridge")
    print(f"{'data':>22} " + " ".join(f"{name:>22}" for name in names))

    def series(spikes: float) -> Callable[[np.random.Generator], tuple[Array, Array]]:
        return lambda rng: lagged(errors_of_an_ins(rng, 400, spikes), 5)

    kinds = {
        "series": series(0.0),
        "series, 3 % spikes": series(0.03),
        "function": lambda rng: problem(rng, 3),
    }
    for kind, drawn in kinds.items():
        ratios: dict[str, list[float]] = {name: [] for name in names}
        for seed in range(seeds):
            x, y = drawn(np.random.default_rng(seed))
            cut = 3 * len(x) // 4
            train, test = (x[:cut], y[:cut]), (x[cut:], y[cut:])
            single = held_out(make("relm", seed=seed), train, test)
            for name in names:
                ratios[name].append(held_out(make(name, seed=seed), train, test) / single)
        print(f"{kind:>22} " + " ".join(f"{interval(ratios[name]):>22}" for name in names))


def searching(seeds: int, generations: int = 10) -> None:
    """Cross-validated and test RMS of SVR as others tune it, over GA's at the same number of trials."""
    print(f"\nRMS of SVR over that of GA-SVR, both of 20 x {generations} trials; above 1, GA is better")
    folds = KFold(5)
    common = {"cv": folds, "scoring": "neg_root_mean_squared_error"}
    tables: dict[str, list[list[float]]] = {}
    for seed in range(seeds):
        x, y = problem(np.random.default_rng(100 + seed), 1)
        x_test = np.random.default_rng(seed).uniform(-1.0, 1.0, x.shape)
        y_test = truth(seed, x_test)
        settings = {"ranges": RANGES, "generations": generations, "tolerance": None, "cv": folds}
        ga = GeneticSearchCV(MeanLossSVR(), random_state=seed, **settings).fit(x, y[:, 0])
        trials = int(ga.evaluations_[0])
        side = round(np.sqrt(trials))
        steps = {name: np.linspace(high / side, high, side) for name, (_, high) in RANGES.items()}
        logs = {name: np.geomspace(high / 2**16, high, side) for name, (_, high) in RANGES.items()}
        drawn = {name: uniform(high / 2**16, high) for name, (_, high) in RANGES.items()}
        spread = {name: loguniform(high / 2**16, high) for name, (_, high) in RANGES.items()}
        others = {
            "random": RandomizedSearchCV(MeanLossSVR(), drawn, n_iter=trials, random_state=seed, **common),
            "random, log": RandomizedSearchCV(
                MeanLossSVR(), spread, n_iter=trials, random_state=seed, **common
            ),
            "grid": GridSearchCV(MeanLossSVR(), steps, **common),
            "grid, log": GridSearchCV(MeanLossSVR(), logs, **common),
        }
        score = np.sqrt(np.mean((ga.predict(x_test) - y_test) ** 2))
        same = GridSearchCV(MeanLossSVR(), {k: [v] for k, v in ga.best_params_[0].items()}, **common)
        mean = same.fit(x, y[:, 0]).best_score_  # of GA's choice, by the measure of the others
        for name, search in others.items():
            search.fit(x, y[:, 0])
            rms = np.sqrt(np.mean((search.predict(x_test) - y_test) ** 2))
            tables.setdefault(name, []).append([search.best_score_ / mean, rms / score])
    print(f"{'search':>14} {'cross-validated':>24} {'on new samples':>24}")
    for name, rows in tables.items():
        cross, new = np.array(rows).T
        print(f"{name:>14} {interval(list(cross)):>24} {interval(list(new)):>24}")


def truth(seed: int, x: Array) -> Array:
    """The function of `problem`, without its noise."""
    rng = np.random.default_rng(100 + seed)
    rng.uniform(-1.0, 1.0, (SAMPLES, FEATURES))
    mix = rng.normal(size=(FEATURES, 1))
    return (np.sin(x @ mix) + 0.3 * x[:, :1] * x[:, 1:2])[:, 0]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--genetic", action="store_true")
    parser.add_argument("--accuracy", action="store_true")
    parser.add_argument("--seeds", type=int, default=20)
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", ConvergenceWarning)
    training()
    if chosen.genetic:
        genetic()
    if chosen.accuracy:
        boosting(chosen.seeds)
        searching(chosen.seeds)


if __name__ == "__main__":
    main()
