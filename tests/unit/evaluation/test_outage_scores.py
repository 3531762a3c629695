from dataclasses import replace

import numpy as np
import pytest

from gapless import earth
from gapless.evaluation import first_motion, pool_spread, score
from gapless.evaluation.outages import BEFORE_MOTION, IMU_GAP, LITTLE_TRUTH, NO_MOTION
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Decision, Solution

START = 5000.0
SPEED = 10.0


def solve(trajectory, outages, decisions=()):
    return Solution("drive", "ins", trajectory, {}, {}, {}, tuple(decisions), tuple(outages), START)


@pytest.fixture
def drive(origin, trajectory, recording):
    """A car going east at 10 m/s from 20 s on, its GNSS, and a solution with planted errors."""

    def make(length=300.0, plant=None, clock=0.0, **extra):
        t = START + np.arange(0.0, length, 0.1)
        age = t - START
        east = SPEED * np.maximum(age - 20.0, 0.0)
        v_n = np.column_stack([0 * t, np.where(age >= 20.0, SPEED, 0.0), 0 * t])
        path = np.column_stack([0 * t, east, 0 * t])
        every = slice(None, None, 10)
        lla = earth.ned_to_lla(path, origin)
        gnss_time = t[every] - clock
        rec = recording(gnss_time, lla[every], v_n[every], imu_time=t, **extra)
        error = np.zeros((len(t), 3)) if plant is None else plant(age)
        sd = np.ones((len(t), 9))
        euler = np.column_stack([0 * t, 0 * t, 0 * t + np.pi / 2])
        found = trajectory(t, earth.ned_to_lla(path + error, origin), v_n, euler, sd, 0 * t)
        return rec, found

    return make


def growing(start, end, along=0.0, cross=0.0, down=0.0):
    """Errors that grow with the age of an outage: `along` [m/s] east, `cross` [m/s^2] south."""

    def plant(age):
        since = np.where((age >= start) & (age < end), age - start, 0.0)
        return np.column_stack([-cross * since**2, along * since, down * since])

    return plant


def test_known_answers(drive):
    rec, found = drive(plant=growing(100.0, 160.0, along=0.3, cross=0.01, down=0.05))
    scores = score(solve(found, [(100.0, 160.0)]), rec)
    (one,) = scores.outages
    age = np.arange(0.0, 60.0)  # truth at 1 Hz: the last withheld epoch is 59 s old
    size = np.hypot(0.3 * age, 0.01 * age**2)
    # 1 mm: chord against ellipsoid along 1.4 km of path turns NED axes by 2e-4 rad.
    close = {"abs": 0.012}  # m: 2e-4 rad of 40 m
    assert one.truth_epochs == 60
    assert one.horizontal_max == pytest.approx(size[-1], **close)
    assert one.horizontal_end == pytest.approx(size[-1], **close)
    assert one.horizontal_rmse == pytest.approx(np.sqrt(np.mean(size**2)), **close)
    assert one.along_max == pytest.approx(0.3 * 59, **close)
    assert one.cross_max == pytest.approx(0.01 * 59**2, **close)
    assert one.vertical_max == pytest.approx(0.05 * 59, **close)
    assert one.distance == pytest.approx(600.0, abs=1e-6)
    assert one.percent == pytest.approx(100.0 * size[-1] / 600.0, abs=0.01)
    assert one.labels == ()
    assert scores.truth == "gnss"
    assert "withheld fixes" in scores.statement
    assert scores.horizontal.worst == one.horizontal_max


def test_coverage_counts_the_truth_in_the_stated_ellipse(drive, origin):
    rec, found = drive(plant=growing(100.0, 160.0, along=0.5))
    reference = found.take(slice(None, None, 10))
    reference = replace(reference, lla=rec.gnss.lla, sd=np.full((300, 9), np.nan))
    scores = score(solve(found, [(100.0, 160.0)]), replace(rec, reference=reference))
    (one,) = scores.outages
    # 1 sd is 1 m each way, so the 95 % circle has 2.448 m: ages 0 to 4 of 60 are inside.
    assert one.coverage_95 == pytest.approx(5 / 60)
    assert one.nees == pytest.approx(np.mean((0.5 * np.arange(60.0)) ** 2), rel=1e-3)
    assert scores.truth == "reference"
    assert scores.aided.horizontal_rmse < 1e-6  # m, rounding: nothing is planted outside
    assert scores.fixes_rmse < 1e-6


def test_heading_and_velocity_errors_are_found(drive):
    rec, found = drive()
    reference = found.take(slice(None, None, 10))
    inside = (found.time >= START + 100) & (found.time < START + 160)
    euler, v_n = found.euler.copy(), found.v_n.copy()
    euler[inside, 2] += np.radians(3.0)
    v_n[inside, :2] += [0.3, -0.4]
    found = replace(found, euler=euler, v_n=v_n)
    scores = score(solve(found, [(100.0, 160.0)]), replace(rec, reference=reference))
    (one,) = scores.outages
    assert np.degrees(one.heading_max) == pytest.approx(3.0, abs=1e-9)
    assert one.velocity_max == pytest.approx(0.5, abs=1e-9)
    assert scores.aided.heading_rmse == pytest.approx(0.0, abs=1e-9)


