"""What a log's gyros show of vibration."""

import numpy as np
import pytest

from gapless.sensors.vibration import gyro_density
from gapless.trip.recording import Imu


def log(rate: float, density: float, turn: float = 0.0) -> Imu:
    rng, n = np.random.default_rng(1), 20_000
    time = np.arange(1, n + 1) / rate
    gyro = rng.normal(0.0, density * np.sqrt(rate), (n, 3)) + turn * np.sin(0.5 * time)[:, None]
    return Imu.from_rates(time, gyro, np.zeros((n, 3)))


@pytest.mark.parametrize("rate", [100.0, 200.0])
def test_white_noise_is_read_whatever_the_rate_and_the_turns(rate):
    # 60,000 differences, each pair sharing a sample: 1 % is more than two deviations of the estimate
    assert gyro_density(log(rate, 2e-4, turn=0.05)) == pytest.approx(2e-4, rel=0.01)


def test_a_log_too_slow_to_tell_shaking_from_driving_says_nothing():
    assert gyro_density(log(10.0, 2e-4)) == 0.0


def test_a_hole_in_the_log_is_no_vibration():
    imu = log(100.0, 2e-4)
    time = imu.time.copy()
    time[10_000:] += 17.0
    gyro = imu.dtheta / imu.dt[:, None]
    gyro[10_000:] += 0.5
    holed = Imu.from_rates(time, gyro, np.zeros_like(gyro), imu.dt)
    assert gyro_density(holed) == pytest.approx(2e-4, rel=0.01)
