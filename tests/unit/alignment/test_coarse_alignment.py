"""Alignment in motion against the truth of a simulated drive with perfect sensors."""

import numpy as np
import pytest

from gapless import attitude
from gapless.alignment.coarse import Aligner
from gapless.fold.feed import events
from gapless.simulate import Receiver, Segment, Vehicle, simulate
from gapless.trip.events import ImuBlock, Reading
from gapless.units import DEG

NONE = (0.0, 0.0, 0.0)
EXACT = Receiver(rate=5.0, position_white=NONE, position_correlated=NONE, velocity=NONE)


def aligned(log, aligner):
    """First start that an aligner gives, and the truth of its instant."""
    imu, first = log.imu, 0
    rows = np.column_stack([imu.time, imu.dt, imu.dtheta, imu.dvel])
    readings = [r for e in events(log, {}) if not isinstance(e, ImuBlock) for r in e]
    for reading in readings:
        last = int(np.searchsorted(imu.time, reading.time + 1e-6))
        if last > first:
            aligner.feel(float(imu.time[last - 1]), rows[first:last])
        first = last
        start = aligner.hear(reading, reading.time)
        if start is not None:
            k = int(np.argmin(np.abs(log.reference.time - start.time)))
            return start, log.reference.take(slice(k, k + 1))
    raise AssertionError("never aligned")


PULLING_OUT = [Segment(12.0), Segment(8.0, 1.8), Segment(20.0)]
IN_A_BEND = [Segment(1.0), Segment(6.0, 2.0), Segment(30.0, turn_rate=12.0 * DEG, bank=0.03)]


@pytest.mark.parametrize("segments", [PULLING_OUT, IN_A_BEND])
@pytest.mark.parametrize("mounting", [NONE, (0.05, -0.08, 0.12)])
def test_attitude_position_and_velocity(segments, mounting):
    car = Vehicle(mounting=mounting)
    log = simulate(segments, "perfect", 40.0, vehicle=car, receiver=EXACT, reference_rate=100.0)
    yaw = float(np.arctan2(car.c_cb[0, 1], car.c_cb[0, 0]))
    start, truth = aligned(log, Aligner(mounting_yaw=yaw))
    q = attitude.multiply(start.q_nb, attitude.from_euler(truth.euler[0]) * [1.0, -1.0, -1.0, -1.0])
    off = 2.0 * q[1:]
    # The mean acceleration is exact; the earth turns the body by 15 arc seconds a second, and 9.81 m/s^2
    # is a thousandth off: 2e-4 rad. Roll and pitch of the box turn its yaw a little: 0.05 x 0.08.
    assert np.abs(off[:2]).max() < 5e-4 + 5e-3 * any(mounting)
    assert abs(off[2]) < 1e-3 + 5e-3 * any(mounting)
    np.testing.assert_allclose(start.v_n, truth.v_n[0], atol=0.02)
    np.testing.assert_allclose((start.lla - truth.lla[0]) * [6.37e6, 6.37e6, 1.0], 0.0, atol=0.05)


def test_gyro_bias_of_a_standstill():
    log = simulate(PULLING_OUT, "perfect", 40.0, receiver=EXACT, reference_rate=100.0)
    bias = np.array([0.004, -0.002, 0.003])
    object.__setattr__(log.imu, "dtheta", log.imu.dtheta + bias * log.imu.dt[:, None])
    start, truth = aligned(log, Aligner())
    # The earth's own 7.3e-5 rad/s is in it.
    np.testing.assert_allclose(start.gyro_bias, bias, atol=7.4e-5)
    assert abs(attitude.wrap(attitude.to_euler(start.q_nb)[2] - truth.euler[0, 2])) < 1e-3


def test_never_still_no_bias():
    log = simulate(IN_A_BEND, "perfect", 40.0, receiver=EXACT)
    assert aligned(log, Aligner())[0].gyro_bias is None


def test_a_receiver_without_velocity():
    """Course and speed of fixes two seconds apart."""
    log = simulate(PULLING_OUT, "perfect", 40.0, receiver=EXACT, reference_rate=100.0)
    object.__setattr__(log.gnss, "v_n", np.full_like(log.gnss.v_n, np.nan))
    start, truth = aligned(log, Aligner())
    heading, roll, pitch = (attitude.to_euler(start.q_nb) - truth.euler[0])[[2, 0, 1]]
    assert abs(attitude.wrap(heading)) < 1.0 * DEG
    assert max(abs(roll), abs(pitch)) < 4.0 * DEG  # within the deviation that it is begun with
    assert start.sd_velocity >= 1.0


def fix(time, speed, sd=0.1):
    return Reading("velocity", time, np.array([speed, 0.0, 0.0]), np.full(3, sd), 1.0)


def test_one_wild_velocity_is_not_a_course():
    aligner = Aligner()
    rows = np.tile([0.0, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, -0.098], (100, 1))
    for second in range(1, 12):
        rows[:, 0] = second - 1.0 + 0.01 * np.arange(1, 101)
        aligner.feel(float(second), rows.copy())
        place = Reading("position", float(second), np.array([0.6, 0.2, 10.0]), np.ones(3), 1.0)
        assert aligner.hear(place, float(second)) is None
        wild = {4: 50.0, 8: 300.0, 9: 300.0, 10: 300.0}
        assert aligner.hear(fix(float(second), wild.get(second, 0.0)), float(second)) is None
