"""Error-free increments give the trajectory they were made from."""

import numpy as np
import pytest
from strapdown import ORIGIN, Run

from gapless import attitude
from gapless.simulate.motion import Vehicle, increments, trajectory
from gapless.simulate.path import Path
from gapless.simulate.profiles import profile

DURATION, RATE, STEP = 1800.0, 200.0, 2000
BOX = Vehicle(imu=(1.2, 0.3, -0.6), mounting=(0.05, -0.08, 0.6))
"""Off the axle and askew, so that every axis sees rotation and specific force."""


@pytest.mark.parametrize("name", ["urban", "highway"])
def test_half_an_hour_within_a_millimetre_and_a_microradian(name):
    segments = profile(name)(DURATION, np.random.default_rng(1))
    path = Path.from_segments(segments, ORIGIN, heading=0.5, roll_gradient=0.005)
    imu = increments(path, RATE, BOX)
    truth = trajectory(path, np.concatenate([[0.0], imu.time[STEP - 1 :: STEP]]), BOX)
    assert len(truth.time) == 181
    run = Run(truth.lla[0], truth.v_n[0], truth.euler[0])
    q = attitude.from_euler(truth.euler)
    position, turn, k = 0.0, 0.0, 0
    for row in range(1, len(truth.time)):
        k = run.go(imu, k, k + STEP, period=1e9)
        position = max(position, np.linalg.norm(run.displacement(truth.lla[row])))
        turn = max(turn, np.linalg.norm(run.turn_from(q[row])))
    print(f"{name}: {position:.1e} m, {turn:.1e} rad")
    # Issue 2 asks for 1e-3 m and 1e-6 rad. What second order leaves is 6e-5 m and 3e-11 rad (coning
    # in rounded corners); a first-order slip anywhere in the earth's terms gave 4e-4 m and more.
    assert position < 2e-4
    assert turn < 1e-9
