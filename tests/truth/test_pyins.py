"""Another strapdown (python-ins), fed the same increments and the same gravity, goes the same way."""

import numpy as np
import pandas as pd
import pytest
from strapdown import ORIGIN, Run

from gapless import attitude, earth
from gapless.simulate.motion import Vehicle, increments, trajectory
from gapless.simulate.path import Path
from gapless.simulate.profiles import profile

pyins_integrate = pytest.importorskip("pyins._numba_integrate")
DEG = np.pi / 180.0
BOX = Vehicle(imu=(1.2, 0.3, -0.6), mounting=(0.02, -0.03, 0.1))


@pytest.fixture
def same_gravity(monkeypatch):
    """Theirs is linear in height; give it ours, and let numba compile it anew."""
    njit = pyins_integrate.numba.njit
    magnitude = njit(lambda lat, alt: earth.gravity(np.sin(lat * DEG), alt))
    monkeypatch.setattr(pyins_integrate, "gravity", magnitude)
    integrate = njit(pyins_integrate.integrate.py_func)
    strapdown = pytest.importorskip("pyins.strapdown")
    monkeypatch.setattr(strapdown, "integrate", integrate)
    return strapdown


def test_ten_minutes_to_a_millimetre(same_gravity):
    segments = profile("urban")(600.0, np.random.default_rng(1))
    path = Path.from_segments(segments, ORIGIN, heading=0.5, roll_gradient=0.005)
    imu = increments(path, 200.0, BOX)
    n = 120_000
    truth = trajectory(path, np.array([0.0]), BOX)
    run = Run(truth.lla[0], truth.v_n[0], truth.euler[0])
    run.go(imu, 0, n, period=1e9)

    names = pd.Index([0.0, *imu.time[:n]], name="time")
    rows = np.vstack([np.zeros(6), np.column_stack([imu.dtheta[:n], imu.dvel[:n]])])
    columns = ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"]
    theirs = same_gravity.compute_increments_from_imu(
        pd.DataFrame(rows, index=names, columns=columns), "increment"
    )
    degrees = np.concatenate([truth.lla[0, :2] / DEG, truth.lla[0, 2:], truth.v_n[0], truth.euler[0] / DEG])
    names = ["lat", "lon", "alt", "VN", "VE", "VD", "roll", "pitch", "heading"]
    integrator = same_gravity.Integrator(pd.Series(degrees, index=names, name=0.0))
    last = integrator.integrate(theirs).iloc[-1].to_numpy()

    apart = run.displacement(np.array([last[0] * DEG, last[1] * DEG, last[2]]))
    print(f"apart {np.linalg.norm(apart):.1e} m")
    # The bar is issue 2's. Theirs takes Coriolis at the velocity of the sample's start, which costs
    # omega_ie dt = 4e-7 of the displacement (0.7 mm at 1.9 km), and has no third-order rotation term.
    assert np.linalg.norm(apart) < 1e-3
    q = attitude.from_euler(last[6:9] * DEG)
    assert np.linalg.norm(run.turn_from(q)) < 2e-9  # tilt that belongs to 1 mm is 1.6e-10
