import numpy as np
import pytest

from gapless.trip.recording import Gnss, Imu, Recording, Trajectory

ORIGIN = np.array([np.radians(44.23), np.radians(-76.49), 95.0])


@pytest.fixture
def origin():
    return ORIGIN.copy()


@pytest.fixture
def trajectory():
    """Make a trajectory from positions, with NaN for whatever is not given."""

    def make(time, lla, v_n=None, euler=None, sd=None, horizontal=None, source="ins"):
        n = len(time)
        nan = np.full((n, 9), np.nan)
        return Trajectory(
            np.asarray(time, float),
            np.asarray(lla, float),
            nan[:, :3] if v_n is None else np.asarray(v_n, float),
            nan[:, :3] if euler is None else np.asarray(euler, float),
            nan if sd is None else np.asarray(sd, float),
            nan[:, 0] if horizontal is None else np.asarray(horizontal, float),
            np.full(n, source),
        )

    return make


@pytest.fixture
def recording():
    """Make a recording whose IMU is silent, from GNSS columns."""

    def make(time, lla, v_n=None, imu_time=None, **extra):
        n = len(time)
        three = np.ones((n, 3))
        v_n = np.full((n, 3), np.nan) if v_n is None else v_n
        gnss = Gnss(np.asarray(time, float), lla, 2.0 * three, v_n, 0.1 * three, np.ones(n, int))
        imu_time = np.arange(time[0], time[-1], 0.1) if imu_time is None else imu_time
        zero = np.zeros((len(imu_time), 3))
        return Recording("drive", Imu.from_rates(imu_time, zero, zero), gnss, **extra)

    return make
