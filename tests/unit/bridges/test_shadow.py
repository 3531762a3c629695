"""The shadow INS: what the filter's own strapdown would do if nobody corrected it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gapless import attitude, earth
from gapless.bridges.shadow import Shadow, difference
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.inertial.coast import STATE
from gapless.scenarios import Outage, withhold
from gapless.simulate import simulate
from gapless.systems.adjust import named
from gapless.systems.build import settings
from gapless.systems.recipe import System
from gapless.trip.events import Motion

MOUNTING = (np.zeros(2), np.full(2, 0.01))


class _Listener:
    """A bridge that says nothing and keeps a shadow."""

    reach = 0.0

    def __init__(self, start):
        self.start, self.shadow, self.apart = start, Shadow(), []

    def feel(self, block):
        pass

    def hear(self, belief, reading, used):
        pass

    def tick(self, belief, motion):
        if self.shadow.running:
            self.shadow.tick(belief, motion)
            self.apart.append((motion.time, difference(self.shadow.x, belief.estimate()[:STATE])))
        elif motion.time >= self.start:
            self.shadow.restart(belief, motion.time)
        return ()

    def lost(self):
        pass

    def decisions(self, start):
        return ()

    def learned(self):
        return None

    def copy(self):
        return self


def test_without_fixes_shadow_and_filter_are_one():
    log = simulate("urban", "consumer", 90.0, 3)
    quiet = replace(log, gnss=log.gnss.slice(-np.inf, 60.0))
    listener = _Listener(62.0)
    setup = settings(System(constraints=()), quiet, {}, MOUNTING)
    navigator = Navigator(replace(setup, bridges=(listener,)))
    for event in events(quiet, {}):
        navigator.step(event)
    _, apart = listener.apart[-1]
    assert listener.apart[-1][0] > 88.0
    # ten-per-second means instead of a hundred samples: coning of a vibrating car, under a millimetre
    # a second; measured 0.01 m after 28 s
    assert np.abs(apart[:3]).max() < 0.1
    assert np.abs(apart[3:6]).max() < 0.02
    assert np.abs(apart[6:]).max() < 1e-3


def test_with_fixes_it_drifts_as_nobody_corrects_it():
    log = simulate("urban", "consumer", 150.0, 3)
    listener = _Listener(60.0)
    setup = settings(System(constraints=()), log, {}, MOUNTING)
    navigator = Navigator(replace(setup, bridges=(listener,)))
    for event in events(log, {}):
        navigator.step(event)
    apart = np.array([a for _, a in listener.apart])
    assert np.abs(apart[-1, :2]).max() > 5.0 > np.abs(apart[10, :2]).max()


def test_difference_is_what_was_added():
    rng = np.random.default_rng(0)
    x = np.concatenate([[0.56, 2.07, 20.0], rng.normal(size=3), attitude.from_euler([0.02, -0.03, 2.0])])
    error = np.concatenate([rng.normal(size=3), rng.normal(size=3), 1e-3 * rng.normal(size=3)])
    other = x.copy()
    other[:3] = earth.ned_to_lla(error[:3], x[:3])
    other[3:6] += error[3:6]
    other[6:10] = attitude.multiply(attitude.from_rotation_vector(error[6:]), x[6:10])
    found = difference(other, x)
    # a metre on a sphere of 6.4e6 m: curvature below 1e-6 m; rotation vectors to second order, 1e-9 rad
    assert found[:6] == pytest.approx(error[:6], abs=2e-6)
    assert found[6:] == pytest.approx(error[6:], abs=1e-9)


def test_a_copy_goes_its_own_way():
    shadow = Shadow()
    shadow.x = np.array([0.5, 2.0, 0.0, 10.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    shadow.began = 0.0
    before, other = shadow.x.copy(), shadow.copy()

    class Still:
        x = np.zeros(16)

    other.tick(Still(), Motion(0.1, 0.1, np.array([0, 0, 0, 0, 0, -9.8])))
    assert (shadow.x == before).all()
    assert (other.x != before).any()


def test_when_a_start_is_due():
    shadow = Shadow(interval=60.0)
    assert shadow.due(0.0)
    shadow.began = 10.0
    assert not shadow.due(69.9)
    assert shadow.due(70.0)
    assert not Shadow(math.inf, 0.0).due(1e9)


def test_nothing_is_learned_while_a_filter_finds_back():
    log = simulate("urban", "consumer", 200.0, 3)
    gone = replace(log, gnss=withhold(log.gnss, (Outage(100.0, 130.0),), 0.0))
    navigator = Navigator(settings(named("wang2018"), gone, {}, MOUNTING))
    for event in events(gone, {}):
        navigator.step(event)
    (bridge,) = navigator.bridges
    learned = [e for e in bridge.epochs if e.time > 100.0]
    assert 139.9 < learned[0].time < 143.0
    assert learned[0].age < 2.0  # of a shadow that started anew
    assert np.isnan(learned[0].dt)


def test_a_filter_that_a_bridge_misled_comes_back():
    """Sure of a wrong tilt, it would be thrown off again by every second fix."""
    log = simulate("urban", "consumer", 200.0, 3)
    gone = replace(log, gnss=withhold(log.gnss, (Outage(100.0, 130.0),), 0.0))
    navigator = Navigator(settings(named("wang2018"), gone, {}, MOUNTING))
    for event in events(gone, {}):
        navigator.step(event)
    said = navigator.journal.innovations()["position"]
    assert np.linalg.norm(said.z[said.time >= 130.0][0]) > 30.0  # it was misled
    # two seconds until two fixes agree, some more until the tilt is found; then as good as ever
    assert said.nis[said.time > 145.0].max() < 16.3  # 99.9 % of chi-square of 3
