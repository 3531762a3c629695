"""The mean of a velocity over an epoch, from what the trail keeps."""

import numpy as np
import pytest

from gapless.inertial.trail import GRAVITY, Trail


def drive(trail: Trail, acceleration: np.ndarray, end: float = 3.0) -> None:
    for t in np.arange(0.0, end + 1e-9, 0.1):
        trail.mark(float(t), np.array([10.0, 0.0, 0.0]) + acceleration * t)


def test_lag_of_steady_acceleration_is_half_of_what_the_window_gained():
    trail, a = Trail(2.0), np.array([2.0, -1.0, 0.5])
    drive(trail, a)
    lag, force = trail.lag(1.05)
    assert lag == pytest.approx(0.5 * 1.05 * a, abs=1e-12)  # the trapezium is exact for a straight line
    assert force == pytest.approx(lag - [0.0, 0.0, 0.5 * 1.05 * GRAVITY], abs=1e-12)


def test_a_correction_is_no_motion():
    trail = Trail(2.0)
    trail.mark(0.0, np.array([10.0, 0.0, 0.0]))
    trail.shift(np.array([3.0, 0.0, 0.0]))
    trail.mark(1.0, np.array([13.0, 0.0, 0.0]))
    assert trail.lag(1.0)[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_it_forgets_what_is_older_than_its_length():
    trail = Trail(1.0)
    drive(trail, np.zeros(3), 60.0)
    assert len(trail.marks) < 15


def test_no_window_costs_nothing_and_lags_nothing():
    trail = Trail()
    drive(trail, np.ones(3))
    assert not len(trail.marks)
    assert not trail.lag(0.0)[0].any()


def test_a_copy_goes_its_own_way():
    trail = Trail(2.0)
    drive(trail, np.ones(3))
    other = trail.copy()
    other.shift(np.ones(3))
    other.mark(9.0, np.zeros(3))
    assert trail.marks[-1, 0] == pytest.approx(3.0)
    assert not trail.corrected.any()
