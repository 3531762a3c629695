import numpy as np
import pymap3d
import pytest

from gapless import earth
from gapless.evaluation.errors import at_antenna, gnss_truth, solution_errors
from gapless.evaluation.interpolation import interpolate
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Gnss


def straight(origin, time, north=0.0, east=0.0):
    ned = np.column_stack([north * time, east * time, 0.0 * time])
    return earth.ned_to_lla(ned, origin)


def test_offsets_agree_with_pymap3d(origin):
    rng = np.random.default_rng(1)
    ned = rng.uniform(-50.0, 50.0, (200, 3))
    lat, lon, h = pymap3d.ned2geodetic(*ned.T, np.degrees(origin[0]), np.degrees(origin[1]), origin[2])
    lla = np.column_stack([np.radians(lat), np.radians(lon), h])
    found = offset_ned(lla, np.tile(origin, (200, 1)))
    # pymap3d measures along the tangent plane at the origin, we along the ellipsoid: they differ
    # by d^2 / 2R = 0.4 mm in height and by d |down| / R + d^2 tan(lat) / 2R = 0.8 mm across at 70 m.
    np.testing.assert_allclose(found, ned, atol=1.3e-3)


def test_offsets_cross_the_antimeridian(origin):
    a, b = origin.copy(), origin.copy()
    a[1], b[1] = np.pi - 1e-6, -np.pi + 1e-6
    east = offset_ned(b[None], a[None])[0, 1]
    _, r_n = earth.radii(np.sin(origin[0]))
    # 2e-6 rad has 2e-10 of relative rounding when taken as a difference at pi.
    assert east == pytest.approx(2e-6 * (r_n + origin[2]) * np.cos(origin[0]), rel=1e-8)


def test_a_constant_offset_comes_out_in_ned_along_and_across(origin, trajectory):
    t = np.arange(0.0, 20.0, 0.1)
    velocity = np.tile([6.0, 8.0, 0.0], (len(t), 1))
    truth = trajectory(t, straight(origin, t, 6.0, 8.0), velocity)
    shift = np.array([3.0, -1.0, 2.0])
    lla = earth.ned_to_lla(np.column_stack([6.0 * t + 3.0, 8.0 * t - 1.0, 0.0 * t + 2.0]), origin)
    errors = solution_errors(trajectory(t, lla, velocity + np.array([0.1, -0.2, 0.3])), truth)
    # NED axes turn by 160 m / R tan(lat) = 2.4e-5 rad along the path: 1e-4 m on 4 m.
    np.testing.assert_allclose(errors.position, np.tile(shift, (len(t), 1)), atol=2e-4)
    np.testing.assert_allclose(errors.velocity, np.tile([0.1, -0.2, 0.3], (len(t), 1)), atol=1e-12)
    # Course (0.6, 0.8): along = 3 * 0.6 - 1 * 0.8, right of it = -0.8 * 3 + 0.6 * -1.
    np.testing.assert_allclose(errors.along, 1.0, atol=2e-4)
    np.testing.assert_allclose(errors.cross, -3.0, atol=2e-4)
    np.testing.assert_allclose(errors.distance, 10.0 * t, atol=1e-9)


def test_reference_clock_is_moved_onto_the_imu_clock(origin, trajectory):
    t = np.arange(0.0, 20.0, 0.1)
    solution = trajectory(t, straight(origin, t, north=10.0))
    stamps = np.arange(2.0, 15.0)
    truth = trajectory(stamps + 0.35, straight(origin, stamps, north=10.0))
    assert solution_errors(solution, truth, -0.35).horizontal.max() < 1e-6  # m, rounding of 2 pi R
    late = solution_errors(solution, truth, 0.0)
    np.testing.assert_allclose(late.position[:, 0], 3.5, atol=1e-6)  # 0.35 s of 10 m/s
    np.testing.assert_allclose(late.along, 3.5, atol=1e-6)


def test_interpolation_stops_at_gaps_and_ends(origin, trajectory):
    rows = np.array([0.0, 1.0, 2.5, 4.1, 5.0])
    solution = trajectory(rows, straight(origin, rows, north=10.0))
    wanted = np.array([-0.1, 0.0, 0.5, 1.7, 2.5, 3.0, 4.1, 4.5, 5.0, 5.1])
    found = interpolate(solution, wanted)
    known = [False, True, True, True, True, False, True, True, True, False]
    assert np.isfinite(found.lla).all(1).tolist() == known
    expected = straight(origin, wanted, north=10.0)
    # 15 m of chord against the ellipsoid: 15^2 / 8R = 5e-6 m of height, nothing else.
    assert np.abs(offset_ned(found.lla, expected)[known]).max() < 1e-5


def test_angles_are_interpolated_and_compared_the_short_way(origin, trajectory):
    rows = np.array([0.0, 1.0])
    euler = np.radians([[0.0, 0.0, 170.0], [0.0, 0.0, -170.0]])
    solution = trajectory(rows, np.tile(origin, (2, 1)), euler=euler)
    truth = trajectory([0.5, 0.75], np.tile(origin, (2, 1)), euler=np.radians([[1, 2, -179], [0, 0, 176]]))
    errors = solution_errors(solution, truth)
    # At 0.5 s the solution heads 180, at 0.75 s 185 = -175 degrees. Rounding only.
    np.testing.assert_allclose(np.degrees(errors.attitude), [[-1, -2, -1], [0, 0, 9]], atol=1e-9)


