"""What a run has to show besides its trajectory: what the wheels told, and how it rehearsed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gapless.trip.recording import Array


class Heard(NamedTuple):
    """A speed that was read from the wheels in silence.

    Parameters
    ----------
    time : float
        End of the window [s].
    speed, sd : float
        What was read, and its standard deviation as the filter was told [m/s].
    own : float
        The filter's speed before [m/s].
    slips : float
        Probability that the wheels slipped.
    """

    time: float
    speed: float
    sd: float
    own: float
    slips: float


@dataclass(frozen=True, eq=False)
class WheelsHeard:
    """The order spectrum of a car, and what was read with it.

    Parameters
    ----------
    spectra : float
        Learned from so many, those long ago counted less.
    orders : ndarray, shape (n,)
        [cycles/m]
    height : ndarray, shape (6, n)
        Natural log of power above what is around: rates, then specific forces, of the box's three axes.
    error : ndarray, shape (6, n)
        Standard error; `height` is shrunk by it already.
    circumference : float or None
        Of the wheels [m]; None where no comb stands out.
    contrast : float
        By how many standard errors the best comb stands out of the other orders.
    readings : tuple of Heard
    refused : int
        Spectra in silence that said too little.
    """

    spectra: float
    orders: Array
    height: Array
    error: Array
    circumference: float | None
    contrast: float
    readings: tuple[Heard, ...]
    refused: int


class Candidate(NamedTuple):
    """Who spoke in an outage, and how the filter was tuned.

    Parameters
    ----------
    bridge, preset : str
        "" for nobody, and for the recipe's own tuning.
    """

    bridge: str
    preset: str


class Performance(NamedTuple):
    """A rehearsed outage.

    Parameters
    ----------
    start, end : float
        [s]
    worst : tuple of (Candidate, float)
        Largest horizontal distance of each from the aided track [m].
    """

    start: float
    end: float
    worst: tuple[tuple[Candidate, float], ...]


class Standing(NamedTuple):
    """How a candidate stands in the end, against the same outages without it.

    Parameters
    ----------
    name : str
        A bridge's or a preset's.
    kind : str
        "bridge" or "preset".
    rehearsals : int
    ratio, low, high : float
        Geometric mean of the ratios of largest errors, drawn towards 1, and one standard error either way.
    earned : bool
        Whether that is good enough to be chosen.
    """

    name: str
    kind: str
    rehearsals: int
    ratio: float
    low: float
    high: float
    earned: bool


class Chosen(NamedTuple):
    """What an outage would have been met with from a time on.

    Parameters
    ----------
    time : float
        End of the rehearsal that led to it [s].
    candidate : Candidate
    scale : float
        Factor on the stated covariance of the position.
    """

    time: float
    candidate: Candidate
    scale: float


@dataclass(frozen=True)
class Rehearsals:
    """How a run rehearsed.

    Parameters
    ----------
    length : float
        Of an outage [s].
    performances : tuple of Performance
    standings : tuple of Standing
    choices : tuple of Chosen
        One after each performance.
    """

    length: float
    performances: tuple[Performance, ...]
    standings: tuple[Standing, ...]
    choices: tuple[Chosen, ...]


Exhibit = WheelsHeard | Rehearsals

FINEST = 0.0005
"""Distance of the fundamentals that are tried [cycles/m]."""
WHEELS = (1.4, 3.3)
"""Circumferences that are looked for, from a small car's to a lorry's [m]."""
STANDS_OUT = 5.0
"""Standard errors: noise alone, tried at some hundred fundamentals, comes to 3 or 4."""


def fundamental(orders: Array, height: Array, error: Array) -> tuple[float | None, float]:
    """Circumference of the wheels: the fundamental whose harmonics carry the most evidence.

    Evidence at an order is the mean over channels of height / error. A fundamental's is the mean at its
    harmonics less the mean over all orders, in standard errors of such a mean. Half the true one has
    twice the harmonics, half of them empty; twice the true one leaves half of them out: both count for
    less. Where every other line is weak, or lines are few, they cannot be told apart for sure: a lorry's
    wheel may then pass for half of it.

    Parameters
    ----------
    orders : ndarray, shape (n,)
        Equally far apart [cycles/m].
    height, error : ndarray, shape (6, n)
        As in `WheelsHeard`.

    Returns
    -------
    circumference : float or None
        [m]; None where it does not stand out.
    contrast : float
        By how many standard errors it does.
    """
    evidence = (height / error).mean(axis=0)
    spread = float(evidence.std())
    if not spread > 0.0:
        return None, 0.0
    tried = np.arange(1.0 / WHEELS[1], 1.0 / WHEELS[0], FINEST)
    at = np.outer(tried, np.arange(1.0, orders[-1] / tried[0]))
    known = at < orders[-1]
    count = known.sum(axis=1)
    mean = np.where(known, np.interp(at, orders, evidence), 0.0).sum(axis=1) / count
    contrast = (mean - evidence.mean()) / spread * np.sqrt(count)
    k = int(contrast.argmax())
    found = float(1.0 / tried[k])
    return (found if contrast[k] > STANDS_OUT else None), float(contrast[k])
