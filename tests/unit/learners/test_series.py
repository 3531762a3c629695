"""Autoregression: lag windows, order from the autocorrelation, forecasts that feed themselves."""

import numpy as np
import pytest
from scipy.signal import correlate
from sklearn.linear_model import LinearRegression

from gapless.learners import make
from gapless.learners.nar import NAR, autocorrelation, autocorrelation_order, lagged


def test_windows_are_the_past_oldest_first():
    series = np.arange(12.0).reshape(6, 2)
    x, y = lagged(series, 3)
    assert np.array_equal(x[0], [0, 1, 2, 3, 4, 5])
    assert np.array_equal(y, series[3:])
    x, y = lagged(series, 2, segment=3)
    assert x.shape == (2, 4)
    assert np.array_equal(y[1], series[3:6].ravel())


def test_autocorrelation_is_scipys():
    series = np.random.default_rng(0).normal(size=(50, 2)).cumsum(axis=0)
    for k in range(2):
        c = series[:, k] - series[:, k].mean()
        full = correlate(c, c)[49:]
        np.testing.assert_allclose(autocorrelation(series, 20)[:, k], full[:21] / full[0], atol=1e-13)
    assert np.all(autocorrelation(np.ones((9, 1)), 3) == 0.0)


def test_order_is_where_a_sine_knows_nothing_of_itself():
    """A quarter of a period later: here after 13 rows, as in the paper."""
    t = np.arange(520)
    assert autocorrelation_order(np.sin(2 * np.pi * t / 52)) == 13
    assert autocorrelation_order(np.ones(30)) == 1
    assert autocorrelation_order(np.arange(4.0)) <= 3


def test_a_linear_recursion_is_forecast_exactly():
    """A damped oscillation obeys a second-order recursion; so does its forecast."""
    t = np.arange(60)
    series = np.column_stack([0.98**t * np.cos(0.3 * t), 5.0 + 0.98**t * np.sin(0.3 * t)])
    model = NAR(LinearRegression(), order=2).fit(series[:40])
    np.testing.assert_allclose(model.forecast(20), series[40:], atol=1e-9)  # rounding of the least squares
    assert np.all(model.test_rms_ < 1e-9)
    assert model.forecast(0).shape == (0, 2)


@pytest.mark.parametrize("segment", [1, 3])
def test_forecasts_feed_themselves(segment):
    series = np.random.default_rng(1).normal(size=(50, 2)).cumsum(axis=0)
    model = NAR(make("relm"), order=4, segment=segment).fit(series)
    rows = list(series)
    for _ in range(7):
        rows.extend(model.regressor_.predict(np.ravel(rows[-4:])[None]).reshape(-1, 2))
    assert np.array_equal(model.forecast(7), np.array(rows[50:57]))
    assert np.array_equal(model.forecast(7, past=series[:30]), model.forecast(9, past=series[26:30])[:7])


def test_the_last_quarter_is_a_test_and_trains_nothing():
    series = np.random.default_rng(2).normal(size=(80, 1))
    other = series.copy()
    other[60:] += 100.0
    models = [NAR(LinearRegression(), order=3).fit(s) for s in (series, other)]
    assert np.array_equal(models[0].regressor_.coef_, models[1].regressor_.coef_)
    x, y = lagged(series[57:], 3)
    rms = np.sqrt(np.mean((models[0].regressor_.predict(x) - y) ** 2))
    assert models[0].test_rms_ == pytest.approx(rms)
    assert models[1].test_rms_ > 10.0


def test_order_is_found_in_the_part_that_trains():
    t = np.arange(400)
    series = np.where(t < 300, np.sin(2 * np.pi * t / 20), np.sin(2 * np.pi * t / 60))[:, None]
    assert NAR(make("relm"), order="auto").fit(series).order_ == 5


def test_a_series_that_is_too_short_is_refused():
    with pytest.raises(ValueError, match="order 5 and segment 1 need 6; give a longer series"):
        NAR(make("relm")).fit(np.zeros((6, 1)))
    with pytest.raises(ValueError, match="give 5 rows or more of 1 columns"):
        NAR(make("relm")).fit(np.zeros((20, 1))).forecast(1, past=np.zeros((3, 1)))


def test_segments_follow_each_other():
    series = np.sin(0.2 * np.arange(100.0))[:, None]
    model = NAR(make("rbf", seed=3), order=8, segment=5).fit(series)
    again = NAR(make("rbf", seed=3), order=8, segment=5).fit(series)
    assert np.array_equal(model.forecast(12), again.forecast(12))
    # a sine of unit height: an RBF network of 20 bells follows it for two segments
    assert np.abs(model.forecast(10)[:, 0] - np.sin(0.2 * np.arange(100.0, 110.0))).max() < 0.1
