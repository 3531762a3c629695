"""How loud driving is: one-sided, by speed, and no news before anything was heard."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from gapless.bridges.knots import shares
from gapless.bridges.loudness import ALLOWED, FEW, SILENT, SPREAD, louder, too_quiet

SPEEDS = np.array([3.0, 5.0, 7.5, 10.0, 14.0, 18.0, 30.0])


def heard(levels, speeds):
    sums = SILENT
    for level, speed in zip(levels, speeds, strict=True):
        sums = louder(sums, 1.0, level, shares(np.array([speed]))[0])
    return sums


def test_it_is_a_normal_tail_of_what_was_heard_at_that_speed():
    rng = np.random.default_rng(2)
    levels = rng.normal(-2.0, 0.2, 4000)
    found = too_quiet(heard(levels, np.full(4000, 10.0)), -3.0, SPEEDS)
    mean = (levels.sum() - 3.0 * FEW) / (4000 + FEW)
    sd = np.sqrt((4000 * levels.var() + FEW * SPREAD**2) / (4000 + FEW))
    z = (mean + 3.0) / sd - ALLOWED
    # the same numbers in another order of sums
    np.testing.assert_allclose(found[3], norm.logpdf(z) - norm.logpdf(0.0), rtol=1e-6)
    assert found[1] == 0.0  # at 5 m/s nothing was heard


def test_each_speed_has_its_own():
    sums = heard([-3.0] * 200 + [-1.0] * 200, [4.0] * 200 + [20.0] * 200)
    found = too_quiet(sums, -2.8, SPEEDS)
    assert np.all(found[:2] == 0.0)
    assert np.all(found[-2:] < -5.0)
    # between the knots both have a say, and more of one the farther one goes
    assert np.all(np.diff(found) <= 0.0)


@given(
    st.lists(st.tuples(st.floats(-8.0, 4.0), st.floats(0.0, 40.0)), max_size=30),
    st.floats(-12.0, 6.0),
    st.floats(-5.0, 5.0),
)
def test_louder_is_no_news_and_units_do_not_matter(pairs, level, shift):
    levels, speeds = np.array([p[0] for p in pairs]), [p[1] for p in pairs]
    found = too_quiet(heard(levels, speeds), level, SPEEDS)
    assert np.all(found <= 0.0)
    assert np.all(np.isfinite(found))
    if not pairs or level >= levels.max():
        assert np.all(found == 0.0)
    # a factor on every sample is a shift of every level; differences of squares lose some digits
    again = too_quiet(heard(levels + shift, speeds), level + shift, SPEEDS)
    np.testing.assert_allclose(again, found, rtol=1e-6, atol=1e-6)
