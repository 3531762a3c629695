"""How sure a bridge is of what it says: as its paper has it, or from what it got wrong before."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from gapless.bridges.epochs import Epoch
from gapless.bridges.model import Model, Predict, go_on
from gapless.trip.recording import Array

ATTITUDE: Final = np.eye(3) * np.deg2rad(1.0) ** 2
"""Noise of a predicted attitude, which no fix states one for [rad^2]; our choice."""


CHI_SQUARE_95: Final = 3.84
"""95 % quantile of chi-square of one degree: calibrated bounds hold so many of the held-out misses."""


class Missed(NamedTuple):
    """What a bridge got wrong in one epoch of a rehearsed outage.

    Parameters
    ----------
    age : float
        Since the rehearsed outage began [s].
    wrong : dict of str to ndarray
        By part.
    """

    age: float
    wrong: dict[str, Array]


@dataclass(frozen=True)
class FilterNoise:
    """The papers': a pseudo-fix is as good as the last fix, however long ago that was."""

    held_out: float = 0.0

    @property
    def text(self) -> str:
        """What a summary says of it."""
        return "as sure as the last fix"

    def fitted(self, missed: Sequence[Missed]) -> FilterNoise:
        """Nothing to fit.

        Parameters
        ----------
        missed : sequence of Missed

        Returns
        -------
        FilterNoise
        """
        return self

    def of(self, part: str, size: int, heard: Mapping[str, Array], age: float, count: int) -> Array | None:
        """R of a part.

        Parameters
        ----------
        part : str
        size : int
            Its dimension.
        heard : mapping of str to ndarray
            R of the last reading of each channel.
        age : float
            Of the outage [s].
        count : int
            How often the bridge has spoken in it, this time included.

        Returns
        -------
        ndarray, shape (size, size), or None
            None where nothing is known of it: then it is not said.
        """
        r = heard.get(part, ATTITUDE if part == "attitude" else None)
        return None if r is None else r[:size, :size]


@dataclass(frozen=True)
class CalibratedNoise:
    """From held-out residuals and the age of the outage: variance a + b age^2, at least that of a fix.

    What a bridge gets wrong lasts through an outage, so its k-th word is worth the k-th part: variances
    are multiplied by the count. A filter that took them for independent would be sure of a bias.

    Parameters
    ----------
    growth : dict of str to (float, float)
        a [unit^2] and b [unit^2/s^2] by part, after fitting.
    held_out : float
        Share of the epochs that is kept from the training to calibrate with.
    """

    growth: Mapping[str, tuple[float, float]] | None = None
    held_out: float = 0.4

    @property
    def text(self) -> str:
        """What a summary says of it."""
        if self.growth is None:
            return "too little was held out to calibrate with: it says nothing"
        grown = {name: (math.sqrt(a), math.sqrt(b)) for name, (a, b) in sorted(self.growth.items())}
        return "calibrated: " + ", ".join(f"{name} {a:.2g} + {b:.2g}/s" for name, (a, b) in grown.items())

    def fitted(self, missed: Sequence[Missed]) -> CalibratedNoise:
        """Growth of what was wrong.

        Parameters
        ----------
        missed : sequence of Missed

        Returns
        -------
        CalibratedNoise
            Without growth, and so with nothing to say, where fewer than five are known.
        """
        names = {name for m in missed for name in m.wrong}
        found = {}
        for name in names:
            rows = [
                (m.age, float(np.mean(m.wrong[name] ** 2)))
                for m in missed
                if np.isfinite(m.wrong[name]).all()
            ]
            if len(rows) >= 5:
                found[name] = _growth(np.array(rows))
        return CalibratedNoise(found or None, self.held_out)

    def of(self, part: str, size: int, heard: Mapping[str, Array], age: float, count: int) -> Array | None:
        """R of a part; see `FilterNoise.of`."""
        if self.growth is None or part not in self.growth:
            return None
        a, b = self.growth[part]
        least = FilterNoise().of(part, size, heard, age, count)
        floor = np.zeros((size, size)) if least is None else least
        return np.asarray((floor + (a + b * age * age) * np.eye(size)) * count)


Noise = FilterNoise | CalibratedNoise


def _growth(rows: Array) -> tuple[float, float]:
    """Least squares of a + b age^2 on squared residuals, each relative to its age's, both >= 0.

    Squares scatter as their own mean, so rows are weighed by the inverse of a first fit.
    """
    age2, squares = rows[:, 0] ** 2, rows[:, 1]
    weight = np.ones(len(rows))
    a = b = 0.0
    for _ in range(3):
        m = np.column_stack([np.ones(len(rows)), age2]) * weight[:, None]
        a, b = (float(c) for c in np.linalg.lstsq(m, squares * weight, rcond=None)[0])
        if b < 0.0:
            a, b = float(np.average(squares, weights=weight)), 0.0
        if a < 0.0:
            a, b = 0.0, float((weight * age2) @ (weight * squares) / ((weight * age2) @ (weight * age2)))
        weight = 1.0 / np.maximum(a + b * age2, 1e-3 * float(squares.mean()) + 1e-12)
    worst = float(np.quantile(squares / (a + b * age2 + 1e-12), 0.95))
    tail = max(1.0, worst / CHI_SQUARE_95)
    return a * tail, b * tail


def rehearse(model: Model, predict: Predict, epochs: Sequence[Epoch], horizon: int) -> list[Missed]:
    """Let a trained learner speak through stretches that it was not trained on, as in an outage.

    As in one, each begins where the shadow started anew, if it did.

    Parameters
    ----------
    model : Model
    predict : callable
    epochs : sequence of Epoch
        Held out.
    horizon : int
        Epochs that a rehearsed outage lasts.

    Returns
    -------
    list of Missed
    """
    missed = []
    anew = [k for k in range(1, len(epochs)) if epochs[k].segment != epochs[k - 1].segment]
    for first in anew or range(1, max(2, len(epochs) - 4), max(1, horizon // 2)):
        course = model.begin([] if anew else epochs[:first], epochs[first - 1].fix)
        start, segment = epochs[first - 1].time, epochs[first].segment
        for epoch in epochs[first : first + horizon]:
            if np.isnan(epoch.dt) or epoch.segment != segment:
                break
            course = go_on(model, predict, course, epoch)
            if course is None:
                break
            missed.append(Missed(epoch.time - start, model.wrong(course, epoch)))
    return missed
