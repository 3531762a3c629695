"""Offsets of seconds, from turns that gyros and the course both tell of."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gapless.alignment.turns import REACH, Turns, far_off, turns
from gapless.simulate import simulate


@cache
def drive():
    return simulate("urban", "consumer", 300.0, 4, rate=50.0)


def late(seconds):
    return replace(drive().gnss, time=drive().gnss.time + seconds)


@settings(max_examples=20, deadline=None)
@given(st.floats(1.5, 25.0), st.sampled_from([-1.0, 1.0]), st.integers(0, 1000))
def test_any_offset_is_found_however_the_box_sits(seconds, sign, seed):
    about = Rotation.random(random_state=seed).as_matrix()
    imu = replace(drive().imu, dtheta=drive().imu.dtheta @ about.T)
    # steps of 0.25 s, and turns by GNSS are means over two seconds
    assert far_off(turns(imu, late(sign * seconds))) == pytest.approx(-sign * seconds, abs=0.3)


@pytest.mark.parametrize("seconds", [-0.6, 0.0, 0.6])
def test_small_ones_are_left_to_the_finer_search(seconds):
    assert far_off(turns(drive().imu, late(seconds))) == 0.0


def test_positions_will_do():
    gnss = late(9.0)
    mute = replace(gnss, v_n=np.full_like(gnss.v_n, np.nan))
    assert far_off(turns(drive().imu, mute)) == pytest.approx(-9.0, abs=0.5)


def test_beyond_reach_or_short_or_nonsense_nothing_is_found():
    imu, rng = drive().imu, np.random.default_rng(3)
    assert far_off(turns(imu, late(REACH + 15.0))) == 0.0
    assert far_off(turns(imu, late(5.0).take(slice(0, 60)))) == 0.0
    assert far_off(turns(imu, late(5.0).take(slice(0, 0)))) == 0.0
    assert far_off(turns(imu.take(slice(0, 0)), late(5.0))) == 0.0
    for _ in range(20):
        noise = replace(late(0.0), v_n=rng.normal(10.0, 3.0, (len(drive().gnss), 3)))
        assert far_off(turns(imu, noise)) == 0.0


def test_turns_that_come_again_and_again_tell_nothing():
    """On a course that repeats itself every ten seconds several offsets fit."""
    offset = np.arange(-30.0, 30.01, 0.25)
    assert far_off(Turns(offset, 0.95 * np.cos(np.pi * offset / 10.0) ** 2)) == 0.0
    once = np.where(np.abs(offset - 7.0) < 2.0, 0.95, 0.1)
    assert far_off(Turns(offset, once)) == pytest.approx(7.0, abs=2.0)
