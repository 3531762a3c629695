"""Error-free increments give the trajectory they were made from."""

import numpy as np
import pytest
from strapdown import Run, circuit

from gapless import attitude
from gapless.simulate.motion import Vehicle, increments, trajectory

DURATION, RATE = 1800.0, 200.0
BOX = Vehicle(imu=(1.2, 0.3, -0.6), mounting=(0.05, -0.08, 0.6))
"""Off the axle and askew, so that every axis sees rotation and specific force."""


@pytest.fixture(scope="module")
def errors():
    """Largest position error [m] and attitude error [rad] at every tenth second."""
    path = circuit(DURATION)
    imu = increments(path, RATE, BOX)
    truth = trajectory(path, np.concatenate([[0.0], imu.time[1999::2000]]), BOX)
    run = Run(truth.lla[0], truth.v_n[0], truth.euler[0])
    q = attitude.from_euler(truth.euler)
    position, turn, k, row = [], [], 0, 0
    while row + 1 < len(truth.time):
        k, row = run.go(imu, k, k + 2000), row + 1
        position.append(np.linalg.norm(run.displacement(truth.lla[row])))
        turn.append(np.linalg.norm(run.turn_from(q[row])))
    print(f"after {imu.time[k - 1]:.0f} s: {max(position):.2e} m, {max(turn):.2e} rad")
    return position, turn


def test_position_within_a_millimetre(errors):
    assert len(errors[0]) >= 180
    assert max(errors[0]) < 1e-3  # issue 2: 1 mm in 30 min


def test_attitude_within_a_microradian(errors):
    assert max(errors[1]) < 1e-6  # issue 2: 1e-6 rad in 30 min
