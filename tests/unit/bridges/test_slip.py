"""Whether wheels roll: made-up readings, of which it is known."""

import numpy as np
import pytest

from gapless.bridges.course import IN_SILENCE, LEAST, Course, Drift
from gapless.bridges.slip import OFTEN, Gauss, Hold

OWN = 0.15**2
SPEED = 15.0


def listened(slip, drift=0.03, wrong=0.0, n=60, seed=0, from_start=0.0):
    """Probability of slip after each reading, one a second; `slip` is a function of time [m/s]."""
    rng, hold, found = np.random.default_rng(seed), Hold.begin(-2.5, 0.1**2 + from_start**2, drift), []
    for t in range(n):
        seen = slip(t) + wrong * t + from_start + 0.1 * rng.normal()
        hold = hold.after(float(t), seen, OWN, SPEED)
        found.append(hold.slips)
    return np.array(found), hold


def burst(size, begin=20, end=26):
    return lambda t: size if begin <= t < end else 0.0


def test_wheels_that_roll_are_believed():
    told = [listened(burst(0.0), seed=k)[0] for k in range(20)]
    # of 1200 readings with the noise that is told, and less; beforehand it is 1.6 %
    assert np.mean(told) < OFTEN
    assert np.max(told) < 0.5


@pytest.mark.parametrize("size", [1.5, -1.5, 3.0, -4.0])
def test_a_burst_is_noticed_while_it_lasts(size):
    """A tenth of the speed and more, either way."""
    told, _ = listened(burst(size))
    assert told[20:26].min() > 0.95
    assert told[:19].max() < 0.1
    assert told[29:].max() < 0.1, "and believed again three seconds after it"
    assert 6 <= (told > 0.5).sum() <= 8, "of the six seconds of it"


def test_a_slip_that_comes_in_over_four_windows_is_noticed():
    told, _ = listened(lambda t: float(np.interp(t, [20, 24, 30, 34], [0.0, 1.5, 1.5, 0.0])))
    assert told[24:30].min() > 0.9


def test_a_course_that_drifts_is_no_slip():
    """A tilt of a fifth of a degree, where that is what this car's course does."""
    told, hold = listened(burst(0.0), drift=0.05, wrong=0.035)
    assert told.max() < 0.2
    assert abs(hold.rolling.mean - 0.035 * 59) < 0.3


def test_a_filter_that_was_wrong_before_is_no_slip_where_it_knew():
    told, _ = listened(burst(0.0), from_start=2.0)
    assert told.max() < 0.3


def test_what_lasts_is_no_slip_in_the_end():
    """A jump that stays: first it is a slip, but slips end."""
    told, hold = listened(burst(1.5, end=1000), n=90)
    assert told[22] > 0.9
    assert told[-1] < 0.5
    assert abs(hold.rolling.mean - 1.5) < 0.2


def test_after_a_long_silence_of_the_wheels_any_reading_may_be_right():
    _, hold = listened(burst(0.0))
    assert hold.after(120.0, 1.5, OWN, SPEED).slips < 0.2


def test_absurd_readings_leave_it_finite():
    hold = Hold.begin(0.0, 0.01, 0.03)
    for t, seen in enumerate((1e3, -1e3, 0.0, 0.0)):
        hold = hold.after(float(t), seen, OWN, 3.0)
        assert 0.0 < hold.slips < 1.0
        assert np.isfinite([*hold.rolling, *hold.slipping, *hold.size]).all()


def test_gauss_against_sums():
    """Bayes and the moments of a mixture on a grid."""
    x = np.linspace(-20.0, 20.0, 40001)
    prior, other = Gauss(0.5, 2.0), Gauss(-1.0, 0.7)
    weight = np.exp(-0.5 * (x - 0.5) ** 2 / 2.0 - 0.5 * (1.2 - 3.0 * x) ** 2 / 0.4)
    weight /= weight.sum()
    after = prior.given(1.2, 0.4, 3.0)
    assert after.mean == pytest.approx(weight @ x, abs=1e-6)
    assert after.variance == pytest.approx(weight @ (x - after.mean) ** 2, rel=1e-6)
    density = [np.exp(-0.5 * (x - g.mean) ** 2 / g.variance) / np.sqrt(g.variance) for g in (prior, other)]
    mixed = 0.7 * density[0] + 0.3 * density[1]
    mixed /= mixed.sum()
    both = prior.or_(other, 0.3)
    assert both.mean == pytest.approx(mixed @ x, abs=1e-6)
    assert both.variance == pytest.approx(mixed @ (x - both.mean) ** 2, rel=1e-6)


def test_the_course_is_what_corrections_added_along_the_way():
    north, east = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    course = Course(0.0, np.zeros(3), 0.0)
    course = course.to(1.0, north, np.array([0.3, 9.0, 0.0]))
    course = course.to(2.0, east, np.array([5.0, 9.1, 0.0]))
    assert course.gained == pytest.approx(0.4)


def test_the_drift_is_learned_and_pauses_do_not_count():
    heading, drift, corrected, time = np.array([0.6, 0.8, 0.0]), Drift(), np.zeros(3), 0.0
    begun = drift.rate
    for k in range(600):
        time += 10.0 if k % 100 == 50 else 1.0
        corrected = corrected + (50.0 if k % 100 == 50 else 0.05) * heading
        drift = drift.after(time, heading, corrected)
    # 0.05 m/s a second; three stretches at 0.02 were there before
    assert drift.rate == pytest.approx(IN_SILENCE * 0.05, rel=0.05)
    assert drift.rate > begun
    for k in range(2000):
        drift = drift.after(time + k + 1.0, heading, corrected)
    assert drift.rate == pytest.approx(IN_SILENCE * LEAST, rel=0.05)
