import numpy as np
import pytest
from scipy import stats

from gapless.sensors import band_limited, gauss_markov, random_walk


def within_chi_square(sample, variance, probability=1e-4):
    """Whether independent zero-mean draws have a variance, two-sided."""
    low, high = stats.chi2.ppf([probability / 2, 1 - probability / 2], sample.size)
    return low < np.sum(sample**2) / variance < high


def test_gauss_markov_is_stationary_from_its_first_sample():
    rng = np.random.default_rng(1)
    dt = rng.uniform(0.5, 2.0, 6)
    x = gauss_markov(dt, 3.0, 4.0, rng, axes=20000)
    for row in x:
        assert within_chi_square(row, 9.0)


def test_gauss_markov_steps_are_exact_for_uneven_intervals():
    rng = np.random.default_rng(2)
    dt = rng.uniform(0.01, 30.0, 20000)
    x = gauss_markov(dt, 0.5, 10.0, rng)
    phi = np.exp(-dt / 10.0)[1:, None]
    driving = (x[1:] - phi * x[:-1]) / (0.5 * np.sqrt(1.0 - phi**2))
    assert within_chi_square(driving, 1.0)
    # correlation of neighbours: mean of 60000 products of unit variance, four sigma
    assert abs(np.mean(driving[1:] * driving[:-1])) < 4 / np.sqrt(driving.size)


def test_random_walk_grows_with_the_root_of_time():
    rng = np.random.default_rng(3)
    x = random_walk(np.full(400, 0.25), 0.2, rng, axes=5000)
    assert within_chi_square(x[-1], 0.04 * 100.0)
    assert within_chi_square(np.diff(x, axis=0), 0.04 * 0.25)


def test_band_limited_noise_keeps_to_its_band():
    x = band_limited(20000, 0.01, (8.0, 30.0), np.random.default_rng(4))
    # 22 Hz over 200 s hold 4400 frequencies, twice as many degrees of freedom: sd of the variance 1.5 %
    assert x.var(axis=0) == pytest.approx(1.0, abs=0.06)
    power = np.abs(np.fft.rfft(x, axis=0)) ** 2
    f = np.fft.rfftfreq(20000, 0.01)
    assert power[(f < 7.99) | (f > 30.01)].sum() < 1e-20 * power.sum()
    assert np.abs(np.cumsum(x, axis=0) * 0.01).max() < 0.2  # sd 1 / (2 pi 8 Hz) = 0.02 at most


def test_a_band_above_half_the_sample_rate_is_silent():
    assert not band_limited(100, 0.1, (8.0, 30.0), np.random.default_rng(4)).any()
