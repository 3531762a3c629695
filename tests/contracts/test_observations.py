"""Every sensor and constraint: H is the finite difference, z vanishes at the truth, R is a covariance."""

import numpy as np
import pytest
from scipy.optimize import brentq

from gapless import attitude
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief, inject
from gapless.inertial.layout import EXTRAS, Layout
from gapless.measurements.gnss import Position, Velocity
from gapless.measurements.nonholonomic import NonHolonomic
from gapless.measurements.odometer import Odometer
from gapless.measurements.stillness import Stillness
from gapless.measurements.vehicle import CRAWL, axes
from gapless.measurements.zero_velocity import zero_velocity
from gapless.simulate import Vehicle, drive, increments, point, trajectory
from gapless.trip.events import Motion, Reading

FULL, CORE = Layout(tuple(EXTRAS)), Layout()
ANGLES, AXLE, LEVER, SCALE, SHORT = (0.04, -0.07), -1.3, np.array([-0.8, 0.4, -1.1]), -0.02, 0.12
CAR = Vehicle(
    imu=(1.3, 0.0, 0.0),
    antenna=tuple(np.array([1.3, 0.0, 0.0]) + axes(*ANGLES) @ LEVER),
    mounting=tuple(attitude.matrix_to_euler(axes(*ANGLES))),
)
PATH = drive("urban", 120.0, seed=6)
DT = 0.002
"""Short samples: a sensor takes the rate of the last one for that of the instant."""


def truth(layout, t, car=CAR, path=PATH):
    """The belief that knows everything at time t, and what the IMU felt up to it."""
    there = trajectory(path, np.array([t]), car)
    imu = increments(path, 1.0 / DT, car)
    k = int(np.searchsorted(imu.time, t - 1e-6))
    b = Belief(layout)
    b.x[:3], b.x[3:6], b.x[6:10] = there.lla[0], there.v_n[0], attitude.from_euler(there.euler[0])
    known = {
        "mounting": ANGLES,
        "axle": AXLE,
        "lever_arm": LEVER,
        "odometer_scale": SCALE,
        "odometer_offset": SHORT,
    }
    for name, value in known.items():
        if name in layout:
            b.block(name)[:] = value
    b.memory[at.TIME], b.memory[at.PREV_DT] = t, DT
    b.memory[at.PREV_THETA : at.PREV_THETA + 3] = imu.dtheta[k]
    b.memory[at.PREV_VEL : at.PREV_VEL + 3] = imu.dvel[k]
    return b, Motion(t, 0.1, np.concatenate([imu.dtheta[k], imu.dvel[k]]) / DT)


def reading(channel, t, value):
    value = np.atleast_1d(value)
    return Reading(channel, t, value, np.linspace(0.5, 1.5, len(value)), 1.0)


def wheels_say(speed, layout):
    """The reading r with r (1 + s) + o r^2 / (r^2 + CRAWL^2) = speed."""
    if "odometer_scale" not in layout:
        return speed
    whole = lambda r: r * (1.0 + SCALE) + SHORT * r * r / (r * r + CRAWL * CRAWL) - speed  # noqa: E731
    return brentq(whole, 0.0, 2.0 * speed, xtol=1e-12)


def observers(t):
    """By name: a function of belief and motion."""
    lla, v_n, _ = point(PATH, np.array([t]), CAR.antenna)
    speed = float(PATH.along(np.array([t]))[0][0])
    fixed = {"mounting": ANGLES}
    return {
        "position": lambda b, m: Position(LEVER).observe(b, reading("position", t, lla[0])),
        "velocity": lambda b, m: Velocity(LEVER).observe(b, reading("velocity", t, v_n[0])),
        "odometer": lambda b, m: Odometer(**fixed).observe(
            b, reading("odometer", t, wheels_say(speed, b.layout))
        ),
        "nonholonomic": lambda b, m: NonHolonomic(axle=AXLE, **fixed).tick(b, m),
    }


MOMENTS = (60.0, 71.0, 78.0)
"""Straight on, slowing down, in a bend."""


