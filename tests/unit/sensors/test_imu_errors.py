from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats

from gapless.sensors import allan_deviation, correct, corrupt, grade, grade_names, read_allan
from gapless.trip.recording import Imu

N, DT = 60_000, 0.01
PERFECT = grade("perfect")


def true_imu(n=N, seed=0):
    rng = np.random.default_rng(seed)
    time = DT * np.arange(1, n + 1)
    return Imu(
        time, np.full(n, DT), 1e-3 * rng.standard_normal((n, 3)), [0, 0, -0.098] + 0.01 * rng.random((n, 3))
    )


def rng(seed=1):
    return np.random.default_rng(seed)


def chi_square(sample, variance, probability=1e-4):
    low, high = stats.chi2.ppf([probability / 2, 1 - probability / 2], sample.size)
    return low < np.sum(sample**2) / variance < high


def test_perfect_changes_nothing():
    imu = true_imu()
    out, errors = corrupt(imu, PERFECT, rng())
    assert np.array_equal(out.dtheta, imu.dtheta)
    assert np.array_equal(out.dvel, imu.dvel)
    assert not errors.gyro_bias.any()


def test_white_noise_of_increments_grows_with_the_root_of_the_interval():
    imu = true_imu()
    uneven = replace(imu, dt=np.where(np.arange(N) % 2, 0.01, 0.03))
    out, _ = corrupt(uneven, replace(PERFECT, gyro_noise=2e-4, accel_noise=3e-3), rng())
    for rows in (slice(0, None, 2), slice(1, None, 2)):
        dt = uneven.dt[rows][0]
        assert chi_square((out.dtheta - imu.dtheta)[rows], 4e-8 * dt)
        assert chi_square((out.dvel - imu.dvel)[rows], 9e-6 * dt)


def test_turn_on_biases_and_matrices_have_their_spread():
    g = replace(
        PERFECT,
        gyro_bias_sd=0.1,
        accel_bias_sd=0.5,
        gyro_scale_sd=0.01,
        accel_scale_sd=0.02,
        misalignment_sd=0.003,
    )
    drawn = [corrupt(true_imu(4), g, rng(k))[1] for k in range(500)]
    off = ~np.eye(3, dtype=bool)
    assert chi_square(np.array([e.gyro_bias[0] for e in drawn]), 0.01)
    assert chi_square(np.array([e.accel_bias[0] for e in drawn]), 0.25)
    assert chi_square(np.array([np.diag(e.gyro_matrix) for e in drawn]), 1e-4)
    assert chi_square(np.array([np.diag(e.accel_matrix) for e in drawn]), 4e-4)
    assert chi_square(np.array([e.gyro_matrix[off] for e in drawn]), 9e-6)


def test_bias_varies_in_run_as_its_process_does():
    g = replace(PERFECT, gyro_instability=1e-3, gyro_instability_tau=5.0, accel_walk=0.01)
    out, errors = corrupt(true_imu(), g, rng())
    phi = np.exp(-DT / 5.0)
    assert chi_square(errors.gyro_bias[1:] - phi * errors.gyro_bias[:-1], 1e-6 * (1 - phi**2))
    assert chi_square(np.diff(errors.accel_bias, axis=0), 1e-4 * DT)
    # rounding of 0.1 m/s in increments
    assert_allclose(out.dvel - true_imu().dvel, errors.accel_bias * DT, atol=1e-16)


@pytest.mark.parametrize("name", grade_names())
def test_correct_undoes_all_but_noise(name):
    quiet = replace(
        grade(name),
        gyro_noise=0.0,
        accel_noise=0.0,
        gyro_vibration=0.0,
        accel_vibration=0.0,
        gyro_quantum=0.0,
        accel_quantum=0.0,
    )
    imu = true_imu(2000)
    back = correct(*corrupt(imu, quiet, rng()))
    assert_allclose(back.dtheta, imu.dtheta, atol=1e-16)
    assert_allclose(back.dvel, imu.dvel, atol=1e-15)


def test_quantisation_never_loses_more_than_a_step():
    imu = true_imu()
    out, _ = corrupt(imu, replace(PERFECT, gyro_quantum=1e-4, accel_quantum=1e-3), rng())
    assert_allclose(out.dtheta / 1e-4, np.rint(out.dtheta / 1e-4), atol=1e-6)
    left = np.cumsum(imu.dtheta - out.dtheta, axis=0)
    assert left.min() > -1e-10  # a running sum of 60 rad in double precision
    assert left.max() < 1e-4 + 1e-10


def test_vibration_grows_with_speed_and_leaves_no_velocity_behind():
    imu = true_imu()
    speed = np.where(np.arange(N) < N // 2, 0.0, 15.0)
    out, _ = corrupt(imu, replace(PERFECT, accel_vibration=0.5), rng(), speed)
    shaken = (out.dvel - imu.dvel) / DT
    # 300 s of a 22 Hz band: sd of an rms below 1 %, four of them
    assert shaken[: N // 2].std() == pytest.approx(0.05, rel=0.04)
    assert shaken[N // 2 :].std() == pytest.approx(0.5, rel=0.04)
    # sd 0.5 / (2 pi 8 Hz) = 0.01 m/s at most, and as much again where the speed jumps
    assert np.abs(np.cumsum(out.dvel - imu.dvel, axis=0)).max() < 0.1


def test_taking_one_error_away_leaves_the_others():
    full = grade("consumer")
    a = corrupt(true_imu(500), full, rng())[1]
    b = corrupt(true_imu(500), replace(full, gyro_noise=0.0, gyro_instability=0.0, accel_walk=1e-5), rng())[1]
    assert np.array_equal(a.gyro_matrix, b.gyro_matrix)
    assert np.array_equal(a.accel_matrix, b.accel_matrix)


def test_the_same_generator_gives_the_same_bits():
    a, b = (corrupt(true_imu(500), grade("consumer"), rng())[0] for _ in range(2))
    assert np.array_equal(a.dvel, b.dvel)


def test_allan_deviation_reads_the_datasheet_back():
    n = 360_000
    still = Imu(DT * np.arange(1, n + 1), np.full(n, DT), np.zeros((n, 3)), np.zeros((n, 3)))
    g = grade("liu2019")
    out, _ = corrupt(still, g, rng())
    # below 0.2 s the noise stands a hundred times above the drift; n / 16 averages or more: 2 %
    tau = DT * np.array([1, 2, 4, 8, 16])
    for increments, density in ((out.dtheta, g.gyro_noise), (out.dvel, g.accel_noise)):
        for axis in increments.T:
            assert read_allan(*allan_deviation(axis / DT, DT, tau)).noise == pytest.approx(density, rel=0.03)
