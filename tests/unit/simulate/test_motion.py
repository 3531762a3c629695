from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from gapless import attitude, earth
from gapless.errors import ConfigError
from gapless.simulate import Path, Segment, Vehicle, increments, point, rates, trajectory
from gapless.simulate.motion import AT_AXLE
from gapless.simulate.path import gauss_legendre
from gapless.units import DEG

ORIGIN = (0.9, -1.2, 120.0)
SEGMENTS = (
    Segment(3.0),
    Segment(8.0, 1.8),
    Segment(10.0, slope=0.04, bank=0.01),
    Segment(5.0, -1.5),
    Segment(6.0, turn_rate=15 * DEG),
    Segment(4.0, 0.5, 5 * DEG, -0.03),
    Segment(4.0, 0.0, -5 * DEG, -0.03, -0.02),
    Segment(8.0, -1.0),
)
PATH = Path.from_segments(SEGMENTS, ORIGIN, 0.8, roll_gradient=0.007)
BOX = Vehicle(imu=(1.5, 0.3, -0.5), antenna=(1.0, -0.2, -1.5), mounting=(0.03, -0.05, 0.2))
VEHICLES = pytest.mark.parametrize("vehicle", [AT_AXLE, BOX], ids=["axle", "lever-arm-and-mounting"])


def ecef_state(vehicle, t):
    """Position, velocity, attitude of the box in ECEF, from the truth."""
    truth = trajectory(PATH, np.array([t]), vehicle)
    c_en = earth.ned_axes(truth.lla[0]).T
    c_eb = c_en @ attitude.to_matrix(attitude.from_euler(truth.euler[0]))
    return earth.lla_to_ecef(truth.lla[0]), c_en @ truth.v_n[0], c_eb


def strapdown(vehicle, start):
    """Equations of motion in ECEF, position from a start: dr = v, dv = C f + g - 2 w x v, dC = C W - w C."""
    w_ie = np.array([0.0, 0.0, earth.RATE])

    def derivative(t, y):
        omega, f = rates(PATH, t, vehicle)
        v, c = y[3:6], y[6:].reshape(3, 3)
        lla = earth.ecef_to_lla(start + y[:3])
        g = earth.ned_axes(lla).T @ [0.0, 0.0, earth.gravity(np.sin(lla[0]), lla[2])]
        dc = c @ attitude.skew(omega) - attitude.skew(w_ie) @ c
        return np.concatenate([v, c @ f + g - 2.0 * np.cross(w_ie, v), dc.ravel()])

    return derivative


def knots():
    every = np.unique(np.concatenate([f.knots for f in (PATH.speed, PATH.heading, PATH.pitch, PATH.bank)]))
    return every[np.diff(every, prepend=-1.0) > 1e-9]


@VEHICLES
def test_an_ode_solver_fed_with_the_rates_finds_the_truth(vehicle):
    edges = knots()
    start, v, c = ecef_state(vehicle, 0.0)
    y = np.concatenate([np.zeros(3), v, c.ravel()])
    derivative = strapdown(vehicle, start)
    for a, b in pairwise(edges):  # smooth between knots: full order everywhere
        y = solve_ivp(derivative, (a, b), y, method="DOP853", rtol=1e-11, atol=1e-11).y[:, -1]
    r, v, c = ecef_state(vehicle, edges[-1])
    # a coordinate of 6e6 m resolves 1e-9 m; the solver is asked for 1e-11 a step in each of ~30 pieces
    assert_allclose(start + y[:3], r, atol=1e-7)
    assert_allclose(y[3:6], v, atol=1e-8)
    assert_allclose(y[6:].reshape(3, 3), c, atol=1e-10)


@VEHICLES
def test_increments_are_the_integrals_of_the_rates(vehicle):
    imu = increments(PATH, 100.0, vehicle)
    nodes, weights, _ = gauss_legendre(8)
    fine = np.arange(4 * len(imu))[:, None] / 400.0 + nodes / 400.0
    omega, f = rates(PATH, fine, vehicle)
    # at a knot the fourth derivative jumps by up to 1e4 per s^4: times (0.01 s)^5 / 500 that is 2e-9
    for have, rate in ((imu.dtheta, omega), (imu.dvel, f)):
        exact = (rate @ weights / 400.0).reshape(3, -1, 4).sum(axis=-1).T
        assert_allclose(have, exact, atol=2e-9)
        # away from knots: the table's cubic (1e-8 m of height) times the gradient of gravity and 0.01 s
        assert np.median(np.abs(have - exact)) < 1e-13
    assert_allclose(imu.time - imu.dt, np.arange(len(imu)) / 100.0, atol=1e-12)