@pytest.mark.parametrize("layout", [FULL, CORE])
@pytest.mark.parametrize("name", ["position", "velocity", "odometer", "nonholonomic"])
def test_nothing_is_left_at_the_truth(name, layout):
    for t in MOMENTS:
        z = observers(t)[name](*truth(layout, t)).z
        # The earth's rate times the lever arms, 7e-5 x 1.4; a rate that is half a sample old, 0.3
        # rad/s^2 x 1 ms x 1.4 m. A lever arm l laid along the ground leaves l^2 / R = 3e-7 m.
        assert np.abs(z).max() < (5e-7 if name == "position" else 6e-4), (t, z)


def test_nothing_is_left_of_a_standstill():
    b, motion = truth(FULL, 10.0)
    z, _, _ = zero_velocity(b.x, FULL.n, motion.rate, 0.1, 0.01)
    assert np.abs(z).max() < 1e-9  # increments are exact to 1e-12 rad in 2 ms


def askew(layout, seed):
    """A belief away from the truth, standing for any linearisation point."""
    rng = np.random.default_rng(seed)
    b, motion = truth(layout, 78.0)
    dx = rng.normal(0.0, 0.05, layout.n)
    dx[:3] *= 20.0
    dx[6:9] = 0.15, -0.1, 0.2
    inject(b.x, dx)
    return b, motion._replace(felt=np.concatenate([rng.normal(0.0, 0.3, 3), motion.force]))


def moved(b, motion, dx):
    """The belief (+) dx, and the corrected rate that a change of gyro bias or scale takes along."""
    other = b.copy()
    inject(other.x, dx)
    turn = dx[9:12]
    other.memory[at.PREV_THETA : at.PREV_THETA + 3] -= turn * b.memory[at.PREV_DT]
    return other, motion._replace(felt=np.concatenate([motion.rate - turn, motion.force]))


@pytest.mark.parametrize("layout", [FULL, CORE])
@pytest.mark.parametrize("name", ["position", "velocity", "odometer", "nonholonomic", "zero_velocity"])
def test_h_is_the_finite_difference(name, layout):
    look = {
        **observers(78.0),
        "zero_velocity": lambda b, m: zero_velocity(b.x, b.layout.n, m.rate, 0.1, 0.01),
    }[name]
    b, motion = askew(layout, 4)
    h = look(b, motion)[1]
    step = 1e-5
    for j in range(layout.n):
        dx = step * np.eye(layout.n)[j]
        ahead, back = (look(*moved(b, motion, sign * dx))[0] for sign in (1.0, -1.0))
        # Central differences leave step^2 v = 1e-9 of a rotation and 1e-9 m / step of a latitude; H
        # leaves out how the axes turn with the vehicle's place (1 m of 1 s of the earth: v / R = 2e-6)
        # and how the earth's rate in the box turns with its attitude, 7.3e-5 rad/s.
        if name == "velocity" and j in range(*layout.blocks.get("lever_arm", slice(0, 0)).indices(layout.n)):
            assert not h[:, j].any()  # one sample's rate teaches no arm; R takes what is in doubt of it
            continue
        left_out = 1e-4 if name == "zero_velocity" else 5e-6
        np.testing.assert_allclose(
            (back - ahead) / (2.0 * step), h[:, j], rtol=0.0, atol=left_out + 2e-4 * (j < 2)
        )


def looks_like_a_covariance(r):
    np.testing.assert_allclose(r, r.T, rtol=1e-15)
    assert np.linalg.eigvalsh(r)[0] > 0.0


@pytest.mark.parametrize("name", ["position", "velocity", "odometer", "nonholonomic"])
def test_r_is_a_covariance(name):
    for t in MOMENTS:
        looks_like_a_covariance(observers(t)[name](*truth(FULL, t)).R)
    looks_like_a_covariance(observers(78.0)[name](*askew(FULL, 9)).R)


def test_readings_that_come_fast_share_their_information():
    """Ten a second with errors that last a second weigh as much as one."""
    b, _ = truth(CORE, 60.0)
    lla, _, _ = point(PATH, np.array([60.0]), CAR.antenna)
    sensor = Position(LEVER, correlation=1.0, jitter=0.0)
    slow = sensor.observe(b, reading("position", 60.0, lla[0])).R
    fast = sensor.observe(b, reading("position", 60.0, lla[0])._replace(interval=0.1)).R
    np.testing.assert_allclose(fast, 10.0 * slow, rtol=1e-12)


