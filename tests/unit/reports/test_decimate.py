import numpy as np
import pytest

from gapless.reports.decimate import envelope, scatter, simplify


def test_a_short_series_is_left_alone():
    t, y = np.arange(10.0), np.arange(20.0).reshape(10, 2)
    found_t, found = envelope(t, y, 10)
    assert found_t is t
    assert found is y


@pytest.mark.parametrize("n", [3001, 36_000, 36_007])
def test_no_extreme_is_lost_and_times_stay_in_order(n):
    rng = np.random.default_rng(n)
    y = rng.standard_normal((n, 3))
    y[rng.integers(0, n, 5), 1] = [50.0, -60.0, 70.0, -80.0, 90.0]
    t = np.arange(n) * 0.1
    found_t, found = envelope(t, y, 3000)
    assert len(found_t) == len(found) <= 3000
    assert (np.diff(found_t) > 0).all()
    edges = np.linspace(0, n, 1501).astype(int)
    for a, b, pair in zip(edges[:-1], edges[1:], found.reshape(-1, 2, 3), strict=True):
        np.testing.assert_array_equal(np.sort(pair, axis=0), [y[a:b].min(0), y[a:b].max(0)])


def test_extremes_come_in_the_order_in_which_they_occur():
    y = np.tile([0.0, -1.0, 5.0, 0.0, 0.0, 7.0, -2.0, 0.0], 2)[:, None]
    _, found = envelope(np.arange(16.0), y, 8)
    assert found[:, 0].tolist() == [-1.0, 5.0, 7.0, -2.0] * 2


def test_unknown_values_hide_no_known_ones():
    y = np.full((100, 1), np.nan)
    y[:50, 0] = np.arange(50.0)
    y[::2] = np.nan
    _, found = envelope(np.arange(100.0), y, 20)
    assert np.nanmax(found) == 49.0
    assert np.nanmin(found) == 1.0
    assert np.isnan(found[10:]).all()


def test_a_simplified_track_is_everywhere_near_in_place_and_time():
    rng = np.random.default_rng(2)
    t = np.arange(5000) * 0.1
    speed = np.where((t // 40) % 3 == 0, 0.0, 12.0)
    heading = np.cumsum(rng.normal(0, 0.01, len(t)))
    xy = np.cumsum(0.1 * speed[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0)
    rows = simplify(t, xy, tolerance=0.3)
    assert len(rows) < len(t) / 5
    assert (rows[0], rows[-1]) == (0, len(t) - 1)
    drawn = np.column_stack([np.interp(t, t[rows], xy[rows, k]) for k in range(2)])
    assert np.hypot(*(drawn - xy).T).max() <= 0.3  # the tolerance asked for


def test_a_stop_on_a_straight_road_stays_a_stop():
    t = np.arange(0.0, 30.0)
    x = np.concatenate([np.arange(11.0), np.full(9, 10.0), np.arange(10.0, 20.0)])
    assert simplify(t, np.column_stack([x, 0 * x])).tolist() == [0, 10, 20, 29]


def test_the_points_are_limited_where_the_tolerance_would_need_more():
    xy = np.random.default_rng(4).standard_normal((2000, 2))
    assert len(simplify(np.arange(2000.0), xy, points=100)) == 100


def test_scattered_dots_keep_their_outliers_and_their_density():
    size = np.abs(np.random.default_rng(6).standard_normal(50_000))
    size[[7, 30_000]] = 50.0, np.nan
    rows = scatter(size, 3000)
    assert len(rows) <= 3000
    assert 7 in rows
    # 90 % of the dots are evenly spaced, so they have the median of the whole: 0.674; the tenth
    # that is the largest lifts it to the quantile 0.5 / 0.9 at most, 0.765.
    assert 0.62 < np.nanmedian(size[rows]) < 0.80
    assert scatter(size[:100]).tolist() == list(range(100))


def test_a_focus_has_the_finer_buckets_and_no_extreme_is_lost():
    rng = np.random.default_rng(3)
    t = np.arange(100_000) * 0.01
    y = rng.standard_normal((len(t), 2))
    y[[12_345, 60_000], [0, 1]] = [80.0, -90.0]
    focus = [(200.0, 230.0), (700.0, 720.0)]
    found_t, found = envelope(t, y, 4000, focus)
    inside = sum(int(((found_t >= a) & (found_t < b)).sum()) for a, b in focus)
    assert inside == pytest.approx(2000, abs=10)  # half of the points, but for the rounding of buckets
    assert len(found_t) == len(found) <= 4010
    assert (np.diff(found_t) > 0).all()
    np.testing.assert_array_equal([found.min(0), found.max(0)], [y.min(0), y.max(0)])


def test_a_focus_that_fits_is_kept_row_by_row():
    t = np.arange(10_000) * 0.1
    y = np.random.default_rng(5).standard_normal((len(t), 1))
    found_t, found = envelope(t, y, 2000, [(300.0, 350.0)])
    kept = found[(found_t >= 300.0) & (found_t < 350.0)]
    np.testing.assert_array_equal(kept, y[3000:3500])
