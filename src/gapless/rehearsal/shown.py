"""What rehearsals have to show."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from itertools import accumulate

from gapless.rehearsal.judge import Rehearsed, Score, choose
from gapless.trip.exhibits import Candidate, Chosen, Performance, Rehearsals, Standing


def shown(
    history: Sequence[Rehearsed], bridges: Collection[str], presets: Collection[str], length: float
) -> Rehearsals:
    """Rehearsals for the report: a choice follows from those before it, so it is made again here.

    Parameters
    ----------
    history : sequence of Rehearsed
    bridges, presets : collection of str
        The candidates, as `choose` was told them.
    length : float
        Of an outage [s].

    Returns
    -------
    Rehearsals
    """
    pasts = list(accumulate(history, lambda past, one: (*past, one), initial=tuple[Rehearsed, ...]()))
    choices = [choose(past, bridges, presets) for past in pasts]
    return Rehearsals(
        length,
        tuple(
            Performance(
                one.start, one.end, tuple((Candidate(t.bridge, t.preset), t.worst) for t in one.trials)
            )
            for one in history
        ),
        (
            *(_standing(score, "bridge") for score in choices[-1].bridges),
            *(_standing(score, "preset") for score in choices[-1].presets),
        ),
        tuple(
            Chosen(one.end, Candidate(choice.bridge, choice.preset), choice.scale)
            for one, choice in zip(history, choices[1:], strict=True)
        ),
    )


def _standing(score: Score, kind: str) -> Standing:
    ratio, low, high = (math.exp(score.mean + k * score.error) for k in (0.0, -1.0, 1.0))
    return Standing(score.name, kind, score.trials, ratio, low, high, score.earned)
