"""A box that sits otherwise: turned as no car turns, or on another side."""

import numpy as np
import pytest

from gapless.units import DEG
from gapless.witnesses.jolt import about
from gapless.witnesses.seat import GRIP, KNOWN, LASTS, Seat

TICK, SPEED = 0.1, 15.0
STILL = np.zeros(3)


def turned(seat, c, axis, rate, ticks, speed=SPEED, lean=0.0):
    """Turn about an axis of the box at a rate; what came of it, when, and the attitude then."""
    for k in range(ticks):
        c = c @ about(axis, rate * TICK)
        found = seat.moved(c, 0.5 * DEG, lean, speed, rate * axis)
        if found is not None:
            return found, k, c
    return None, ticks, c


def rests(seat, c, ticks, lean=0.0):
    for k in range(ticks):
        found = seat.moved(c, 0.5 * DEG, lean, SPEED, STILL)
        if found is not None:
            return found, k
    return None, ticks


def known(c):
    seat = Seat()
    assert rests(seat, c, KNOWN + 20)[0] is None
    return seat


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]])
def test_a_turn_that_no_tyre_holds_is_a_hand_s(axis):
    """60 degrees in 0.6 s at 15 m/s: 26 m/s^2. What it felt comes back to the axes of before."""
    c, axis = about(np.array([0.0, 0.0, 1.0]), 1.0), np.array(axis)
    seat = known(c)
    assert turned(seat, c, axis, 100.0 * DEG, 6)[0] is None  # not before it is over
    now = c @ about(axis, 60.0 * DEG)
    found, k = rests(seat, now, 5)
    assert k == 0
    np.testing.assert_allclose(now @ found.T, c, atol=1e-12)  # the attitude of the box as it sat


def test_what_a_car_turns_is_a_car_s():
    """A hairpin at 5 m/s and 50 deg/s pulls 4.4 m/s^2; so does a slow one in a car park."""
    assert 5.0 * 50.0 * DEG < GRIP
    for speed in (5.0, 0.5):
        c = np.eye(3)
        seat = known(c)
        found, _, c = turned(seat, c, np.array([0.0, 0.0, 1.0]), 50.0 * DEG, 36, speed)
        assert found is None
        assert rests(seat, c, 50)[0] is None


def test_a_box_that_was_tipped_slowly_lies_on_another_side():
    c, axis = np.eye(3), np.array([1.0, 0.0, 0.0])
    seat = known(c)
    found, _, c = turned(seat, c, axis, 20.0 * DEG, 20)
    if found is None:
        found, _ = rests(seat, c, LASTS)
    np.testing.assert_allclose((c @ found.T)[2], [0.0, 0.0, 1.0], atol=0.15)
    assert rests(seat, c @ found.T, 100)[0] is None


def test_a_hill_or_a_filter_that_leans_is_none():
    axis = np.array([0.0, 1.0, 0.0])
    assert turned(known(np.eye(3)), np.eye(3), axis, 6.0 * DEG, 20)[0] is None  # 12 degrees
    tipped = about(axis, 40.0 * DEG)
    assert rests(known(np.eye(3)), tipped, 100, lean=40.0 * DEG)[0] is None  # the force does not agree
    fresh = Seat()
    assert rests(fresh, tipped, 2 * KNOWN)[0] is None  # nobody knows how it sat


def test_a_copy_goes_on_alone():
    seat = known(np.eye(3))
    twin, before = seat.copy(), seat.memory.copy()
    rests(twin, about(np.array([1.0, 0.0, 0.0]), 0.2), 20)
    assert np.array_equal(seat.memory, before)
    seat.forget()
    assert not seat.memory.any()
