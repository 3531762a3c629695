"""What rehearsals have to show agrees with the judge at each step."""

from __future__ import annotations

import math

import pytest

from gapless.rehearsal.judge import Rehearsed, Trial, choose
from gapless.rehearsal.shown import shown
from gapless.trip.exhibits import Candidate

BRIDGES = {"wheels": (0,)}


def history(n, ratio):
    plain = [8.0 + 3.0 * math.sin(k) for k in range(n)]
    return tuple(
        Rehearsed(
            20.0 * k, 20.0 * k + 60.0, (Trial("", "", w, (1.0,)), Trial("wheels", "", ratio * w, (40.0,)))
        )
        for k, w in enumerate(plain)
    )


def test_choices_are_those_that_were_made_then():
    past = (*history(3, 1.0), *history(12, 0.5)[3:])
    told = shown(past, BRIDGES, (), 60.0)
    assert [c.time for c in told.choices] == [one.end for one in past]
    for k, chosen in enumerate(told.choices, 1):
        then = choose(past[:k], BRIDGES, ())
        assert chosen[1:] == (Candidate(then.bridge, then.preset), then.scale)
    assert told.choices[0].candidate == ("", "")  # nothing gained, nothing earned
    assert told.choices[-1].candidate == ("wheels", "")
    assert told.choices[-1].scale > 1.0


def test_performances_and_standings():
    told = shown(history(9, 0.5), BRIDGES, (), 60.0)
    assert told.performances[3].worst == tuple(
        (Candidate(t.bridge, t.preset), t.worst) for t in history(9, 0.5)[3].trials
    )
    (one,) = told.standings
    (score,) = choose(history(9, 0.5), BRIDGES, ()).bridges
    assert one.ratio == pytest.approx(math.exp(score.mean), rel=1e-12)
    assert one.high == pytest.approx(math.exp(score.mean + score.error), rel=1e-12)
    assert one.low < one.ratio < one.high
    assert one.low * one.high == pytest.approx(one.ratio**2, rel=1e-12)


def test_nothing_rehearsed_is_nothing_chosen():
    told = shown((), BRIDGES, (), 60.0)
    assert told.performances == told.choices == ()
    assert told.standings[0].rehearsals == 0
    assert not told.standings[0].earned