@VEHICLES
def test_velocity_is_the_derivative_of_position(vehicle):
    h = 1e-3
    t = np.linspace(0.01, PATH.duration - 0.01, 700)
    before, here, after = (trajectory(PATH, t + d, vehicle) for d in (-h, 0.0, h))
    r_m, r_n = earth.radii(np.sin(here.lla[:, 0]))
    per = np.column_stack(
        [r_m + here.lla[:, 2], (r_n + here.lla[:, 2]) * np.cos(here.lla[:, 0]), np.full(len(t), -1.0)]
    )
    # third derivatives up to 30 m/s^3 times h^2 / 6 is 5e-6; angles of 1 rad resolve 1e-9 m, over 2 h 1e-6
    assert_allclose((after.lla - before.lla) / (2.0 * h) * per, here.v_n, atol=1e-5)


def test_the_rear_axle_never_slips():
    t = np.linspace(0.0, PATH.duration, 999)
    _, v_n, c_nc = point(PATH, t, (0.0, 0.0, 0.0))
    v_c = np.einsum("nij,ni->nj", c_nc, v_n)
    assert_allclose(v_c[:, 1:], 0.0, atol=1e-13)  # 20 m/s times rounding
    assert_allclose(v_c[:, 0], PATH.speed(t), atol=1e-13)


def test_standing_still_reads_gravity_and_earth_rate():
    still = Path.from_segments([Segment(2.0)], ORIGIN, heading=0.3)
    imu = increments(still, 50.0, Vehicle(mounting=(0.1, -0.2, 0.4)))
    c_nb = attitude.to_matrix(attitude.from_euler([0.0, 0.0, 0.3])) @ attitude.to_matrix(
        attitude.from_euler([0.1, -0.2, 0.4])
    )
    g = earth.gravity(np.sin(ORIGIN[0]), ORIGIN[2])
    w = earth.RATE * np.array([np.cos(ORIGIN[0]), 0.0, -np.sin(ORIGIN[0])])
    assert_allclose(imu.dvel, np.tile(c_nb.T @ [0.0, 0.0, -g] * 0.02, (100, 1)), atol=1e-15)
    assert_allclose(imu.dtheta, np.tile(c_nb.T @ w * 0.02, (100, 1)), atol=1e-19)


def test_a_steady_turn_reads_the_centripetal_acceleration_at_the_lever_arm():
    w, v, arm = 0.2, 10.0, 2.0
    turn = Path.from_segments([Segment(30.0, 0.0, w)], (0.0, 0.0, 0.0), speed=v)
    _, f = rates(turn, 15.0, Vehicle(imu=(arm, 0.0, 0.0)))
    # earth rate and transport rate leave 2 * 7.3e-5 * 10 m/s and less
    assert_allclose(f, [-(w**2) * arm, w * v, -earth.gravity(0.0, 0.0)], atol=2e-3)


def test_a_point_metres_away_is_where_the_level_axes_of_the_axle_put_it():
    t, lever = np.linspace(0.0, PATH.duration, 23), (3.0, -2.0, -1.5)
    axle, _, c_nc = point(PATH, t, (0.0, 0.0, 0.0))
    lla, _, c_there = point(PATH, t, lever)
    for k in range(len(t)):
        expected = earth.ned_to_lla(c_nc[k] @ lever, axle[k])
        # what is left out: the radius changes by 1 % a radian, over 3 m times 3 m / 6.4e6 m
        assert_allclose(earth.lla_to_ned(lla[k], expected), 0.0, atol=2e-8)
        turned = earth.ned_axes(lla[k]) @ earth.ned_axes(axle[k]).T @ c_nc[k]
        assert_allclose(c_there[k], turned, atol=1e-12)  # second order in 5e-7 rad


def test_path_length_does_not_depend_on_how_the_commands_are_cut():
    halves = [
        Segment(s.duration / 2, s.acceleration, s.turn_rate, s.slope, s.bank) for s in SEGMENTS for _ in "ab"
    ]
    again = Path.from_segments(halves, ORIGIN, 0.8, roll_gradient=0.007)
    t = np.linspace(0.0, PATH.duration, 50)
    assert_allclose(again.position(t)[:2], PATH.position(t)[:2], atol=1e-15)


def test_lever_arm_is_seen_from_the_box():
    assert_allclose(BOX.c_cb @ BOX.lever_arm, [-0.5, -0.5, -1.0], atol=1e-15)


@pytest.mark.parametrize("segments", [[], [Segment(0.0)], [Segment(3.0), Segment(-1.0)]])
def test_a_path_needs_time(segments):
    with pytest.raises(ConfigError, match="positive duration"):
        Path.from_segments(segments, ORIGIN)