def test_the_geoid_is_taken_off_and_stated(drive):
    rec, found = drive(plant=growing(100.0, 160.0, down=0.05))
    reference = found.take(slice(None, None, 10))
    lla = rec.gnss.lla + np.array([0.0, 0.0, 36.5])
    scores = score(solve(found, [(100.0, 160.0)]), replace(rec, reference=replace(reference, lla=lla)))
    assert scores.height_offset == pytest.approx(-36.5, abs=1e-6)
    assert scores.outages[0].vertical_max == pytest.approx(0.05 * 59, abs=1e-3)  # m, as above
    assert scores.aided.vertical_rmse < 1e-3


def test_the_decided_clock_offset_moves_truth_and_outages(drive):
    clock = -0.4
    rec, found = drive(plant=growing(99.6, 159.6, along=0.3), clock=clock)
    decision = Decision("clock offset, position", clock, "s", "data", "planted")
    scores = score(solve(found, [(100.0, 160.0)], [decision]), rec)
    assert scores.clock_offset == clock
    assert scores.aided.horizontal_max < 1e-3  # m; 0.4 s of 10 m/s would be 4 m
    wrong = score(solve(found, [(100.0, 160.0)]), rec)
    assert wrong.aided.horizontal_max > 3.9


def test_outages_that_do_not_count_are_labelled_and_kept(drive):
    rec, found = drive()
    outages = [(0.0, 15.0), (30.0, 45.0), (60.0, 80.0), (100.0, 120.0), (200.0, 220.0)]
    keep = (rec.gnss.time < START + 103) | (rec.gnss.time >= START + 120)
    t = rec.imu.time - START
    lost = ((t > 205) & (t < 209)) | ((t > 70) & (t < 72))  # navigation bridges two seconds
    imu = rec.imu.take(~lost)
    scores = score(solve(found, outages), replace(rec, gnss=rec.gnss.take(keep), imu=imu))
    labels = [o.labels for o in scores.outages]
    assert labels == [(BEFORE_MOTION, NO_MOTION), (BEFORE_MOTION,), (), (LITTLE_TRUTH,), (IMU_GAP,)]
    assert [o.counts for o in scores.outages] == [False, False, True, False, False]
    assert len(scores.pool) == 1
    assert pool_spread([scores, scores]).count == 2
    # The outage without truth at its end and the one with an IMU gap have errors, and count if asked.
    assert pool_spread([scores], apart=(BEFORE_MOTION,)).count == 3


def test_an_outage_without_any_truth_is_nan_not_zero(drive):
    rec, found = drive()
    keep = (rec.gnss.time < START + 100) | (rec.gnss.time >= START + 120)
    (one,) = score(solve(found, [(100.0, 120.0)]), replace(rec, gnss=rec.gnss.take(keep))).outages
    assert one.truth_epochs == 0
    assert LITTLE_TRUTH in one.labels
    assert np.isnan([one.horizontal_max, one.horizontal_end, one.coverage_95, one.nees]).all()
    assert one.distance == pytest.approx(200.0, abs=1e-6)


def test_times_of_outages_may_be_numpys(drive):
    rec, found = drive()
    (plain,) = score(solve(found, [(100.0, 120.0)]), rec).outages
    (one,) = score(solve(found, [tuple(np.array([100.0, 120.0]))]), rec).outages
    for name in ("labels", "horizontal_max", "distance"):
        assert getattr(one, name) == getattr(plain, name)


def test_a_solution_that_stops_short_is_not_scored_as_perfect(drive):
    rec, found = drive()
    short = found.take(found.time < START + 105)
    (one,) = score(solve(short, [(100.0, 160.0)]), rec).outages
    assert LITTLE_TRUTH in one.labels
    assert isinstance(short, Trajectory)


def test_first_motion_needs_three_seconds_above_five(recording, origin):
    t = 700.0 + np.arange(0.0, 60.0)
    speed = np.where(t >= 740.0, 8.0, 0.0)
    speed[10] = 300.0  # a spike
    speed[20:23] = 6.0  # 2 s of rolling
    speed[35] = np.nan
    v_n = np.column_stack([speed, 0 * t, 0 * t])
    assert first_motion(recording(t, np.tile(origin, (60, 1)), v_n)) == 740.0


def test_first_motion_from_positions_alone(recording, origin):
    t = 700.0 + np.arange(0.0, 60.0, 0.5)
    north = 8.0 * np.maximum(t - 730.0, 0.0)
    lla = earth.ned_to_lla(np.column_stack([north, 0 * t, 0 * t]), origin)
    # Central differences over two seconds: 5 m/s is passed within a second of the start.
    assert first_motion(recording(t, lla)) == pytest.approx(730.0, abs=1.0)


def test_a_parked_car_never_moves(recording, origin):
    t = np.arange(0.0, 60.0)
    assert first_motion(recording(t, np.tile(origin, (60, 1)))) == np.inf
