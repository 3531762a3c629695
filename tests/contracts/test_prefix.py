"""Prefix law: nothing later than a sample has a say in how that sample was navigated."""

from dataclasses import replace

import numpy as np
import pytest
from folding import (
    FAULTY,
    HOLES,
    OUTAGE,
    SILENCE,
    faulty,
    heard,
    noticed,
    prepared,
    recording,
    rows,
    run,
)

from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate import spikes
from gapless.systems.recipe import Clock, Mounting, System

CUTS = (30.0, 60.0, 70.05, OUTAGE[0] + 8.004, HOLES[1][0] + 0.7, HOLES[1][1] + 0.02, OUTAGE[1] + 0.35)
CUTS += (HOLES[2][0] + 1.3, HOLES[2][1] + 0.004, SILENCE[0] + 5.0, SILENCE[1] + 12.0)
"""Before alignment, driving, between and just after fixes, in an outage, in holes that are bridged and at
the samples that close them, in one that is not, aligned again."""


@pytest.mark.parametrize(
    ("clock", "rate"), [("late", 1.0), ("late", 10.0), ("exact", 1.0), ("early", 1.0), ("early", 10.0)]
)
def test_a_prefix_navigates_like_the_whole(clock, rate):
    log = recording(clock, rate)
    setup = prepared(log, clock)
    whole = run(setup, log, clock)
    assert len(rows(whole)) > 900
    told = heard(whole)
    for t in CUTS:
        part = run(setup, log.slice(-np.inf, t), clock)
        # a row cut out of the sample that is still being felt comes with that sample
        assert rows(part) == rows(whole, end=part.time + 1e-9), t
        for name, said in heard(part).items():
            assert said == told[name][: len(said)], (t, name)


LIES = (60.05, 62.0, 84.7, 102.3, 108.3, 126.0, 133.5, 154.5)
"""While witnesses doubt, as they rule, as a box falls, and between."""


@pytest.mark.parametrize(("faults", "clock"), [("receiver", "late"), ("imu", "early")])
def test_a_prefix_with_faults_navigates_like_the_whole(faults, clock):
    log = faulty(faults, clock, 1.0)
    setup = prepared(log, clock)
    whole = run(setup, log, clock)
    told, notices = heard(whole), noticed(whole)
    assert len(rows(whole)) > 900
    for t in LIES:
        part = run(setup, log.slice(-np.inf, t), clock)
        assert rows(part) == rows(whole, end=part.time + 1e-9), t
        for found, of in zip(noticed(part), notices, strict=True):
            assert found == of[: len(found)], t
        for name, said in heard(part).items():
            assert said == told[name][: len(said)], (t, name)


def test_the_faults_are_noticed():
    """(So the tests above go through what they are about.)"""
    ruled, knocks = {}, []
    for faults in FAULTY:
        log = faulty(faults, "early", 1.0)
        found = noticed(run(prepared(log, "early"), log, "early"))
        ruled |= {(channel, ruling): None for _, channel, ruling in found[0]}
        knocks += found[1]
    assert {(c, "silence") for c in ("position", "velocity", "odometer")} <= set(ruled)
    assert {"believe", "turn"} <= {ruling for _, ruling in ruled}
    assert any(abs(time - 60.0) < 1.5 for time, _ in knocks)


@pytest.mark.parametrize("clock", ["late", "early"])
def test_spoilt_later_fixes_change_nothing_before_them(clock):
    log = recording(clock, 10.0)
    setup = prepared(log, clock)
    whole = run(setup, log, clock)
    for t in (60.0, OUTAGE[1] + 0.35):
        kept = log.gnss.slice(-np.inf, t)
        spoilt, _ = spikes(log.gnss, np.random.default_rng(5), 10**6, (5.0, 500.0), (1.0, 400.0))
        spoilt = replace(spoilt, sd_position=0.1 * spoilt.sd_position)
        after = spoilt.slice(t, np.inf)
        joined = {f: np.concatenate([getattr(kept, f), getattr(after, f)]) for f in vars(kept)}
        other = run(setup, replace(log, gnss=replace(kept, **joined)), clock)
        felt = t - 0.01
        assert rows(other, end=felt) == rows(whole, end=felt)
        assert rows(other) != rows(whole)


def test_a_causal_run_with_its_decisions_is_a_prefix_too():
    """Clocks and mounting found on the way: still nothing from later."""
    log = recording("late", 10.0)
    system = System()
    whole = fuse(log, system, causal=True).trajectory
    for t in (70.05, SILENCE[1] + 8.0):
        part = fuse(log.slice(-np.inf, t), system, causal=True).trajectory
        n = len(part)
        assert whole.time[n] >= t - 0.01
        for name in ("time", "lla", "v_n", "euler", "sd"):
            assert np.array_equal(getattr(part, name), getattr(whole, name)[:n]), (t, name)


def test_an_outage_is_scored_with_decisions_made_before_it():
    """Post-processing looks at the good past only: what comes back after the outage is not used in it."""
    log = recording("late", 10.0)
    spoilt, _ = spikes(log.gnss, np.random.default_rng(5), 10**6, (5.0, 500.0), (1.0, 400.0))
    keep = log.gnss.time < log.start + 98.0
    mixed = {
        f: np.where(keep.reshape(-1, *[1] * (getattr(log.gnss, f).ndim - 1)), getattr(log.gnss, f), v)
        for f, v in vars(spoilt).items()
    }
    outages = (Outage(98.0, 121.0),)
    a = fuse(log, outages=outages).trajectory
    b = fuse(replace(log, gnss=replace(log.gnss, **mixed)), outages=outages).trajectory
    n = int(np.searchsorted(a.time, 120.9))
    assert n > 600
    for name in ("time", "lla", "v_n", "euler", "sd"):
        assert np.array_equal(getattr(a, name)[:n], getattr(b, name)[:n]), name


def test_the_first_reading_of_a_late_starter_is_not_weighed_by_the_future():
    """An odometer that comes alive after alignment, and changes its rate later on."""
    log = recording("exact", 1.0)
    late = log.odometer.slice(60.0, np.inf)
    slow = late.take((late.time < 60.3) | (np.arange(len(late)) % 10 == 0))
    log = replace(log, odometer=slow)
    system = System(clock=Clock(0.0, 0.0, 0.0), mounting=Mounting(0.0, 0.0))
    setup = prepared(log, "exact", system)
    part = run(setup, log.slice(-np.inf, 60.35), "exact")
    assert rows(part) == rows(run(setup, log, "exact"), end=60.35)