def test_truth_without_velocity_gives_course_speed_and_distance_from_positions(origin, trajectory):
    t = np.arange(0.0, 30.0)
    truth = trajectory(t, straight(origin, t, east=-12.0))
    solution = trajectory(t, straight(origin, t, east=-12.0) + np.array([1e-6, 0, 0]))
    errors = solution_errors(solution, truth)
    r_m, _ = earth.radii(np.sin(origin[0]))
    # Heading west, north is to the right. 1e-4: meridians converge by 350 m / R over the path.
    np.testing.assert_allclose(errors.cross, 1e-6 * (r_m + origin[2]), rtol=1e-4)
    np.testing.assert_allclose(errors.speed, 12.0, rtol=1e-6)
    np.testing.assert_allclose(errors.distance, 12.0 * t, rtol=1e-6)
    assert np.isnan(errors.velocity).all()


def test_course_is_held_while_standing(origin, trajectory):
    t = np.arange(0.0, 10.0)
    speed = np.where(t < 5, 10.0, 0.0)
    v_n = np.column_stack([0 * t, speed, 0 * t])
    truth = trajectory(t, np.tile(origin, (10, 1)), v_n)
    moved = np.tile(origin, (10, 1)) + np.array([1e-6, 0, 0])
    errors = solution_errors(trajectory(t, moved, v_n), truth)
    assert (errors.cross < -6.0).all()  # north is left of east, all the way through the stop
    assert np.abs(errors.along).max() < 1e-6


def test_ellipses_hold_what_they_promise(origin, trajectory):
    n = 4000
    rng = np.random.default_rng(7)
    t = np.arange(float(n))
    sd_n, sd_e, rho = rng.uniform(0.5, 5.0, n), rng.uniform(0.5, 5.0, n), rng.uniform(-0.95, 0.95, n)
    a, b = rng.standard_normal((2, n))
    north, east = sd_n * a, sd_e * (rho * a + np.sqrt(1 - rho**2) * b)
    sd = np.full((n, 9), np.nan)
    sd[:, 0], sd[:, 1] = sd_n, sd_e
    lla = earth.ned_to_lla(np.column_stack([north, east, 0 * t]), origin)
    solution = trajectory(t, lla, sd=sd, horizontal=rho * sd_n * sd_e)
    errors = solution_errors(solution, trajectory(t, np.tile(origin, (n, 1))))
    # The count inside is binomial(4000, 0.95): sd 0.345 %, so 4 sd either side is 93.6-96.4 %.
    assert 0.936 < errors.inside().mean() < 0.964
    # Mean of 4000 chi-square(2): sd 2 / sqrt(4000) = 0.032; 4 sd.
    assert abs(errors.nees.mean() - 2.0) < 0.13
    # An error beyond the semi-major axis is outside the ellipse whatever its direction.
    assert not errors.inside()[errors.horizontal > errors.bound()].any()


def test_bound_is_the_semi_major_axis(origin, trajectory):
    sd = np.full((1, 9), np.nan)
    sd[0, :2] = 3.0, 4.0
    solution = trajectory([0.0], [origin], sd=sd, horizontal=[6.0])
    bound = solution_errors(solution, trajectory([0.0], [origin])).bound()[0]
    largest = np.linalg.eigvalsh([[9.0, 6.0], [6.0, 16.0]])[-1]
    assert bound == pytest.approx(np.sqrt(-2.0 * np.log(0.05) * largest), rel=1e-9)


def test_truth_noise_is_carried_into_the_covariance(origin, trajectory):
    sd, own = np.full((1, 9), np.nan), np.full((1, 9), np.nan)
    sd[0, :2], own[0, :2] = 3.0, 4.0
    solution = trajectory([0.0], [origin], sd=sd, horizontal=[1.0])
    errors = solution_errors(solution, trajectory([0.0], [origin], sd=own, horizontal=[0.0]))
    np.testing.assert_allclose(errors.covariance[0], [[25.0, 1.0], [1.0, 25.0]], rtol=1e-12)


def test_gnss_truth_puts_position_and_velocity_on_the_imu_clock_each_by_its_own_delay(origin):
    t = np.arange(0.0, 10.0)
    v_n = np.column_stack([0.0 * t, 2.0 * t, 0.0 * t])
    lla = np.tile(origin, (10, 1))
    lla[4] = np.nan
    one = np.ones((10, 3))
    truth = gnss_truth(Gnss(t, lla, 2 * one, v_n, 0.1 * one, np.ones(10, int)), -0.1, -0.6)
    assert len(truth) == 9
    np.testing.assert_allclose(truth.time[:2], [-0.1, 0.9], atol=1e-12)
    # Logged at 3 s, the velocity 2 * 3 held at 2.4 s; at 1.9 s it was 2 * 2.5. Rounding only.
    np.testing.assert_allclose(truth.v_n[truth.time == 1.9, 1], 5.0, atol=1e-9)


def test_antenna_is_moved_by_the_turned_lever_arm(origin, trajectory):
    euler = np.radians([[0.0, 0.0, 90.0], [0.0, 0.0, 180.0]])
    solution = trajectory([0.0, 1.0], [origin, origin], euler=euler)
    moved = at_antenna(solution, np.array([2.0, 0.5, -1.5]))
    offset = offset_ned(moved.lla, solution.lla)
    np.testing.assert_allclose(offset, [[-0.5, 2.0, -1.5], [-2.0, -0.5, -1.5]], atol=1e-5)  # 2 m / R of 2 m
    assert at_antenna(solution, np.zeros(3)) is solution
