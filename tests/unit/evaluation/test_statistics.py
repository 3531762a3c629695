import numpy as np
import pytest
from scipy import stats

from gapless.evaluation.statistics import consistency, nees, rms, spread
from gapless.filters.quantile import chi_square_quantile


@pytest.mark.parametrize("dof", [1, 2, 3, 6, 50, 999, 20_000, 300_000])
@pytest.mark.parametrize("probability", [0.005, 0.025, 0.5, 0.95, 0.975, 0.999])
def test_quantiles_agree_with_scipy(dof, probability):
    # Bisection stops at 1e-10 of the value; the lower tail at one degree is the steepest.
    assert chi_square_quantile(probability, dof) == pytest.approx(stats.chi2.ppf(probability, dof), rel=1e-8)


def test_spread_of_known_values():
    found = spread([4.0, 1.0, float("nan"), 2.0, 3.0, 5.0])
    assert (found.count, found.median, found.worst) == (5, 3.0, 5.0)
    assert found.p90 == pytest.approx(4.6)  # 0.9 * 4 = 3.6 of the way through the order statistics
    assert found.p95 == pytest.approx(4.8)
    assert found.rms == pytest.approx(np.sqrt(11.0))


def test_spread_of_nothing_is_nan_and_counts_zero():
    found = spread([float("nan")])
    assert found.count == 0
    assert np.isnan([found.median, found.p90, found.p95, found.rms, found.worst]).all()
    assert np.isnan(rms(np.array([np.nan])))


def test_nees_is_the_mahalanobis_distance():
    rng = np.random.default_rng(3)
    root = rng.standard_normal((20, 3, 3))
    covariance = root @ root.transpose(0, 2, 1) + 0.1 * np.eye(3)
    error = rng.standard_normal((20, 3))
    expected = [e @ np.linalg.inv(p) @ e for e, p in zip(error, covariance, strict=True)]
    np.testing.assert_allclose(nees(error, covariance), expected, rtol=1e-9)  # condition below 1e4


def test_nees_is_unknown_where_it_cannot_be():
    covariance = np.array([np.eye(2), np.diag([1.0, np.nan]), [[1.0, 2.0], [2.0, 1.0]], np.eye(2)])
    found = nees(np.array([[3.0, 4.0], [1.0, 1.0], [1.0, 1.0], [np.nan, 1.0]]), covariance)
    assert found[0] == pytest.approx(25.0)
    assert np.isnan(found[1:]).all()


def test_the_band_is_that_of_scipy_and_holds_honest_averages():
    rng = np.random.default_rng(11)
    runs = [consistency(rng.chisquare(3, 50), 3) for _ in range(400)]
    low, high = stats.chi2.ppf([0.025, 0.975], 150) / 50
    assert runs[0].lower == pytest.approx(low, rel=1e-8)
    assert runs[0].upper == pytest.approx(high, rel=1e-8)
    # Binomial(400, 0.95): sd 1.1 %, 4 sd either side.
    assert 0.906 < np.mean([r.honest for r in runs]) < 0.994
    # Binomial(20000, 0.95): sd 0.15 %, 4 sd.
    assert abs(np.mean([r.within for r in runs]) - 0.95) < 0.0062


def test_the_band_refuses_a_covariance_half_as_large_as_it_should_be():
    found = consistency(2.0 * np.random.default_rng(5).chisquare(2, 200), 2)
    assert not found.honest
    assert found.mean > found.upper
    assert found.within < 0.9  # P(chi2_2 < 5.99 / 2) = 0.776


def test_consistency_of_nothing():
    found = consistency(np.array([np.nan]), 2)
    assert found.count == 0
    assert not found.honest
