"""Increments against what was felt: closed forms, and drives of any kind that are never a contradiction."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gapless.witnesses.increments import APART, DOUBT, REACH, SLOTS, Increments, Slack

SD = np.array([0.1, 0.1])
SLACK = Slack(2.0)
motions = st.lists(
    st.tuples(
        st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.lists(st.floats(-2.4, 2.4), min_size=2, max_size=2)
    ),
    min_size=3,
    max_size=40,
)
"""Accelerations north and east over a second each [m/s^2], and noise in deviations."""


def kept(*rows, size=2, sd=0.1):
    """Increments that hold readings (time, said, felt so far)."""
    past = Increments(size)
    for time, said, felt in rows:
        said, felt = np.full(size, said, float), np.full(size, felt, float)
        past.keep(time, said - felt, said, np.full(size, sd**2))
    return past


def test_one_component_is_the_difference_over_what_is_allowed():
    past = kept((0.0, 10.0, 0.0), size=1)
    found = past.excess(2.0, np.array([3.0]), np.array([13.0]), np.array([0.1**2]), Slack(1.5, 0.4))
    # differs by 7; noise of both readings, 1.5 m/s a second for 2 s, 0.4 / 2 m/s^2 over 2 s
    assert found == pytest.approx(7.0 / (DOUBT * 0.1 * np.sqrt(2.0) + 3.0 + 0.8))


@given(motions, st.integers(0, 2**32 - 1))
def test_what_moves_as_was_felt_is_no_contradiction(motion, seed):
    """For any motion, with noise within what is stated and accelerations wrong by what is left to them.

    Of 2.4 deviations in each of two components, two readings differ by 4.8 sqrt(2) at most; 5 sqrt(2) is
    allowed.
    """
    past, rng = Increments(2), np.random.default_rng(seed)
    v, felt = np.array([5.0, -3.0]), np.zeros(2)
    for k, (north, east, noise) in enumerate(motion):
        said = v + SD * noise
        assert past.excess(float(k), said - felt, said, SD**2, SLACK) < 1.0
        past.keep(float(k), said - felt, said, SD**2)
        gained = np.array([north, east])
        v = v + gained
        bearing = rng.uniform(0.0, 2.0 * np.pi)
        wrong = 0.999 * SLACK.rate * np.array([np.cos(bearing), np.sin(bearing)])
        felt = felt + gained + wrong


@given(st.floats(1.05, 100.0), st.floats(0.0, 2.0 * np.pi), st.floats(0.0, 1.0), st.floats(0.5, REACH))
def test_what_leaps_is_one(times, bearing, moved, since):
    """By more than is allowed, while less than that was felt."""
    allowed = DOUBT * 0.1 * np.sqrt(2.0) + SLACK.rate * since
    past, felt = kept((0.0, 7.0, 0.0)), 0.9 * moved * allowed * np.array([0.0, 1.0])
    leap = times * allowed * np.array([np.cos(bearing), np.sin(bearing)])
    said = 7.0 + felt + leap
    assert past.excess(since, said - felt, said, SD**2, SLACK) > 1.0


@given(st.floats(0.0, 2.0 * np.pi), st.floats(8.0, 40.0))
def test_directions_that_differ_are_none_where_lengths_agree(angle, change):
    """A brake that is felt from another side: no receiver errs so, a heading does."""
    past = kept((0.0, 20.0, 0.0))
    said = 20.0 + np.array([-change, 0.0])
    felt = change * np.array([-np.cos(angle), np.sin(angle)])
    # allowed: 5 deviations of 0.14 and 2 m/s^2 for 3 s: less than the least change
    assert past.excess(3.0, said - felt, said, SD**2, SLACK) < 1.0


def test_of_one_component_there_is_no_direction():
    past = kept((0.0, 20.0, 0.0), size=1)
    found = past.excess(1.0, np.array([40.0]), np.array([30.0]), np.array([0.01]), SLACK)
    assert found > 1.0  # said + 10, felt - 10


@pytest.mark.parametrize(("up", "sd", "odd"), [(30.0, 1.0, True), (30.0, 20.0, False), (5.0, 1.0, False)])
def test_heights_are_apart(up, sd, odd):
    """By their own deviation, and one that is poor hides nothing of the plane."""
    past, var = Increments(3), np.array([1.0, 1.0, sd**2])
    past.keep(0.0, np.zeros(3), np.zeros(3), var)
    risen, aside = np.array([0.0, 0.0, up]), np.array([30.0, 0.0, 0.0])
    assert (past.excess(1.0, risen, risen, var, Slack(0.5)) > 1.0) == odd
    assert past.excess(1.0, aside, aside, var, Slack(0.5)) > 1.0


def test_readings_are_held_against_those_of_some_seconds_only():
    past, far = kept((0.0, 0.0, 0.0)), np.full(2, 1e3)
    assert past.excess(REACH, far, far, SD**2, SLACK) > 1.0
    assert past.excess(REACH + 0.1, far, far, SD**2, SLACK) == 0.0
    assert Increments(2).excess(0.0, far, far, SD**2, SLACK) == 0.0


def test_a_leap_shows_against_any_of_them():
    """A glide within the slack from one to the next, and not over all."""
    past = kept(*((0.1 * k, 0.0, 0.0) for k in range(60)))
    glide = np.array([0.0, 9.0])
    assert past.excess(6.0, glide, glide, SD**2, Slack(1.0)) > 1.0
    assert kept((0.0, 0.0, 0.0)).excess(8.0, glide, glide, SD**2, Slack(1.2)) < 1.0


def test_what_is_kept():
    """Not more often than needed, and no more than there is room for; the last ones."""
    past = kept(*((0.1 * k, k, 0.0) for k in range(500)))
    times = past.rows[: past.n, 0]
    assert past.n == SLOTS
    assert np.diff(times).min() >= APART - 1e-9
    assert past.last == times[-1] > 49.9 - APART
    past.forget()
    assert past.last == -np.inf


def test_change_is_what_was_said_and_felt_since():
    past = kept((0.0, 1.0, 0.0), (1.0, 3.0, 1.5), (2.0, 8.0, 6.5))
    said, felt = past.change(3.0, np.full(2, 11.0 - 9.0), np.full(2, 11.0), (1.4, 3.1))
    assert said.tolist() == [8.0, 8.0]  # since 1 s, the latest that is old enough
    assert felt.tolist() == [7.5, 7.5]
    assert past.change(10.0, np.zeros(2), np.zeros(2), (1.4, 3.1)) is None


def test_a_copy_goes_on_alone():
    past = kept((0.0, 1.0, 0.0))
    twin, before = past.copy(), past.rows.copy()
    for k in range(1, 2 * SLOTS):
        twin.keep(float(k), np.full(2, 9.0), np.full(2, 9.0), SD**2)
    assert past.n == 1
    assert np.array_equal(past.rows, before)
