"""When a bridge learns and from how much, and what it has then."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from gapless.bridges.noise import Noise

if TYPE_CHECKING:
    from gapless.learners import Regressor


@dataclass(frozen=True)
class Schedule:
    """When a bridge learns, and how much: counted in epochs, never in computing time.

    Parameters
    ----------
    samples : int
        Most epochs that are kept, the latest.
    least : int
        Fewer are not trained on.
    every : float
        Time between trainings [s]; inf trains when an outage begins.
    interval : float
        Epochs closer than this are not used [s].
    purge : int
        Epochs left out between those trained on and those held out.
    settle : float
        Time after an outage in which nothing is learned [s]: the filter still finds back, and by what it is
        off then has nothing to do with the INS.
    slack : float
        How much later than it holds a fix may arrive [s]: silence begins so much later.
    """

    samples: int = 300
    least: int = 30
    every: float = math.inf
    interval: float = 1.0
    purge: int = 5
    settle: float = 10.0
    slack: float = 0.0


class Trained(NamedTuple):
    """A learner that has learned.

    Parameters
    ----------
    learner : Regressor
        Never changed again.
    noise : Noise
    time : float
        When [s].
    rows : int
        From so many.
    """

    learner: Regressor
    noise: Noise
    time: float
    rows: int
