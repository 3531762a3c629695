"""Resume law, fork, blocks and arrival: the same events give the same bits, however they come."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from folding import (
    CLOCKS,
    FAULTY,
    HOLES,
    OUTAGE,
    belief,
    faulty,
    fold,
    heard,
    noticed,
    prepared,
    recording,
    rows,
    run,
    singles,
)

from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.systems.recipe import Filter, GnssUse, System
from gapless.trip.events import ImuBlock


def stops(feed, times):
    """Indices of the first events after some arrival times, and of the ones after those."""
    arrived = [e.time[-1] if isinstance(e, ImuBlock) else -np.inf for e in feed]
    latest = np.maximum.accumulate(arrived)
    return [int(k) + extra for k in np.searchsorted(latest, times) for extra in (1, 2)]


@pytest.mark.parametrize(
    ("clock", "correction"),
    [("late", "feedback"), ("exact", "feedback"), ("early", "feedback"), ("late", "feedforward")],
)
def test_resume(clock, correction):
    """Cut before alignment, between a fix and what it waits for, in an outage, at a hole, in a stop."""
    log = recording(clock, 1.0)
    setup = prepared(log, clock, System(filter=Filter(correction=correction)))
    feed = list(events(log, CLOCKS[clock]))
    whole = run(setup, log, clock)
    for k in stops(feed, (33.0, OUTAGE[0] + 3.0, HOLES[2][0], HOLES[2][1], 145.0)):
        navigator = fold(Navigator(setup), feed[:k])
        now, kept = belief(navigator), navigator.snapshot()
        before = rows(navigator)
        skip = {name: len(said) for name, said in heard(navigator).items()}
        fold(navigator, feed[k:])
        assert belief(navigator) == belief(whole)
        assert rows(navigator) == rows(whole)
        navigator.restore(kept)
        assert belief(navigator) == now
        assert rows(navigator) == before
        fold(navigator, feed[k:])
        assert belief(navigator) == belief(whole)
        assert rows(navigator) == rows(whole)
        assert heard(navigator) == heard(whole)
        fresh = Navigator(setup)
        fresh.restore(kept)  # a snapshot is not used up
        fold(fresh, feed[k:])
        assert belief(fresh) == belief(whole)
        assert rows(fresh) == rows(whole)[len(before) :]
        assert {**{name: [] for name in skip}, **heard(fresh)} == heard(whole, skip)


@pytest.mark.parametrize(
    ("faults", "clock", "correction"),
    [("receiver", "early", "feedback"), ("imu", "early", "feedback"), ("imu", "late", "feedforward")],
)
def test_resume_fork_and_blocks_with_faults(faults, clock, correction):
    """Cut while a channel is silenced, as a box falls and after it, while positions await belief."""
    log = faulty(faults, clock, 1.0)
    setup = prepared(log, clock, System(filter=Filter(correction=correction)))
    feed = list(events(log, CLOCKS[clock]))
    whole = run(setup, log, clock)
    live = fold(Navigator(setup), singles(feed))
    assert rows(live) == rows(whole)
    assert heard(live) == heard(whole)
    assert noticed(live) == noticed(whole)
    assert belief(live) == belief(whole)
    for k in stops(feed, (60.2, 90.0, 108.5, 135.0))[::2]:
        navigator = fold(Navigator(setup), feed[:k])
        now, kept, before = belief(navigator), navigator.snapshot(), rows(navigator)
        known = noticed(navigator)
        fork = fold(navigator.fork(), feed[k:])
        assert belief(navigator) == now
        fold(navigator, feed[k:])
        fresh = Navigator(setup)
        fresh.restore(kept)  # of a belief that has gone on since
        fold(fresh, feed[k:])
        for other in (fork, fresh):
            assert belief(other) == belief(whole)
            assert rows(other) == rows(whole)[len(before) :]
            for old, new, all_ in zip(known, noticed(other), noticed(whole), strict=True):
                assert [*old, *new] == all_
        assert noticed(navigator) == noticed(whole)
        assert rows(navigator) == rows(whole)


@pytest.mark.parametrize("clock", CLOCKS)
def test_a_fork_runs_ahead_alone(clock):
    log = recording(clock, 10.0)
    setup = prepared(log, clock)
    feed = list(events(log, CLOCKS[clock]))
    whole = run(setup, log, clock)
    for k in stops(feed, (60.0, 125.0)):
        navigator = fold(Navigator(setup), feed[:k])
        before = belief(navigator), rows(navigator), heard(navigator)
        fork = fold(navigator.fork(), feed[k:])
        silent = fold(navigator.fork(), (e for e in feed[k:] if isinstance(e, ImuBlock)))
        assert (belief(navigator), rows(navigator), heard(navigator)) == before
        assert belief(fork) == belief(whole)
        assert rows(fork) == rows(whole)[len(before[1]) :]
        assert belief(silent) != belief(whole)
        fold(navigator, feed[k:])
        assert belief(navigator) == belief(whole)
        assert rows(navigator) == rows(whole)


@pytest.mark.parametrize("clock", CLOCKS)
def test_samples_one_by_one_are_the_block(clock):
    log = recording(clock, 1.0)
    setup = prepared(log, clock)
    feed = list(events(log, CLOCKS[clock]))
    whole, live = run(setup, log, clock), fold(Navigator(setup), singles(feed))
    assert rows(live) == rows(whole)
    assert heard(live) == heard(whole)
    assert belief(live) == belief(whole)


def test_samples_one_by_one_are_the_block_for_velocities_that_are_means():
    log = recording("exact", 1.0).slice(-np.inf, 60.0)
    setup = prepared(log, "exact", System(gnss=GnssUse(velocity_averaging=1.0)))
    feed = list(events(log, CLOCKS["exact"]))
    whole, live = run(setup, log, "exact"), fold(Navigator(setup), singles(feed))
    assert belief(live) == belief(whole)


def test_samples_one_by_one_are_the_block_at_a_standstill_that_gnss_misses():
    """The gyro bias of a stop, from before and after a stretch without fixes."""
    log = recording("exact", 1.0).slice(-np.inf, 45.0)
    log = replace(log, odometer=None, gnss=log.gnss.take((log.gnss.time < 6.0) | (log.gnss.time > 24.0)))
    setup = prepared(log, "exact")
    feed = list(events(log, CLOCKS["exact"]))
    whole, live = run(setup, log, "exact"), fold(Navigator(setup), singles(feed))
    assert whole.aligned
    assert live.aligned
    assert belief(live) == belief(whole)


def delivered(setup, log, readings, arrivals, until):
    """The log's samples up to some time, each reading handed over when it arrives."""
    navigator, imu, first = Navigator(setup), log.imu, 0
    for k in np.argsort(arrivals, kind="stable"):
        if arrivals[k] > until:
            break
        stop = int(np.searchsorted(imu.time, arrivals[k]))
        if stop > first:
            navigator.step(ImuBlock.of(imu, first, stop))
        first = stop
        navigator.step((readings[k],))
    navigator.step(ImuBlock.of(imu, first, int(np.searchsorted(imu.time, until))))
    assert navigator.dropped == 0
    return navigator


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_late_readings_end_in_the_same_belief(share):
    """Handed over as they hold, or later and out of order: the same once everything is there."""
    log = recording("exact", 1.0)
    setup = replace(prepared(log, "exact"), lateness=0.75)
    readings = [r for e in events(log, CLOCKS["early"]) if not isinstance(e, ImuBlock) for r in e]
    holds = np.array([r.time for r in readings])
    late = holds + share * 0.7 * np.random.default_rng(3).random(len(holds))
    for until in (60.0, OUTAGE[1] - 1.0, 125.0):
        arrived = holds < until - 0.75
        ends = [
            belief(delivered(setup, log, readings, np.where(arrived, times, np.inf), until))
            for times in (holds, late)
        ]
        assert ends[0] == ends[1]


