"""The clock offset on synthetic curves: found where motion shows it, vague where it does not."""

import numpy as np
import pytest

from gapless.alignment.clock import Curve, offset, without_spikes

CLOCK = np.arange(0.0, 300.0, 0.05)


def velocity(t):
    """Starts, stops and bends, on scales of five to forty seconds."""
    return np.column_stack([8.0 * np.sin(0.31 * t) + 3.0 * np.sin(0.9 * t + 1.0), 6.0 * np.cos(0.23 * t)])


def readings(shift, rate=5.0, noise=0.1, seed=0):
    """Stamps that lie `shift` before the instant that a reading holds for."""
    t = np.arange(5.0, 295.0, 1.0 / rate)
    return t - shift, velocity(t) + np.random.default_rng(seed).normal(0.0, noise, (len(t), 2))


def drifting(t):
    """An inertial velocity: bias and tilt make it wander off slowly."""
    return velocity(t) + np.column_stack([0.02 * t, 5.0 - 0.01 * t])


CURVE = Curve(CLOCK, drifting(CLOCK))


@pytest.mark.parametrize("shift", [-0.6, -0.15, 0.0, 0.013, 0.21, 1.1])
def test_shift_is_found(shift):
    time, value = readings(shift)
    found = offset(CURVE, time, value, 1)
    # 1450 readings with 0.1 m/s on accelerations of 2.6 m/s^2 RMS know it to a millisecond
    assert abs(found.value - shift) < 0.005
    assert found.sd < 0.005


def test_moving_the_stamps_moves_the_offset():
    time, value = readings(-0.2)
    base = offset(CURVE, time, value, 1).value
    for move in (-0.3, 0.3):
        assert abs(offset(CURVE, time + move, value, 1).value - base + move) < 2e-3


def test_stated_deviation_is_honest():
    """Forty draws of the noise: errors as large as stated, within what forty can tell."""
    found = [offset(CURVE, *readings(0.21, rate=1.0, noise=0.3, seed=s), 1) for s in range(40)]
    z = np.array([(f.value - 0.21) / f.sd for f in found])
    assert 0.6 < np.sqrt(np.mean(z**2)) < 1.5


def test_standing_still_says_nothing():
    curve = Curve(CLOCK, np.column_stack([0.01 * CLOCK, 0.0 * CLOCK]))
    time = np.arange(5.0, 295.0, 1.0)
    found = offset(curve, time, np.random.default_rng(3).normal(0.0, 0.1, (len(time), 2)), 1)
    assert found.sd > 0.1


def test_an_offset_beyond_the_span_is_not_claimed():
    time, value = readings(3.0)
    assert offset(CURVE, time, value, 1, span=0.8, windows=(10.0,)).sd == np.inf


def test_nothing_at_all():
    assert offset(CURVE, np.zeros(0), np.zeros((0, 2)), 1).sd == np.inf
    assert offset(CURVE, np.array([10.0, 11.0]), np.zeros((2, 2)), 1).sd == np.inf


def test_spikes_do_not_hide_it():
    time, value = readings(-0.15, rate=1.0)
    rng = np.random.default_rng(6)
    for k in rng.choice(len(time), len(time) // 25, replace=False):
        value[k] += rng.choice([-1.0, 1.0], 2) * rng.uniform(15.0, 400.0, 2)
    assert abs(offset(CURVE, time, value, 1).value + 0.15) < 0.01


def test_spikes_alone_are_left_out():
    time, value = readings(0.0, rate=1.0)
    value[17] += 100.0
    value[40] -= 30.0
    kept, left = without_spikes(time, value)
    assert np.array_equal(kept, np.delete(time, [17, 40]))
    assert np.array_equal(left, np.delete(value, [17, 40], axis=0))


def test_a_hole_in_the_imu_log_is_stepped_over():
    hole = (CLOCK > 100.0) & (CLOCK < 117.0)
    time, value = readings(0.21)
    found = offset(Curve(CLOCK[~hole], drifting(CLOCK)[~hole]), time, value, 1)
    assert abs(found.value - 0.21) < 0.005
