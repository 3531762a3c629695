"""Filters other than the default obey the laws of the fold: blocks, resume, forks, prefix."""

from dataclasses import replace

import pytest
from folding import CLOCKS, belief, fold, heard, prepared, recording, rows, run, singles

from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.scenarios import Outage, withhold
from gapless.systems.library import parse
from gapless.trip.events import ImuBlock

RECIPES = {
    "cubature": '[filter]\nmoments = "cubature"',
    "wang2018": '[adaptation]\ngnss = ["improved_fading", "gate"]',
    "ff": '[adaptation]\ngnss = ["gate", "fading"]\n[filter]\nstates = ["lever_arm", "accel_scale"]',
    "vb": '[adaptation]\ngnss = ["variational", "igg3"]\n[filter]\nmoments = "cubature"',
    "tan2015": '[adaptation]\ngnss = ["sage_husa", "chi_square"]\nconstraints = ["chi_square"]',
}


@pytest.fixture(scope="module", params=RECIPES)
def case(request):
    """A log on clocks that cut samples, with an outage, and one run through it."""
    log = recording("late", 1.0).slice(0.0, 100.0)
    log = replace(log, gnss=withhold(log.gnss, [Outage(80.0, 86.0)], 0.0))
    setup = prepared(log, "late", parse(RECIPES[request.param], "recipe"))
    return log, setup, list(events(log, CLOCKS["late"])), run(setup, log, "late")


def test_blocks_change_no_bit(case):
    _, setup, feed, whole = case
    live = fold(Navigator(setup), singles(feed))
    assert len(rows(whole)) > 300
    assert rows(live) == rows(whole)
    assert heard(live) == heard(whole)
    assert belief(live) == belief(whole)


def test_resume_and_fork(case):
    _, setup, feed, whole = case
    for k in (len(feed) // 2, 5 * len(feed) // 6):
        navigator = fold(Navigator(setup), feed[:k])
        kept, before = navigator.snapshot(), rows(navigator)
        fork = fold(navigator.fork(), feed[k:])
        silent = fold(navigator.fork(), (e for e in feed[k:] if isinstance(e, ImuBlock)))
        fold(navigator, feed[k:])
        fresh = Navigator(setup)
        fresh.restore(kept)
        fold(fresh, feed[k:])
        assert belief(navigator) == belief(fork) == belief(fresh) == belief(whole)
        assert rows(fork) == rows(fresh) == rows(whole)[len(before) :]
        assert heard(navigator) == heard(whole)
        assert belief(silent) != belief(whole)


def test_a_prefix_navigates_like_the_whole(case):
    log, setup, _, whole = case
    for t in (60.05, 83.0, 95.35):
        part = run(setup, log.slice(-1e9, t), "late")
        assert rows(part) == rows(whole, end=part.time + 1e-9)
