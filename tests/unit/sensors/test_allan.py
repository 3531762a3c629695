import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.sensors import allan_deviation, gauss_markov, read_allan

DT = 0.01


def white(n, density, seed=0):
    return density / np.sqrt(DT) * np.random.default_rng(seed).standard_normal(n)


def test_white_noise_falls_with_the_root_of_time():
    tau, deviation = allan_deviation(white(400_000, 0.02), DT, [0.01, 0.1, 1.0, 10.0])
    # relative sd of the overlapping estimate about sqrt(m / n): 0.5 % at 10 s, 5 % taken
    assert_allclose(deviation, 0.02 / np.sqrt(tau), rtol=0.05)


def test_a_ramp_rises_with_time():
    tau, deviation = allan_deviation(0.3 * DT * np.arange(20000), DT, [0.1, 1.0, 10.0])
    assert_allclose(deviation, 0.3 * tau / np.sqrt(2.0), rtol=1e-9)  # IEEE Std 952: rate ramp R tau / sqrt 2


def test_the_definition_in_six_numbers():
    rate = np.array([1.0, 2.0, 4.0, 7.0, 11.0, 16.0])
    _, one = allan_deviation(rate, 1.0, [1.0])
    _, two = allan_deviation(rate, 1.0, [2.0])
    assert_allclose(one, np.sqrt(np.mean(np.diff(rate) ** 2) / 2.0))
    means = (rate[1:] + rate[:-1]) / 2.0
    assert_allclose(two, np.sqrt(np.mean((means[2:] - means[:-2]) ** 2) / 2.0))


def test_axes_are_apart():
    both = np.column_stack([white(5000, 1.0, 1), white(5000, 2.0, 2)])
    _, together = allan_deviation(both, DT)
    for k in range(2):
        assert_allclose(together[:, k], allan_deviation(both[:, k], DT)[1], rtol=1e-9)


def test_reading_finds_the_noise_density_and_the_instability():
    n, sd, tau = 1_000_000, 1e-3, 100.0
    rate = white(n, 2e-3) + gauss_markov(np.full(n, DT), sd, tau, np.random.default_rng(5), axes=1)[:, 0]
    reading = read_allan(*allan_deviation(rate, DT))
    assert reading.noise == pytest.approx(2e-3, rel=0.05)  # as above
    # closed form: sigma^2 = N^2/tau + (2 sd^2 T/tau)(1 - T/(2 tau)(3 - 4 e^-x + e^-2x)), x = tau/T
    t = np.logspace(-2, 3, 400)
    x = t / tau
    closed = 4e-6 / t + 2 * sd**2 / x * (1 - (3 - 4 * np.exp(-x) + np.exp(-2 * x)) / (2 * x))
    # 10^4 s hold some hundred averages of the time at the minimum: 10 %, three of them
    assert reading.instability == pytest.approx(np.sqrt(closed[t < 100].min()) / 0.664, rel=0.3)


def test_too_short_a_record_says_so():
    with pytest.raises(ValueError, match="too few"):
        allan_deviation(np.zeros(10), 1.0, [6.0])
