import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.errors import ConfigError
from gapless.sensors import corrupt, grade
from gapless.simulate import (
    CAR,
    Chassis,
    Receiver,
    Segment,
    Vehicle,
    WheelSensor,
    drive,
    increments,
    simulate,
    vibrate,
)

BOX = Vehicle(imu=(1.0, 0.0, -0.5), antenna=(0.5, 0.2, -1.6), mounting=(0.0, 0.02, 0.1))


def test_a_recording_is_whole():
    r = simulate("urban", "consumer", 120.0, 7, vehicle=BOX, wheels=WheelSensor())
    assert len(r.imu) == 12000
    assert len(r.gnss) == 121
    assert len(r.odometer) == 1201
    assert r.imu.rate == pytest.approx(100.0)
    assert r.grade == "consumer"
    assert r.reference_clock == "imu"
    assert np.array_equal(r.lever_arm, BOX.lever_arm)
    ref = r.reference
    assert len(ref) == 1201
    assert set(ref.source) == {"reference"}
    assert np.isin(ref.time[1:], r.imu.time).all()
    assert ref.euler[0, 2] == pytest.approx(np.pi / 4 + 0.1)


def test_the_perfect_grade_measures_the_truth():
    r = simulate("carpark", "perfect", 60.0, 2, rate=200.0, vehicle=BOX)
    exact = increments(drive("carpark", 60.0, 2), 200.0, BOX)
    assert np.array_equal(r.imu.dtheta, exact.dtheta)
    assert np.array_equal(r.imu.dvel, exact.dvel)


def test_the_same_seed_gives_the_same_bits():
    a, b, c = (simulate("urban", "consumer", 60.0, seed) for seed in (1, 1, 2))
    assert np.array_equal(a.imu.dvel, b.imu.dvel)
    assert np.array_equal(a.gnss.lla, b.gnss.lla)
    assert not np.array_equal(a.imu.dvel, c.imu.dvel)


def test_sensors_draw_from_streams_of_their_own():
    base = simulate("urban", "consumer", 60.0, 1)
    other = simulate("urban", "navigation", 60.0, 1, rate=100.0, wheels=WheelSensor())
    assert np.array_equal(base.gnss.lla, other.gnss.lla)
    assert np.array_equal(base.reference.lla, other.reference.lla)
    late = simulate("urban", "consumer", 60.0, 1, receiver=Receiver(position_delay=0.2))
    assert np.array_equal(base.imu.dvel, late.imu.dvel)


def test_without_a_chassis_the_grade_alone_shakes():
    """Four streams of a seed as they were before there was a fifth."""
    streams = [np.random.default_rng(s) for s in np.random.SeedSequence(4).spawn(4)]
    path = drive("carpark", 60.0, 4)
    true = increments(path, 100.0)
    expected, _ = corrupt(true, grade("consumer"), streams[1], path.along(true.time)[0])
    made = simulate("carpark", "consumer", 60.0, 4)
    assert np.array_equal(made.imu.dtheta, expected.dtheta)
    assert np.array_equal(made.imu.dvel, expected.dvel)


def test_a_chassis_shakes_in_the_place_of_the_grade_and_changes_nothing_else():
    odometer = WheelSensor()
    still, loud, again, other = (
        simulate("carpark", "consumer", 60.0, seed, vehicle=BOX, wheels=odometer, chassis=chassis)
        for seed, chassis in ((4, Chassis((), None, None)), (4, CAR), (4, CAR), (5, CAR))
    )
    calm = replace(grade("consumer"), gyro_vibration=0.0, accel_vibration=0.0)
    without = simulate("carpark", calm, 60.0, 4, vehicle=BOX, wheels=odometer)
    assert np.array_equal(still.imu.dvel, without.imu.dvel)
    assert np.array_equal(loud.imu.dvel, again.imu.dvel)
    assert not np.array_equal(loud.imu.dvel, still.imu.dvel)
    assert not np.array_equal(loud.imu.dvel, other.imu.dvel)
    assert np.array_equal(loud.gnss.lla, still.gnss.lla)
    assert np.array_equal(loud.odometer.speed, still.odometer.speed)
    assert np.array_equal(loud.reference.lla, still.reference.lla)


def test_a_perfect_sensor_measures_the_shaken_car():
    path = drive("carpark", 60.0, 2)
    of_chassis = np.random.default_rng(np.random.SeedSequence(2).spawn(5)[4])
    exact = vibrate(increments(path, 50.0, BOX), path, CAR, of_chassis, BOX)
    made = simulate("carpark", "perfect", 60.0, 2, rate=50.0, vehicle=BOX, chassis=CAR)
    assert np.array_equal(made.imu.dtheta, exact.dtheta)
    assert np.array_equal(made.imu.dvel, exact.dvel)


def test_segments_and_grades_of_ones_own():
    mine = replace(grade("perfect"), name="mine", rate=50.0)
    r = simulate([Segment(5.0), Segment(5.0, 1.0)], mine, 8.0)
    assert len(r.imu) == 400
    assert r.name == "custom-mine-1"
    # three seconds at 1 m/s^2 from a corner symmetric about 5 s: 3 m/s, and 4.5 m plus W^2 a / 24 or less
    assert_allclose(np.linalg.norm(r.reference.v_n[-1]), 3.0, atol=1e-12)


@pytest.mark.parametrize("duration", [0.0, -5.0, math.nan, math.inf, 1e12])
def test_a_drive_needs_a_duration(duration):
    with pytest.raises(ConfigError, match="positive duration of at most 86400 s"):
        simulate(duration=duration)


@pytest.mark.parametrize("duration", [1e-3, 0.01])
def test_a_drive_needs_two_samples(duration):
    with pytest.raises(ConfigError, match="no two IMU samples at 100 Hz; make it longer"):
        simulate(duration=duration)


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ({"receiver": Receiver(position_delay=math.nan)}, "receiver's delay cannot be nan, 0"),
        ({"receiver": Receiver(velocity_delay=math.inf)}, "receiver's delay cannot be 0, inf"),
        ({"vehicle": Vehicle(mounting=(0.0, math.nan, 0.0))}, "mounting cannot be 0, nan, 0"),
    ],
)
def test_delays_and_angles_are_finite(what, words):
    with pytest.raises(ConfigError, match=words):
        simulate(duration=5.0, **what)