@pytest.mark.parametrize("faults", FAULTY)
def test_late_readings_with_faults_end_in_the_same_belief(faults):
    """A ruling that a late reading overturns leaves nothing behind."""
    log = faulty(faults, "exact", 1.0)
    setup = replace(prepared(log, "exact"), lateness=0.75)
    readings = [r for e in events(log, CLOCKS["early"]) if not isinstance(e, ImuBlock) for r in e]
    holds = np.array([r.time for r in readings])
    late = holds + 0.7 * np.random.default_rng(3).random(len(holds))
    for until in (64.0, 140.0):
        arrived = holds < until - 0.75
        ends = [
            belief(delivered(setup, log, readings, np.where(arrived, times, np.inf), until))
            for times in (holds, late)
        ]
        assert ends[0] == ends[1]


def test_a_late_reading_after_a_long_silence_replays_what_it_reaches(monkeypatch):
    """Twenty silent seconds come as one block; a fix late by a quarter second costs no more of them."""
    log = recording("exact", 1.0)
    setup = replace(prepared(log, "exact"), lateness=0.3)
    imu, feed = log.imu, list(events(log, CLOCKS["exact"]))
    first = int(np.searchsorted(imu.time, OUTAGE[0]))
    last = int(np.searchsorted(imu.time, OUTAGE[0] + 20.0))
    before = [e for e in feed if not isinstance(e, ImuBlock) or e.time[-1] <= imu.time[first - 1]]
    fix = next(e for e in reversed(before) if not isinstance(e, ImuBlock))
    late = tuple(r._replace(time=float(imu.time[last - 1]) - 0.25) for r in fix)
    run_through = []
    monkeypatch.setattr(
        Navigator,
        "_feel",
        lambda self, block, feel=Navigator._feel: (run_through.append(len(block.time)), feel(self, block))[1],
    )
    navigator = fold(Navigator(setup), before)
    known = navigator.time
    navigator.step(ImuBlock.of(imu, int(np.searchsorted(imu.time, known, side="right")), last))
    run_through.clear()
    navigator.step(late)
    assert navigator.dropped == 0
    assert 0.3 * imu.rate < sum(run_through) < 1.5 * imu.rate


