"""The judge: from rehearsed outages to who may speak, how the filter is tuned, and how sure it is.

Rehearsals lie closer together than they last, and a drive's minutes resemble each other: three count as
one. Ratios are logarithms of the largest error against the same outage without, both with the error of
the track that they are held against: nobody is judged on centimetres.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

REFERENCE: Final = 2.0
"""Standard deviation of the aided track, by axis: errors that fixes share [m]."""
TOGETHER: Final = 3.0
"""So many rehearsals count as one independent one."""
AGREE: Final = 2
"""Rehearsals in which a bridge must be clearly better: one lucky one earns nothing."""
CONFIDENCE: Final = 0.5
"""Standard errors by which a bridge must be better, one-sided."""
CLEAR: Final = 0.05
"""Log ratios nearer to zero are ties: the car stood."""
PRIOR: Final = 5.0
"""Rehearsals without any difference that every candidate is mixed with."""
SCATTER: Final = 0.5
"""Standard deviation of a log ratio before there are any: counts as `PRIOR_SCATTER` rehearsals."""
PRIOR_SCATTER: Final = 2.0
ELLIPSE: Final = 5.991
"""95 % quantile of chi-square of two degrees of freedom."""
AGES: Final = 10.0
"""Errors are held against their ellipses so far apart [s]."""
CALIBRATION: Final = 12.0
"""Ellipses that hold 95 % which the rehearsed ones are mixed with."""


class Trial(NamedTuple):
    """One candidate in one rehearsed outage.

    Parameters
    ----------
    bridge, preset : str
        Who spoke, how the filter was tuned; "" for nobody, and for the recipe's own tuning.
    worst : float
        Largest horizontal distance from the aided track [m].
    nees : tuple of float
        Squared Mahalanobis distances of the horizontal position, `AGES` apart, as the filter states them.
    """

    bridge: str
    preset: str
    worst: float
    nees: tuple[float, ...]


class Rehearsed(NamedTuple):
    """One outage that was rehearsed.

    Parameters
    ----------
    start, end : float
        [s]
    trials : tuple of Trial
        The first is that of nobody and no preset.
    """

    start: float
    end: float
    trials: tuple[Trial, ...]


class Score(NamedTuple):
    """What is known of a candidate.

    Parameters
    ----------
    name : str
    trials : int
        Rehearsals.
    mean : float
        Of its log ratios, mixed with `PRIOR` zeros.
    error : float
        Standard error of the mean.
    earned : bool
        Whether it is better by `CONFIDENCE` of these, and clearly better in no fewer than `AGREE` and in
        more than it is clearly worse in.
    """

    name: str
    trials: int
    mean: float
    error: float
    earned: bool

    @property
    def text(self) -> str:
        """One clause for a summary."""
        if not self.trials:
            return "not rehearsed yet"
        low, high = (math.exp(self.mean + k * self.error) for k in (-1.0, 1.0))
        return (
            f"{math.exp(self.mean):.2f} times the error [{low:.2f}, {high:.2f}] in {self.trials} rehearsals"
        )


class Choice(NamedTuple):
    """What the next outage is met with.

    Parameters
    ----------
    bridge, preset : str
    scale : float
        Factor on the covariance of the position that is stated.
    bridges, presets : tuple of Score
        Of all candidates.
    """

    bridge: str
    preset: str
    scale: float
    bridges: tuple[Score, ...]
    presets: tuple[Score, ...]


def choose(history: Sequence[Rehearsed], bridges: Iterable[str], presets: Iterable[str]) -> Choice:
    """Who may speak and how the filter is tuned: the best of those that have earned it.

    Parameters
    ----------
    history : sequence of Rehearsed
    bridges, presets : iterable of str
        The candidates, besides nobody and no preset.

    Returns
    -------
    Choice
    """
    heard = tuple(judged(b, [r for one in history for r in _against_nobody(one, b)]) for b in bridges)
    tuned = tuple(judged(p, [r for one in history for r in _against_plain(one, p)]) for p in presets)
    bridge, preset = best(heard), best(tuned)
    return Choice(bridge, preset, calibrated(history, bridge, preset), heard, tuned)


def judged(name: str, ratios: Sequence[float]) -> Score:
    """What log ratios say of a candidate.

    Parameters
    ----------
    name : str
    ratios : sequence of float

    Returns
    -------
    Score
    """
    n = len(ratios)
    if not n:
        return Score(name, 0, 0.0, SCATTER, False)
    x = np.asarray(ratios)
    squares = float(((x - x.mean()) ** 2).sum()) + PRIOR_SCATTER * SCATTER**2
    error = math.sqrt(squares / (n - 1 + PRIOR_SCATTER) / max(1.0, n / TOGETHER))
    won, lost = int((x < -CLEAR).sum()), int((x > CLEAR).sum())
    earned = won >= AGREE and won > lost and float(x.mean()) + CONFIDENCE * error < 0.0
    return Score(name, n, float(x.sum()) / (n + PRIOR), error, earned)


def best(scores: Sequence[Score]) -> str:
    """The candidate with the smallest mean of those that have earned it.

    Parameters
    ----------
    scores : sequence of Score

    Returns
    -------
    str
        "" where nobody has.
    """
    earned = [score for score in scores if score.earned]
    return min(earned, key=lambda score: score.mean).name if earned else ""


def calibrated(history: Sequence[Rehearsed], bridge: str, preset: str) -> float:
    """Factor on the stated covariance with which 95 % ellipses would have held 95 %.

    Parameters
    ----------
    history : sequence of Rehearsed
    bridge, preset : str
        As the next outage is met.

    Returns
    -------
    float
        1 where there is nothing to tell by.
    """
    exact = [t.nees for one in history for t in one.trials if (t.bridge, t.preset) == (bridge, preset)]
    like = exact if len(exact) >= 3 else [t.nees for one in history for t in one.trials if t.bridge == bridge]
    found = np.array([x for nees in like for x in nees])
    if not len(found):
        return 1.0
    scale = float(np.quantile(found, 0.95)) / ELLIPSE
    share = len(like) / (len(like) + CALIBRATION)
    return max(1.0, math.exp(share * math.log(max(scale, 1e-6))))


def _log_ratio(a: Trial, b: Trial) -> float:
    known = math.sqrt(2.0) * REFERENCE
    return math.log(math.hypot(a.worst, known) / math.hypot(b.worst, known))


def _against_nobody(one: Rehearsed, name: str) -> list[float]:
    return [_log_ratio(t, one.trials[0]) for t in one.trials if t.bridge == name and not t.preset]


def _against_plain(one: Rehearsed, name: str) -> list[float]:
    plain = {t.bridge: t for t in one.trials if not t.preset}
    return [_log_ratio(t, plain[t.bridge]) for t in one.trials if t.preset == name and t.bridge in plain]
