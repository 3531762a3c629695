"""When the car's constraints speak, and how firmly."""

import numpy as np
import pytest

from gapless import attitude
from gapless.earth import gravity
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief
from gapless.inertial.layout import Layout
from gapless.inertial.trail import Trail
from gapless.measurements.nonholonomic import NonHolonomic
from gapless.measurements.odometer import Odometer
from gapless.trip.events import Motion, Reading

LAYOUT = Layout(("mounting", "axle", "odometer_scale", "odometer_offset"))


def driving(speed, heading=0.4):
    b = Belief(LAYOUT)
    b.x[:3] = 0.6, 0.2, 50.0
    b.x[3:6] = speed * np.array([np.cos(heading), np.sin(heading), 0.0])
    b.x[6:10] = attitude.from_euler([0.0, 0.0, heading])
    return b


def motion(time, turn=0.0):
    return Motion(time, 0.1, np.array([0.0, 0.0, turn, 0.0, 0.0, -9.8]))


def test_says_nothing_to_a_car_that_stands_and_speaks_to_one_that_backs_up():
    constraint = NonHolonomic(min_speed=1.0)
    assert constraint.tick(driving(0.9), motion(0.0)) is None
    assert constraint.tick(driving(1.1), motion(0.0)) is not None
    assert constraint.tick(driving(-5.0), motion(1.0)) is not None


def test_speaks_no_more_often_than_it_may():
    constraint = NonHolonomic(interval=0.3)
    said = [constraint.tick(driving(8.0), motion(0.1 * k)) is not None for k in range(10)]
    assert said == [k % 3 == 0 for k in range(10)]


def test_is_softer_in_turns_and_alike_in_both_senses():
    def lateral(turn):
        return NonHolonomic(lateral=0.06, turn=0.1).tick(driving(10.0), motion(0.0, turn)).R[0, 0]

    assert lateral(0.3) == lateral(-0.3)
    # 0.1 s of 10 m/s x 0.3 rad/s beside what a straight has
    assert lateral(0.3) == pytest.approx(lateral(0.0) + (0.1 * 3.0) ** 2, rel=1e-12)


def test_sideways_and_upward_slip_are_named_in_the_car():
    b = driving(10.0)
    b.x[3:6] += attitude.to_matrix(b.x[6:10]) @ [0.0, 0.2, -0.1]
    z = NonHolonomic().tick(b, motion(0.0)).z
    np.testing.assert_allclose(z, [-0.2, 0.1], atol=1e-12)


def test_a_mounting_that_is_known_turns_the_slip_away():
    b = driving(10.0)
    b.block("mounting")[1] = 0.05
    b.x[6:10] = attitude.from_euler([0.0, 0.0, 0.4 - 0.05])
    np.testing.assert_allclose(NonHolonomic().tick(b, motion(0.0)).z, 0.0, atol=1e-12)


def test_odometer_knows_its_scale_and_shares_what_comes_fast():
    b = driving(10.0)
    b.block("odometer_scale")[0] = 0.02
    sensor = Odometer(sd=0.2, correlation=1.0, jitter=0.0)
    reading = Reading("odometer", 0.0, np.array([10.0 / 1.02]), np.ones(1), 2.0)
    assert abs(sensor.observe(b, reading).z[0]) < 1e-12
    assert sensor.observe(b, reading).R[0, 0] == pytest.approx(0.04)
    assert sensor.observe(b, reading._replace(interval=0.1)).R[0, 0] == pytest.approx(0.4)


def test_an_offset_is_one_of_wheels_that_roll():
    b, still = driving(10.0), driving(0.0)
    for belief in (b, still):
        belief.block("odometer_offset")[0] = 0.12
    stop = Odometer().observe(still, Reading("odometer", 0.0, np.zeros(1), np.ones(1), 1.0))
    assert stop.z[0] == 0.0  # wheels at rest say that the car stands, and nothing of the offset
    assert stop.H[0, LAYOUT.blocks["odometer_offset"]] == 0.0
    short = Odometer().observe(b, Reading("odometer", 0.0, np.array([9.88]), np.ones(1), 1.0))
    assert abs(short.z[0]) < 0.12 * 0.5**2 / 9.88**2  # what is not there yet of an offset that grows with v^2


def test_a_wheel_aside_of_the_box_is_believed_less_in_turns():
    b, sensor = driving(10.0), Odometer(sd=0.2, correlation=0.0, side=0.5)
    reading = Reading("odometer", 0.0, np.array([10.0]), np.ones(1), 1.0)
    straight = sensor.observe(b, reading).R[0, 0]
    b.memory[at.PREV_DT] = 0.01
    b.memory[at.PREV_VEL : at.PREV_VEL + 3] = 0.01 * np.array([0.0, 0.0, -gravity(np.sin(0.6), 50.0)])
    b.memory[at.PREV_THETA : at.PREV_THETA + 3] = 0.01 * np.array([0.0, 0.0, -0.3])
    assert sensor.observe(b, reading).R[0, 0] == pytest.approx(straight + (0.5 * 0.3) ** 2, rel=1e-9)


def test_the_trail_is_the_mean_velocity_of_a_window():
    """Of a velocity quadratic in time, corrections left out; marks at uneven times."""
    trail, rng = Trail(2.0), np.random.default_rng(4)
    times = np.sort(rng.uniform(0.0, 5.0, 2000))

    def v(t):
        return np.array([3.0 * t, t * t, -t])

    corrected = np.zeros(3)
    for k, t in enumerate(times):
        if k % 300 == 299:
            step = rng.normal(size=3)
            trail.shift(step)
            corrected += step
        trail.mark(float(t), v(t) + corrected)
    now, window = times[-1], 1.3
    ts = np.linspace(now - window, now, 20001)
    mean = np.array([np.mean(c) for c in v(ts)])
    lag, lag_force = trail.lag(window)
    # trapezia of 2.5 ms: 2 (2.5e-3)^2 / 12; the mean of 20001 points is as good
    np.testing.assert_allclose(lag, v(now) - mean, atol=1e-4)
    np.testing.assert_allclose(lag - lag_force, [0.0, 0.0, 9.8 * window / 2.0], rtol=1e-9, atol=1e-12)
    assert all(np.array_equal(a, np.zeros(3)) for a in trail.lag(0.0))
