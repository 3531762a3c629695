"""Intervals and tests over outages: against SciPy, and against what they promise."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import given, settings
from hypothesis import strategies as st

from gapless.evaluation.pairs import holm, pair, signed_rank, votes
from gapless.evaluation.resampling import FIGURES, interval, order, resample


def lie(starts, length, recordings=None):
    starts = np.asarray(starts, float)
    return order(recordings or ["a"] * len(starts), starts, starts + length)


def test_outages_that_lie_apart_are_drawn_one_by_one():
    apart = lie(240.0 + 180.0 * np.arange(10), 60.0)
    assert (apart.reach, apart.block) == (1, 1)


@pytest.mark.parametrize(
    ("length", "every", "reach"), [(10, 180, 1), (30, 180, 1), (60, 180, 2), (120, 240, 3)]
)
def test_shifted_schedules_reach_as_far_as_their_outages_touch(length, every, reach):
    """60 s shifted by 60 s: each touches the next. 120 s: overlaps the next and touches the one after."""
    starts = np.concatenate([240.0 + shift + every * np.arange(8) for shift in (0, 60, 120)])
    assert lie(starts, length).reach == reach


def test_recordings_are_not_neighbours():
    found = lie([240, 240, 240], 60.0, ["c", "a", "b"])
    assert found.reach == 1
    assert found.rows.tolist() == [1, 2, 0]


def test_blocks_stay_together_and_each_outage_is_drawn_as_often_as_any_other():
    starts = 60.0 * np.arange(30)
    found = lie(starts[::-1].copy(), 60.0)
    drawn = resample(found, seed=1, resamples=4000)
    assert drawn.shape == (4000, 30)
    runs = drawn[:, :28].reshape(4000, 7, 4)
    steps = np.diff(starts[::-1][runs], axis=2) % 1800.0
    assert (steps == 60.0).all()
    counts = np.bincount(drawn.ravel(), minlength=30)
    # 4000 each on average; blocks of four give the count a deviation of about 4 sqrt(1000)
    assert np.abs(counts - 4000).max() < 5 * 4 * np.sqrt(1000)


def test_an_interval_of_the_mean_is_the_textbook_one():
    rng = np.random.default_rng(3)
    x = rng.normal(5.0, 2.0, 400)
    found = interval(x, resample(lie(1000.0 * np.arange(400), 60.0)), lambda v: np.mean(v, axis=-1))
    half = 1.96 * x.std() / np.sqrt(400)
    # ends of 1,000 resamples scatter by 3 % of the width
    assert found.lo == pytest.approx(x.mean() - half, abs=0.2 * half)
    assert found.hi == pytest.approx(x.mean() + half, abs=0.2 * half)


def test_too_few_outages_give_a_figure_but_no_interval():
    for n in (1, 5):
        found = interval(np.arange(1.0, n + 1), resample(lie(1000.0 * np.arange(n), 60.0)), FIGURES["median"])
        assert found.value == (n + 1) / 2
        assert np.isnan([found.lo, found.hi]).all()
    assert np.isnan(interval(np.empty(0), np.empty((5, 0), int), FIGURES["median"])).all()


def covered(n, repeats, seed, neighbours=1):
    """Share of repeats whose interval holds the median of log-normal errors that neighbours share."""
    rng = np.random.default_rng(seed)
    found = lie(60.0 * np.arange(n), 30.0 * neighbours)
    assert found.reach == neighbours
    hits = 0
    for k in range(repeats):
        white = rng.standard_normal(n + neighbours - 1)
        logs = np.convolve(white, np.full(neighbours, neighbours**-0.5), "valid")
        low, high = interval(np.exp(logs), resample(found, k, 400), FIGURES["median"])[1:]
        hits += low <= 1.0 <= high
    return hits / repeats


@pytest.mark.parametrize(("n", "least"), [(60, 0.88), (200, 0.92)])
def test_the_interval_holds_the_known_median(n, least):
    """Of 200 repeats; `benchmarks/honesty.py` has the thousand. 95 % scatters by 1.5 % over 200."""
    assert covered(n, 200, 11) >= least


def test_overlapping_outages_do_not_make_the_interval_too_narrow():
    """Three in a row share two thirds, one third of their error; drawn singly they would cover some 75 %."""
    assert covered(60, 200, 12, neighbours=3) >= 0.85


@settings(max_examples=200)
@given(st.lists(st.integers(-30, 30), min_size=1, max_size=70))
def test_signed_rank_agrees_with_scipy_with_ties_and_zeros(values):
    x = np.array(values, float)
    if not np.any(x):
        assert np.isnan(signed_rank(x))
        return
    exact = len(x) <= 50 and len(np.unique(np.abs(x))) == len(x) and np.all(x != 0.0)
    method = "exact" if exact else "asymptotic"
    expected = scipy.stats.wilcoxon(x, zero_method="wilcox", correction=False, method=method).pvalue
    # one by counting, one by recursion; erfc against SciPy's normal tail: rounding only
    assert signed_rank(x) == pytest.approx(expected, rel=1e-9)


@settings(max_examples=50)
@given(st.integers(1, 120), st.integers(0, 10**6), st.floats(-1.0, 1.0))
def test_signed_rank_agrees_with_scipy_without_ties(n, seed, middle):
    x = np.random.default_rng(seed).normal(middle, 1.0, n)
    method = "exact" if n <= 50 else "asymptotic"
    expected = scipy.stats.wilcoxon(x, method=method, correction=False).pvalue
    assert signed_rank(x) == pytest.approx(expected, rel=1e-9)


def test_holm_by_hand():
    """Holm 1979: 0.01 x 4, 0.02 x 3 = 0.06, 0.03 x 2 = 0.06, 0.04 x 1 not below what came before."""
    assert holm([0.04, 0.01, np.nan, 0.03, 0.02]) == pytest.approx(
        [0.06, 0.04, np.nan, 0.06, 0.06], nan_ok=True
    )
    assert holm([0.6, 0.9]) == [1.0, 1.0]
    assert holm([]) == []


def test_neighbours_vote_together():
    """Two of 60 s in a row, one passed over; outages that lie apart have a vote each."""
    values = np.array([1.0, 3.0, 5.0, 9.0, 2.0, 4.0, 8.0])
    assert votes(values, lie(60.0 * np.arange(7), 60.0)).tolist() == [2.0, 5.5, 8.0]
    assert votes(values, lie(600.0 * np.arange(7), 60.0)).tolist() == values.tolist()
    assert votes(np.empty(0), lie([], 60.0)).tolist() == []


def test_a_pair_by_hand():
    base = np.array([10.0, 20.0, 40.0, 5.0, 8.0, 10.0])
    ratio = np.array([0.5, 0.5, 0.8, 2.0, 0.25, 1.0])
    found = pair(ratio * base, base, lie(1000.0 * np.arange(6), 60.0))
    assert found.count == 6
    assert found.median_ratio == pytest.approx(np.sqrt(0.5 * 0.8))
    assert found.geometric.value == pytest.approx(np.exp(np.log(ratio).mean()))
    assert found.geometric.lo < found.geometric.value < found.geometric.hi
    assert found.better == pytest.approx(4 / 6)
    assert found.worst_ratio == pytest.approx(2.0)
    nothing = pair(np.empty(0), np.empty(0), lie([], 60.0))
    assert nothing.count == 0
    assert np.isnan(nothing.p)


def detected(gain, repeats, seed, neighbours=1):
    """Share of repeats in which 60 outages show a difference at 5 %; neighbours share their luck."""
    rng, found = np.random.default_rng(seed), lie(60.0 * np.arange(60), 30.0 * neighbours)
    weights, hits = np.full(neighbours, neighbours**-0.5), 0
    for white in rng.standard_normal((repeats, 60 + neighbours - 1)):
        logs = np.log(gain) + 0.25 * np.convolve(white, weights, "valid")
        hits += signed_rank(votes(logs, found)) < 0.05
    return hits / repeats


def test_pairing_detects_ten_percent_of_sixty_outages():
    """Log ratios with a deviation of 0.25: the t test has a power of 0.90 there, and this one 95 % of its
    efficiency; 400 repeats scatter by 1.6 %."""
    assert detected(0.9, 400, 21) > 0.82


@pytest.mark.parametrize("neighbours", [1, 2, 3])
def test_pairing_detects_nothing_where_there_is_nothing(neighbours):
    """5 % by design, whether outages lie apart or overlap; 800 repeats scatter by 0.8 %."""
    assert 0.025 < detected(1.0, 800, 22, neighbours) < 0.075