def test_the_mean_velocity_of_an_epoch_is_seen_as_such():
    """A receiver that averages over the last second, against a belief that remembers that second."""
    t, window = 71.0, 1.0
    sensor = Velocity(LEVER, averaging=window)
    b, _ = truth(CORE, t)
    b.trail.length = 1.5
    times = np.arange(t - 1.5, t + 1e-9, 0.1)
    for when, v in zip(times, trajectory(PATH, times, CAR).v_n, strict=True):
        b.trail.mark(float(when), v)
    _, v_n, _ = point(PATH, np.linspace(t - window, t, 2001), CAR.antenna)
    z = sensor.observe(b, reading("velocity", t, v_n.mean(axis=0))).z
    # The antenna swings with the box, whose mean swing is not followed: 1.4 m x 0.3 rad/s at most.
    assert np.abs(z).max() < 0.05


def test_a_stop_is_told_from_driving_by_this_drive_alone():
    """Spreads filed under GNSS speed; then a stop without GNSS is seen, a steady cruise is not."""
    rng = np.random.default_rng(2)
    b = Belief(CORE)
    b.p.reshape(32, 32)[3:5, 3:5] = 0.04 * np.eye(2)
    detector, now, seen = Stillness(), 0.0, {"stop": 0, "cruise": 0}

    def ticks(seconds, shake, speed, labelled):
        nonlocal now
        count = 0
        b.x[3] = speed
        for _ in range(round(seconds * 10.0)):
            now += 0.1
            rate, force = rng.normal(0.0, 0.002 * shake, 3), rng.normal(0.0, 0.02 * shake, 3)
            force[2] -= 9.8
            if labelled:
                detector.hear(reading("velocity", now, [speed, 0.0, 0.0]))
            count += detector.tick(b, Motion(now, 0.1, np.concatenate([rate, force]))) is not None
        return count

    assert ticks(10.0, 1.0, 0.0, True) == 0, "a drive without labelled driving says nothing"
    ticks(30.0, 10.0, 10.0, True)
    ticks(10.0, 1.0, 0.0, True)
    ticks(10.0, 10.0, 10.0, False)
    seen["stop"] = ticks(10.0, 1.0, 0.05, False)
    seen["cruise"] = ticks(20.0, 10.0, 10.0, False)
    smooth_road = ticks(20.0, 1.0, 10.0, False)
    assert seen["stop"] > 25, "five a second once all has lasted 1.5 s"
    assert seen["cruise"] == 0
    assert smooth_road == 0, "the filter's own speed forbids it"


@pytest.mark.parametrize(("doubt", "believed"), [(0.02, False), (1.0, True)])
def test_a_stop_is_not_missed_for_a_tilt_in_doubt(doubt, believed):
    """Standing still with the box a degree off feigns 0.17 m/s^2: a stop to a filter that may be a degree
    off (its deviation [deg]), braking to one that knows better."""
    rng = np.random.default_rng(5)
    b, detector, now = Belief(CORE), Stillness(), 0.0
    b.P[3:5, 3:5] = 4.0 * np.eye(2)
    b.P[6:8, 6:8] = np.radians(doubt) ** 2 * np.eye(2)

    def ticks(seconds, shake, speed, lean, labelled):
        nonlocal now
        count = 0
        b.x[3] = speed
        for _ in range(round(seconds * 10.0)):
            now += 0.1
            rate, force = rng.normal(0.0, 0.002 * shake, 3), rng.normal(0.0, 0.02 * shake, 3)
            force += [9.8 * lean, 0.0, -9.8]
            if labelled:
                detector.hear(reading("velocity", now, [speed, 0.0, 0.0]))
            count += detector.tick(b, Motion(now, 0.1, np.concatenate([rate, force]))) is not None
        return count

    ticks(30.0, 10.0, 10.0, 0.0, True)
    ticks(10.0, 1.0, 0.0, 0.0, True)
    ticks(10.0, 10.0, 10.0, 0.0, False)
    assert (ticks(10.0, 1.0, 3.0, np.radians(1.0), False) > 25) is believed
