"""AdaBoost.RT with a threshold that adapts: boosting for regression."""

from __future__ import annotations

from numbers import Real
from typing import Any, ClassVar, Final, NamedTuple, Self

import numpy as np
from sklearn.base import clone
from sklearn.utils import check_random_state
from sklearn.utils._param_validation import Integral, Interval

from gapless.learners.base import OutputByOutput, TakesWeights, answers, taught, weighable
from gapless.learners.random_layer import relm
from gapless.trip.recording import Array

_FLOOR: Final = 1e-6
"""Of the error rate, and of how far it stays below one: a log of zero says nothing."""


class Weighted(NamedTuple):
    """Models with shares that sum to one.

    Parameters
    ----------
    models : list of estimators
    shares : ndarray, shape (rounds,)
    """

    models: list[Any]
    shares: Array

    def predict(self, X: Array) -> Array:
        """Sum of the models' predictions by their shares.

        Parameters
        ----------
        X : ndarray, shape (n, m)

        Returns
        -------
        ndarray, shape (n,)
        """
        answer: Array = np.column_stack([answers(model, X) for model in self.models]) @ self.shares
        return answer


class AdaBoostRT(TakesWeights, OutputByOutput):
    """Modified AdaBoost.RT (Solomatine and Shrestha 2004; Tian and Mao 2010; georges2015, algorithm 2).

    For t = 1...rounds: fit with the sample distribution D_t; relative error e_i = |f_t(x_i) - y_i| / s,
    s the target's standard deviation, since targets cross zero; eps_t = sum of D_t where e_i > phi_t;
    beta_t = eps_t^power; D_{t+1} is D_t times beta_t where e_i <= phi_t, normalised. The output is
    sum log(1/beta_t) f_t / sum log(1/beta_t). With the t-th learner's RMSE, phi shrinks by 1 - lambda
    where that fell and grows by 1 + lambda where it rose, lambda = rate |change| / RMSE, but at most
    `rate`, so that phi stays positive whatever the fall (ours). eps_t is kept within 1e-6 of 0 and 1.

    Every output is boosted by itself: the threshold is defined for one target, a joint error would
    mix metres with metres a second, and a sample that is hard for one output is easy for another.
    RELMs with these weights are the ERELM of georges2015.

    Parameters
    ----------
    estimator : estimator, optional
        Takes sample weights; RELM if None.
    rounds : int
        The paper takes 20, and 50 at most.
    threshold : float
        phi_1, in standard deviations of the target.
    rate : float
        r, how fast the threshold adapts; 0 for the AdaBoost.RT of Solomatine and Shrestha.
    power : {1, 2, 3}
        n.
    random_state : int, RandomState or None
        Each learner is seeded from it.

    Attributes
    ----------
    estimators_ : list of Weighted
        One an output.
    thresholds_ : ndarray, shape (n_outputs_, rounds)
        phi_t.
    """

    _parameter_constraints: ClassVar[dict[str, Any]] = {
        "estimator": "no_validation",
        "rounds": [Interval(Integral, 1, 50, closed="both")],
        "threshold": [Interval(Real, 0.0, None, closed="neither")],
        "rate": [Interval(Real, 0.0, 1.0, closed="left")],
        "power": [Interval(Integral, 1, 3, closed="both")],
        "random_state": ["random_state"],
    }

    def __init__(
        self,
        estimator: Any = None,
        rounds: int = 20,
        threshold: float = 0.2,
        rate: float = 0.5,
        power: int = 1,
        random_state: Any = None,
    ) -> None:
        self.estimator = estimator
        self.rounds = rounds
        self.threshold = threshold
        self.rate = rate
        self.power = power
        self.random_state = random_state

    def _fit(self, X: Array, targets: Array, weight: Array) -> Self:
        base = weighable(relm() if self.estimator is None else self.estimator)
        rng = check_random_state(self.random_state)
        boosted = [self._boost(base, X, column, weight, rng) for column in targets.T]
        self.thresholds_ = np.array([thresholds for _, thresholds in boosted])
        self.estimators_ = [model for model, _ in boosted]
        return self

    def _boost(self, base: Any, X: Array, y: Array, weight: Array, rng: Any) -> tuple[Weighted, list[float]]:
        total = weight.sum()
        share = weight / total
        spread = float(np.sqrt(share @ (y - share @ y) ** 2)) or 1.0
        models, votes, thresholds, phi, last = [], [], [], self.threshold, 0.0
        for _ in range(self.rounds):
            model = taught(_seeded(base, rng), X, y, total * share)
            error = np.abs(answers(model, X) - y) / spread
            rate = np.clip(share[error > phi].sum(), _FLOOR, 1.0 - _FLOOR)
            beta = rate**self.power
            share = np.where(error > phi, share, beta * share)
            share = share / share.sum()
            models.append(model)
            votes.append(np.log(1.0 / beta))
            thresholds.append(phi)
            rmse = float(np.sqrt(weight @ error**2 / total))
            phi, last = phi * (self._change(rmse, last) if models[1:] else 1.0), rmse
        return Weighted(models, np.array(votes) / np.sum(votes)), thresholds

    def _change(self, rmse: float, last: float) -> float:
        """1 - lambda or 1 + lambda."""
        if rmse == last:
            return 1.0
        size = min(self.rate * abs(rmse - last) / rmse, self.rate) if rmse else self.rate
        return 1.0 - size if rmse < last else 1.0 + size


def _seeded(base: Any, rng: Any) -> Any:
    """A fresh copy; everything in it that is random gets a seed of its own."""
    model = clone(base)
    names = sorted(name for name in model.get_params() if name.split("__")[-1] == "random_state")
    return model.set_params(**{name: int(rng.randint(2**31 - 1)) for name in names})


def erelm() -> AdaBoostRT:
    """ERELM: modified AdaBoost.RT over 20 RELMs (georges2015, section 3.4).

    Returns
    -------
    AdaBoostRT
    """
    return AdaBoostRT(relm())
