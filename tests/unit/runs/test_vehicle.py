from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gapless.errors import ConfigError
from gapless.runs.vehicle import car_euler, vehicle_attitude
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Solution


@pytest.fixture
def solution():
    rng = np.random.default_rng(4)
    n = 50
    euler = rng.uniform([-0.5, -0.5, -3.0], [0.5, 0.5, 3.0], (n, 3))
    sd = np.full((n, 9), 0.01)
    mounting = rng.uniform(-0.3, 0.3, (n, 2))
    unknown, source = np.zeros((n, 3)), np.full(n, "gnss")
    path = Trajectory(np.arange(n) * 0.1, unknown, unknown, euler, sd, np.zeros(n), source)
    states = {"mounting": mounting}, {"mounting": np.full((n, 2), 0.02)}
    return Solution("drive", "test", path, *states, {}, (), (), 0.0)


def test_agrees_with_scipy(solution):
    """Oracle: C_bv turns by yaw, then pitch; SciPy's intrinsic ZYX is the sequence of C_nb."""
    turned = vehicle_attitude(solution).trajectory
    box = Rotation.from_euler("ZYX", solution.trajectory.euler[:, ::-1])
    pitch, yaw = solution.states["mounting"].T
    fixed = Rotation.from_euler("ZYX", np.column_stack([yaw, pitch, np.zeros_like(yaw)]))
    expected = (box * fixed).as_euler("ZYX")[:, ::-1]
    # rounding in a product of two rotations
    assert np.abs(turned.euler - expected).max() < 1e-14


def test_adds_the_uncertainty_of_the_mounting(solution):
    sd = vehicle_attitude(solution).trajectory.sd
    assert np.allclose(sd[:, 7:], np.hypot(0.01, 0.02), rtol=1e-15)
    assert np.array_equal(sd[:, :7], solution.trajectory.sd[:, :7])


def test_says_so_and_leaves_the_rest(solution):
    turned = vehicle_attitude(solution)
    assert [d.name for d in turned.decisions] == ["attitude"]
    assert turned.trajectory.lla is solution.trajectory.lla


def test_needs_mounting_angles(solution):
    with pytest.raises(ConfigError, match="no mounting angles"):
        vehicle_attitude(replace(solution, states={}))


def test_a_box_along_the_car_is_the_car():
    euler = np.array([[0.1, -0.2, 3.0]])
    # Euler angles to a matrix and back: rounding
    assert np.allclose(car_euler(euler, np.zeros((1, 2))), euler, rtol=0.0, atol=1e-15)
