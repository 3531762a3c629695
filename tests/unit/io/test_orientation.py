"""Axes that point elsewhere than is said are refused, by what they are; boxes that sit askew are not."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gapless.errors import RecordingError
from gapless.io.axes import axes_matrix, nearest_axes
from gapless.io.log import Log
from gapless.io.orientation import check_orientation, felt, turning_axis, vehicle_axes
from gapless.simulate import simulate, spikes
from gapless.units import DEG

WORDS = ("forward", "back", "right", "left", "down", "up")
TRIPLES = ["-".join(p) for p in permutations(WORDS, 3)]
LOG, INCREMENTS = Log("imu.csv", {"gyro_x": np.zeros(1)}), Log("imu.txt", {"dtheta_x": np.zeros(1)})


def right_handed(triple):
    try:
        return axes_matrix(triple) is not None
    except RecordingError:
        return False


TRIPLES = [t for t in TRIPLES if right_handed(t)]


@cache
def drive():
    return simulate("urban", "consumer", 300.0, 4, rate=50.0)


def turned(matrix, triad="both"):
    """Samples of a box whose axes lie along the rows of a matrix."""
    imu = drive().imu
    dtheta = imu.dtheta @ matrix.T if triad in ("both", "gyro") else imu.dtheta
    dvel = imu.dvel @ matrix.T if triad in ("both", "accel") else imu.dvel
    return replace(imu, dtheta=dtheta, dvel=dvel)


def refusal(imu, gnss, axes=None, log=LOG):
    with pytest.raises(RecordingError) as error:
        check_orientation(log, imu, gnss, axes)
    return str(error.value)


def test_there_are_24_and_each_is_nearest_to_itself():
    assert len(TRIPLES) == 24
    assert [nearest_axes(axes_matrix(t)) for t in TRIPLES] == TRIPLES


@pytest.mark.parametrize("true", TRIPLES)
def test_wrong_axes_are_refused_by_what_they_are(true):
    """A box mounted one way, and said to be mounted another: the line names the first."""
    logged = turned(axes_matrix(true).T)  # along the logged axes
    for said in ("forward-right-down", "right-forward-up", "back-up-left"):
        axes = axes_matrix(said)
        as_read = replace(logged, dtheta=logged.dtheta @ axes.T, dvel=logged.dvel @ axes.T)
        if said == true:
            check_orientation(LOG, as_read, drive().gnss, axes)
        else:
            line = refusal(as_read, drive().gnss, axes)
            assert f'say so with imu_axes = "{true}"' in line
            assert f"do not point {said}" in line


# 40 degrees are less than the 60 from which on an axis is another one, by more than the angle's error.
@settings(max_examples=25, deadline=None)
@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1), st.floats(0.0, 40.0))
def test_boxes_that_sit_askew_are_not_refused_and_their_angle_is_found(axis, angle):
    about = np.array(axis) / np.linalg.norm(axis)
    askew = Rotation.from_rotvec(about * angle * DEG).as_matrix()
    imu = turned(askew)
    check_orientation(LOG, imu, drive().gnss, None)
    told = felt(imu, drive().gnss)
    apart = Rotation.from_matrix(vehicle_axes(told)[0] @ askew).magnitude() / DEG
    assert apart < 6.0  # biases of 0.1 m/s^2 and slopes tilt the mean force by some degrees


@pytest.mark.parametrize(
    ("triad", "matrix"),
    [
        ("gyro", np.diag([-1.0, -1.0, -1.0])),
        ("gyro", np.eye(3)[[2, 0, 1]]),
        ("gyro", np.diag([1.0, -1.0, -1.0])),
        ("accel", np.diag([-1.0, -1.0, -1.0])),
        ("accel", np.eye(3)[[0, 2, 1]]),
    ],
)
def test_triads_that_contradict_each_other_are_refused(triad, matrix):
    line = refusal(turned(matrix, triad), drive().gnss)
    assert "off the vertical that the accelerometers feel" in line
    assert "exchanged, or have the wrong sign" in line


@pytest.mark.parametrize(
    ("factor", "cure"), [(0.02, "increments: multiply the gyro columns by 50"), (0.5, "unit"), (2.0, "unit")]
)
def test_gyros_in_another_unit_are_refused(factor, cure):
    imu = drive().imu
    line = refusal(replace(imu, dtheta=factor * imu.dtheta), drive().gnss)
    assert f"the gyros turn {factor:.1g}" in line
    assert cure in line


def test_increments_are_not_told_of_a_key_that_is_not_theirs():
    line = refusal(turned(axes_matrix("right-forward-up").T), drive().gnss, log=INCREMENTS)
    assert line.endswith("turn them to forward-right-down")


def test_without_velocities_positions_tell():
    gnss = drive().gnss
    mute = replace(gnss, v_n=np.full_like(gnss.v_n, np.nan))
    assert 'imu_axes = "up-left-back"' in refusal(turned(axes_matrix("up-left-back").T), mute)


def test_little_motion_and_nonsense_conclude_nothing():
    upside_down, gnss = turned(axes_matrix("forward-left-up").T), drive().gnss
    begun = drive().start
    check_orientation(LOG, upside_down.slice(begun, begun + 60.0), gnss, None)  # too short
    check_orientation(LOG, upside_down, gnss.take(slice(0, 0)), None)
    check_orientation(LOG, upside_down, replace(gnss, lla=np.full_like(gnss.lla, np.nan)), None)
    rng = np.random.default_rng(1)
    noise = replace(gnss, v_n=rng.normal(0.0, 20.0, gnss.v_n.shape))
    check_orientation(LOG, upside_down, noise, None)


def test_spikes_of_the_receiver_refuse_nothing():
    struck, rows = spikes(drive().gnss, np.random.default_rng(2), 20, (50.0, 200.0), (10.0, 100.0))
    assert len(rows) == 20
    check_orientation(LOG, drive().imu, struck, None)


def test_agreement_of_a_sound_log():
    told = felt(drive().imu, drive().gnss)
    assert vehicle_axes(told)[1] > 0.8  # seven real cars: 0.85 to 0.98
    turning = turning_axis(told)
    assert turning.correlation > 0.9  # 0.983 to 0.999
    assert turning.factor == pytest.approx(1.0, abs=0.05)  # seven real cars: 0.998 to 1.011
