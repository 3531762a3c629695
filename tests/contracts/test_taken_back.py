"""What a receiver said before it was found out leaves nothing behind."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from folding import CAR, fold, prepared, rows

from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.simulate import Receiver, simulate
from gapless.witnesses.hearing import FAR, SURE
from gapless.witnesses.testimony import REPEATS

BEGIN, LASTS = 80.0, 8.0
"""In a drive through a city, from a turn on [s]."""


@cache
def log():
    return simulate("urban", "consumer", 120.0, 4, vehicle=CAR, receiver=Receiver(rate=10.0))


def repeated():
    """Velocities that repeat the first of a stretch."""
    g = log().gnss
    k = np.flatnonzero((g.time >= BEGIN) & (g.time < BEGIN + LASTS))
    v = g.v_n.copy()
    v[k] = v[k[0]]
    return replace(log(), gnss=replace(g, v_n=v))


def without(begin, end):
    """The log without the velocities of a stretch."""
    g = log().gnss
    v = np.where(((g.time >= begin) & (g.time < end))[:, None], np.nan, g.v_n)
    return replace(log(), gnss=replace(g, v_n=v))


def navigated(of, until, memory=12.0):
    setup = replace(prepared(log(), "exact"), memory=memory)
    return fold(Navigator(setup), events(of.slice(-np.inf, until), {}))


def off(one, other):
    return float(np.linalg.norm(one.belief.v_n - other.belief.v_n))


def test_as_if_it_had_never_been_said():
    until = BEGIN + REPEATS + SURE + 0.5
    found = navigated(repeated(), until)
    assert any(ruling == "silence" for _, _, ruling in found.journal.rulings)
    never, kept = navigated(without(BEGIN, until), until), navigated(repeated(), until, memory=0.0)
    assert off(kept, never) > 0.3  # it had led the filter astray
    # all that is left of it is a second and a half of positions that were silenced with it
    assert off(found, never) < 0.1 * off(kept, never)


def test_rows_that_were_written_stay():
    """What is scored as real time sees no later reading."""
    early, late = BEGIN + REPEATS + 1.0, BEGIN + REPEATS + SURE + 3.0
    before = rows(navigated(repeated(), early))
    assert rows(navigated(repeated(), late))[: len(before)] == before


@pytest.mark.parametrize("lateness", [0.0, 0.5])
def test_the_past_reaches_back_as_far_as_is_taken_back(lateness):
    """And keeps few states of it: one a second, and those that late readings reach."""
    setup = replace(prepared(log(), "exact"), lateness=lateness)
    navigator = fold(Navigator(setup), events(log().slice(-np.inf, 70.0), {}))
    kept = [state.clock for state, _ in navigator._past.entries]
    assert navigator.time - kept[0] >= FAR
    assert len(kept) < setup.memory + 2.0 + 10.0 * (lateness + 0.2)
    assert np.diff(kept).max() < 1.3
