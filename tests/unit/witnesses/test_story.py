"""Whether a receiver's places and speeds tell one story."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gapless.witnesses.receiver import DOUBT, LAXITY, LEAST, SLOTS, UNHEARD, Story

SD = 1.0


def told(story, times, place, v_n):
    """Velocities and positions, turn by turn; when it was torn."""
    torn = []
    for t in times:
        story.moved(float(t), np.asarray(v_n(t), float))
        story.stood(float(t), np.asarray(place(t), float), SD)
        torn.append(story.torn)
    return np.array(torn)


@given(
    st.lists(st.tuples(st.floats(-6.0, 6.0), st.floats(-6.0, 6.0)), min_size=10, max_size=40),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=50, deadline=None)  # the first example compiles a kernel
def test_an_honest_receiver_tells_one_for_any_motion(accelerations, seed):
    """Velocities wrong by LAXITY, positions by half of DOUBT sqrt(2) deviations: the bound itself.

    Accelerations are constant for a second, so that the mean of two velocities is the way.
    """
    rng, dt = np.random.default_rng(seed), np.array(accelerations)
    v = np.concatenate([np.zeros((1, 2)), np.cumsum(dt, axis=0)])
    way = np.concatenate([np.zeros((1, 2)), np.cumsum(0.5 * (v[1:] + v[:-1]), axis=0)])
    bearing = rng.uniform(0.0, 2.0 * np.pi, len(v))
    noise = 0.499 * DOUBT * np.sqrt(2.0) * SD * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
    wrong = 0.99 * LAXITY * np.array([0.6, -0.8])
    story = Story()
    assert not told(story, range(len(v)), lambda t: way[t] + noise[t], lambda t: v[t] + wrong).any()
    assert story.since <= LEAST + 1.0


def test_places_that_stand_while_speeds_go_on_tear_it():
    """At 10 m/s, as soon as the ways are compared: in 4 s they part by 40 m."""
    story = Story()
    going = np.array([10.0, 0.0])
    assert not told(story, range(20), lambda t: t * going, lambda t: going).any()
    assert story.drove
    torn = told(story, range(20, 40), lambda t: 20.0 * going, lambda t: going)
    assert torn[4:].all()
    assert story.since == np.inf


def test_speeds_of_zero_while_places_go_on_tear_it():
    story = Story()
    torn = told(story, range(20), lambda t: [10.0 * t, 0.0], lambda t: [0.0, 0.0])
    assert torn[4:].all()


def test_it_is_one_again_once_both_agree():
    """When what was wrong is out of reach, and not before the ways are compared."""
    story, going = Story(), np.array([10.0, 0.0])
    told(story, range(20), lambda t: np.zeros(2), lambda t: going)
    assert story.torn
    torn = told(story, range(20, 50), lambda t: (t - 20.0) * going, lambda t: going)
    assert torn[0]
    assert not torn[12:].any()
    assert 20.0 + LEAST < story.since < 35.0


def test_a_receiver_without_speeds_tells_one_only():
    story = Story()
    for t in range(20):
        story.stood(float(t), np.array([0.0, 50.0 * t]), SD)
    assert not story.torn
    assert story.since == np.inf
    told(story, range(20, 40), lambda t: [0.0, 0.0], lambda t: [10.0, 0.0])
    assert story.torn
    story.stood(39.0 + UNHEARD + 0.1, np.zeros(2), SD)
    assert not story.torn


def test_a_pause_of_its_speeds_begins_another():
    """A way without them is not known."""
    story, going = Story(), np.array([10.0, 0.0])
    told(story, range(20), lambda t: t * going, lambda t: going)
    torn = told(story, range(40, 60), lambda t: [0.0, 5.0], lambda t: [0.0, 0.0])
    assert not torn.any()


def test_a_copy_goes_on_alone():
    story, going = Story(), np.array([10.0, 0.0])
    told(story, range(3 * SLOTS), lambda t: t * going, lambda t: going)
    before, rows = dict(vars(story)), story.rows.copy()
    told(story.copy(), range(3 * SLOTS, 60), lambda t: np.zeros(2), lambda t: going)
    assert all(vars(story)[name] is value for name, value in before.items())
    assert np.array_equal(story.rows, rows)
