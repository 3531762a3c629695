"""Holes at random times of simulated drives: what they cost against what the filter says that they cost."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.bridges.shadow import difference
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.simulate import simulate
from gapless.systems.build import settings
from gapless.systems.recipe import System
from gapless.trip.events import ImuBlock

HOLES = (0.2, 0.5, 1.0, 2.0)


def costs(profile, seed):
    """Error that a hole adds, squared, over the variance that it adds: by hole, state of nine and time."""
    log = replace(simulate(profile, "consumer", 300.0, seed), grade=None)
    offsets = {"position": 0.0, "velocity": 0.0}
    navigator = Navigator(settings(System(constraints=()), log, offsets, (np.zeros(2), np.full(2, 0.02))))
    rng, due, found = np.random.default_rng(seed), log.start + 60.0, {h: [] for h in HOLES}
    for event in events(log, offsets, end=log.start + 295.0):
        navigator.step(event)
        if not isinstance(event, ImuBlock) or navigator.time < due:
            continue
        due = navigator.time + rng.uniform(3.0, 6.0)
        first = int(np.searchsorted(log.imu.time, navigator.time + 1e-6))
        for hole in HOLES:
            last = int(np.searchsorted(log.imu.time, navigator.time + hole + 0.0101))
            whole, holed = navigator.fork(), navigator.fork()
            whole.step(ImuBlock.of(log.imu, first, last + 1))
            holed.step(ImuBlock.of(log.imu, last, last + 1))
            off = difference(whole.belief.x[:10], holed.belief.x[:10])
            more = np.diag(holed.belief.P - whole.belief.P)[:9]
            found[hole].append(off**2 / more)
    return found


@pytest.mark.parametrize(("profile", "seed"), [("urban", 7), ("highway", 3)])
def test_holes_cost_what_is_said(profile, seed):
    for hole, found in costs(profile, seed).items():
        velocity, attitude = (np.mean([f[k] for f in found]) for k in (slice(3, 6), slice(6, 9)))
        # some fifty holes; the highway's turns are rare, and the budget before anything is learned is wide
        assert 0.25 < velocity < 1.6, (hole, velocity)
        assert 0.25 < attitude < 1.6, (hole, attitude)
