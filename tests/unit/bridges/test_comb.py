"""The template of a car out of spectra of which all is known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.bridges.comb import SPEED_BIN, SPEED_BINS, Memory, moving_mean, unmoved
from gapless.bridges.orders import BINS, CHANNELS, LOWEST, ORDERS, STEP, WIDTH, Spectrum, gather

ORDER = LOWEST + STEP * np.arange(ORDERS)
FREQUENCY = WIDTH * np.arange(BINS)
LINES = (0.5, 1.0, 1.5)
BLUR = 0.25
"""Half width of a line: the main lobe of a Hann window of four seconds [Hz]."""


def spectra(n, seed=0, lines=LINES, tone=0.0, slowest=5.0, fastest=20.0):
    """Log power of noise at random speeds, with lines at orders, and one that does not move."""
    rng = np.random.default_rng(seed)
    for speed in rng.uniform(slowest, fastest, n):
        noise = moving_mean(rng.normal(size=(CHANNELS, BINS)), 2) * np.sqrt(5.0)
        for at in [*(order * speed for order in lines), *([tone] if tone else [])]:
            noise += 3.0 * np.exp(-0.5 * ((FREQUENCY - at) / BLUR) ** 2)
        yield Spectrum(noise, 40.0, float(speed), -2.0)


def learned(n, **what):
    memory = Memory.empty(40.0)
    for heard in spectra(n, **what):
        memory = memory.after(heard)
    return memory


def test_the_lines_of_a_car_are_found_where_they_are():
    comb = learned(200).comb()
    mean = comb.height.mean(axis=0)
    near = np.min(np.abs(ORDER[:, None] - np.array(LINES)), axis=1)
    for order in LINES:
        around = np.abs(ORDER - order) < 0.1
        # a line is some 0.02 wide over orders
        assert abs(ORDER[around][mean[around].argmax()] - order) <= 2.0 * STEP
    # a trend of half a cycle over orders takes its share
    assert mean[near <= 0.5 * STEP].min() > 1.5
    assert np.abs(mean[near > 0.2]).max() < 0.3


def test_the_speed_is_where_a_spectrum_fits():
    comb = learned(200).comb()
    speeds = np.arange(5.0, 20.0, 0.1)
    for heard in spectra(30, seed=9):
        found = comb.evidence(heard, speeds)
        assert abs(speeds[found.argmax()] - heard.speed) < 0.3
        assert found.max() > 10.0


def test_noise_has_no_comb_and_no_speed():
    comb = learned(200, lines=()).comb()
    real = learned(200).comb()
    assert np.sqrt(np.mean(comb.height**2)) < 0.15 * np.sqrt(np.mean(real.height**2))
    # the mean of 6 * 311 heights, of which neighbours within a few orders are one: 300 independent ones
    sd = np.sqrt(np.mean(comb.height**2) / 300)
    assert abs(comb.height.mean()) < 4.0 * sd
    told = [comb.evidence(heard, np.array([heard.speed]))[0] for heard in spectra(200, seed=5, lines=())]
    # - T^2 / 2 s^2 summed: what fits nothing is unlikely
    assert np.mean(told) < 0.0
    against = [real.evidence(heard, np.array([heard.speed]))[0] for heard in spectra(100, seed=5, lines=())]
    assert max(against) < 0.0


def test_a_line_that_does_not_move_with_the_speed_is_no_comb():
    """At speeds that hardly change it stands over an order like a comb's."""
    drive = {"lines": (), "slowest": 9.9, "fastest": 10.4}
    memory = learned(300, tone=13.0, **drive)
    kept = memory.total.sum(axis=0) / np.maximum(memory.count.sum(axis=0), 1.0)
    at = np.argmin(np.abs(ORDER - 1.28))
    assert kept[:, at].min() > 1.5, "it is in the sums"
    without, left = learned(300, **drive).comb().height, memory.comb().height
    # the moving mean blurs the mean spectrum, and a speed counts as the middle of its bin: a quarter is left
    # where the line ends, a fortieth over all
    assert np.abs(left).max() < 0.3 * kept[:, at].max()
    assert np.sqrt(np.mean(left**2)) < 0.1
    assert np.sqrt(np.mean(without**2)) < 0.05
    beside = learned(300, tone=13.0).comb().height.mean(axis=0)
    for order in LINES:
        assert beside[np.argmin(np.abs(ORDER - order))] > 1.5


def test_what_the_mean_spectrum_puts_into_the_sums_is_what_it_would_put_in():
    rng = np.random.default_rng(2)
    mean, counts = rng.normal(size=(CHANNELS, BINS)), np.zeros(SPEED_BINS)
    counts[[12, 13, 40]] = 1.0, 3.0, 0.5
    expected = np.zeros((CHANNELS, ORDERS))
    for b in np.flatnonzero(counts):
        total, n, square = np.zeros((CHANNELS, ORDERS)), np.zeros(ORDERS), np.zeros(CHANNELS)
        gather(mean, 40.0, (b + 0.5) * SPEED_BIN, total, n, square)
        expected += counts[b] * total
    assert_allclose(unmoved(mean, 40.0, counts), expected, atol=1e-11)


def test_what_is_remembered_is_never_changed():
    """Copies of a bridge share the arrays."""
    memory = learned(5)
    kept = {name: np.copy(value) for name, value in vars(memory).items()}
    for heard in spectra(3, seed=8):
        memory.after(heard)
    memory.comb()
    for name, value in vars(memory).items():
        assert np.array_equal(value, kept[name]), name


def test_what_was_long_ago_counts_less():
    memory = learned(2000)
    # 1 / (1 - exp(-1 / 300))
    assert memory.windows == pytest.approx(300.5, rel=2e-3)
    assert memory.speeds.sum() == pytest.approx(memory.windows)


def test_moving_mean():
    rows = np.random.default_rng(1).normal(size=(2, 40))
    padded = np.pad(rows, ((0, 0), (3, 3)), mode="edge")
    expected = [np.convolve(row, np.ones(7) / 7.0, mode="valid") for row in padded]
    assert_allclose(moving_mean(rows, 3), expected, atol=1e-13)
