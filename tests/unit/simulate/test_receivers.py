from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose

from gapless import earth
from gapless.simulate import Receiver, Vehicle, WheelSensor, drive, fixes, odometer, point, spikes, withhold

PATH = drive("urban", 900.0, seed=3)
CAR = Vehicle(imu=(1.0, 0.0, -0.5), antenna=(0.5, 0.2, -1.6), mounting=(0.0, 0.0, 0.1))
ZERO = (0.0, 0.0, 0.0)
EXACT = Receiver(position_white=ZERO, position_correlated=ZERO, velocity=ZERO)


def rng():
    return np.random.default_rng(11)


def metres(lla, true):
    r_m, r_n = earth.radii(np.sin(true[:, 0]))
    return (lla - true) * np.column_stack([r_m, r_n * np.cos(true[:, 0]), -np.ones(len(true))])


def test_an_exact_receiver_tells_the_antenna_at_the_delayed_time():
    late = Receiver(
        position_white=ZERO,
        position_correlated=ZERO,
        velocity=ZERO,
        position_delay=0.35,
        velocity_delay=0.6,
        rate=5.0,
    )
    gnss = fixes(PATH, late, rng(), CAR)
    assert gnss.time[0] >= 0.6
    lla, _, _ = point(PATH, gnss.time - 0.35, CAR.antenna)
    _, v_n, _ = point(PATH, gnss.time - 0.6, CAR.antenna)
    assert np.array_equal(gnss.lla, lla)
    assert_allclose(gnss.v_n, v_n, atol=1e-15)


def test_an_early_stamp_is_a_negative_delay():
    early = Receiver(position_delay=-0.3, velocity_delay=-0.3)
    gnss = fixes(PATH, early, rng(), CAR)
    assert gnss.time[0] == 0.0
    assert gnss.time[-1] <= PATH.duration - 0.3


def test_averaged_velocity_is_displacement_over_the_window():
    window = 1.0
    gnss = fixes(PATH, replace(EXACT, velocity_window=window), rng(), CAR)
    end, _, _ = point(PATH, gnss.time, CAR.antenna)
    start, _, _ = point(PATH, gnss.time - window, CAR.antenna)
    # eight nodes over corners of 1 s: 1e-5; radii along 17 m: (17 m / 6.4e6 m) of 17 m/s is 5e-5
    assert_allclose(gnss.v_n[:, :2], metres(end, start)[:, :2] / window, atol=1e-4)


def test_errors_are_as_large_as_stated():
    receiver = Receiver(rate=10.0, correlation_time=2.0)
    path = drive("static", 3000.0)
    gnss = fixes(path, receiver, rng(), CAR)
    true, _, _ = point(path, gnss.time, CAR.antenna)
    z = metres(gnss.lla, true) / gnss.sd_position
    # 3000 s at a correlation time of 2 s are 1500 independent draws or more: sd of an sd 2 %, four of them
    assert_allclose(z.std(axis=0), 1.0, atol=0.08)
    assert_allclose((gnss.v_n / gnss.sd_velocity).std(axis=0), 1.0, atol=4 / np.sqrt(2 * len(gnss)))
    # neighbours 0.1 s apart share the correlated part: exp(-0.05) * 1 / 1.25 north, sd of the estimate 2 %
    lag = np.mean(z[1:, 0] * z[:-1, 0]) / np.mean(z[:, 0] ** 2)
    assert abs(lag - np.exp(-0.05) / 1.25) < 0.08


def test_stated_sigmas_can_lie():
    gnss = fixes(PATH, Receiver(stated=0.5), rng(), CAR)
    assert_allclose(gnss.sd_position[0, 0], 0.5 * np.hypot(0.5, 1.0))


def test_spikes_strike_where_they_say_and_as_hard_as_asked():
    gnss = fixes(PATH, EXACT, rng(), CAR)
    bad, struck = spikes(gnss, rng(), 12, position=(20.0, 500.0), velocity=(10.0, 400.0))
    assert len(struck) == 12
    assert np.all(np.diff(struck) > 0)
    jump = np.linalg.norm(metres(bad.lla, gnss.lla), axis=1)
    kick = np.linalg.norm(bad.v_n - gnss.v_n, axis=1)
    good = np.setdiff1d(np.arange(len(gnss)), struck)
    assert not jump[good].any()
    assert not kick[good].any()
    # on a height of some tens of metres the radii above differ by 1e-5
    assert np.all((jump[struck] > 19.99) & (jump[struck] < 500.1))
    assert np.all((kick[struck] >= 10.0 - 1e-9) & (kick[struck] <= 400.0 + 1e-9))
    assert np.array_equal(bad.sd_position, gnss.sd_position)


def test_spikes_leave_alone_what_is_not_asked_for():
    gnss = fixes(PATH, EXACT, rng(), CAR)
    bad, _ = spikes(gnss, rng(), 5, velocity=(10.0, 10.0))
    assert np.array_equal(bad.lla, gnss.lla)


def test_withheld_fixes_are_gone_and_no_others():
    gnss = fixes(PATH, EXACT, rng(), CAR)
    left = withhold(gnss, [(100.0, 160.0), (300.0, 310.0)], start=0.5)
    gone = np.setdiff1d(gnss.time, left.time)
    assert np.array_equal(gone, np.concatenate([np.arange(101.0, 161.0), np.arange(301.0, 311.0)]))


def test_odometer_has_its_scale_delay_and_steps():
    sensor = WheelSensor(scale=0.02, delay=-0.3, noise=0.0, quantum=0.05)
    read = odometer(PATH, sensor, rng())
    assert_allclose(read.speed, 1.02 * PATH.speed(read.time + 0.3), atol=0.025 + 1e-12)  # half a step
    assert_allclose(read.speed / 0.05, np.rint(read.speed / 0.05), atol=1e-9)
    short = odometer(PATH, WheelSensor(offset=-0.12, noise=0.0), rng())
    assert_allclose(short.speed, np.maximum(PATH.speed(short.time) - 0.12, 0.0), atol=1e-12)
    noisy = odometer(PATH, WheelSensor(noise=0.1), rng())
    error = noisy.speed - PATH.speed(noisy.time)
    assert abs(error.std() / 0.1 - 1.0) < 4 / np.sqrt(2 * len(error))  # four sigma of an sd