def handed_over(order):
    """One second after 60 s with two readings, all handed over in some order."""
    log = recording("exact", 1.0)
    setup = replace(prepared(log, "exact"), lateness=0.75)
    navigator = fold(Navigator(setup), events(log.slice(-np.inf, 60.0), CLOCKS["exact"]))
    fix = next(e for e in events(log.slice(60.0, 61.5), {}) if not isinstance(e, ImuBlock))[:2]
    one, other = (r._replace(time=t) for r, t in zip(fix, (60.03, 60.014), strict=True))
    edges = [int(k) for k in np.searchsorted(log.imu.time, (60.0 - 1e-6, 60.03 + 1e-6, 60.2, 61.0))]
    parts = {str(i): ImuBlock.of(log.imu, a, b) for i, (a, b) in enumerate(pairwise(edges))}
    for key in order:
        navigator.step({"a": (one,), "b": (other,), **parts}[key])
    return belief(navigator)


@pytest.mark.parametrize("order", ["0a12", "01a2"])
def test_a_reading_of_the_present_instant_may_come_before_or_after_the_sample(order):
    assert handed_over(order) == handed_over("a012")


def test_a_later_reading_that_goes_further_back_loses_none():
    """The newer one late, then the older one later still."""
    assert handed_over("01ab2") == handed_over("01ba2")


def test_a_reading_too_old_is_counted_not_used():
    log = recording("exact", 1.0)
    setup = replace(prepared(log, "exact"), lateness=0.5)
    feed = list(events(log.slice(-np.inf, 60.0), CLOCKS["exact"]))
    navigator = fold(Navigator(setup), feed)
    before = belief(navigator)
    old = next(e for e in feed[len(feed) // 2 :] if not isinstance(e, ImuBlock))
    navigator.step(old)
    assert navigator.dropped == len(old)
    assert belief(navigator) == before
