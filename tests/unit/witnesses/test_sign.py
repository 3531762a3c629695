"""The sign of wheels that count without one."""

import numpy as np
import pytest

from gapless.measurements.base import Observation
from gapless.witnesses.sign import MOST, PRIOR, Sign

R, HPH = 0.05**2, 0.1**2
H = np.array([[1.0, 0.0]])


def heard(sign, speed, true, off=0.0, hph=HPH):
    """What is made of a reading, by a filter whose forward speed is `true` less an error."""
    expected = true - off
    ahead = Observation(np.array([speed - expected]), H, np.array([[R]]))
    back = Observation(np.array([-speed - expected]), 2.0 * H, np.array([[R]]))
    return sign.settles(speed, ahead, back, hph), ahead, back


def driven(speeds, sign=None, **more):
    """The last observation of a drive, counted without a sign, and both hypotheses."""
    sign = sign or Sign()
    for true in speeds:
        found = heard(sign, abs(true), true, **more)
    return found


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_which_way(way):
    """From rest up to 2 m/s in 2 s, at 10 Hz: one of the hypotheses is as good as sure, and taken."""
    one, ahead, back = driven([0.0, *(way * np.linspace(0.1, 2.0, 20))])
    right, wrong = (ahead, back) if way > 0.0 else (back, ahead)
    # what is left of the wrong one, at log odds of MOST, is under a thousandth of it
    assert one.z[0] == pytest.approx(right.z[0], abs=1e-3 * abs(wrong.z[0]))
    assert one.H is right.H
    assert one.R[0, 0] < R + 1e-3 * (ahead.z - back.z)[0] ** 2


def test_where_it_is_not_known_both_are_held():
    """A filter in doubt of its speed by 3 m/s, a reading of 1: R holds either within two deviations."""
    sign = Sign(odds=0.0)
    one, ahead, back = heard(sign, 1.0, 0.0, hph=9.0)
    assert back.z[0] < one.z[0] < ahead.z[0]
    for either in (ahead, back):
        assert abs(either.z[0] - one.z[0]) < 2.0 * np.sqrt(one.R[0, 0])


def test_a_sensor_with_a_sign_is_left_alone():
    sign = Sign()
    one, ahead, _ = heard(sign, -1.0, -1.0)
    assert one is ahead
    assert sign.signed
    one, ahead, _ = heard(sign, 3.0, -3.0)  # for good, whatever the filter thinks
    assert one is ahead


def test_noise_about_zero_is_no_sign():
    sign = Sign()
    heard(sign, -0.1, 0.0)
    assert not sign.signed


def test_it_may_change_only_where_the_wheels_stand():
    sign = Sign()
    driven([0.0, *np.full(20, -2.0)], sign)
    assert sign.odds > 0.0
    heard(sign, 0.05, 0.05)
    assert sign.odds == PRIOR


def test_odds_are_bounded_and_one_reading_is_little_news():
    """So that a skid of a second does not turn the car round, and a second lie does not count for ever."""
    sign = Sign()
    driven(np.full(200, 10.0), sign)
    assert sign.odds == -MOST
    one, ahead, _ = heard(sign, 10.0, -10.0)
    assert sign.odds == -MOST + 1.0
    assert one.H is ahead.H


def test_a_copy_goes_on_alone():
    sign = Sign()
    driven(np.full(5, -2.0), sign.copy())
    assert (sign.odds, sign.signed) == (PRIOR, False)
