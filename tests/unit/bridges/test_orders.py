"""Order spectra against closed form, NumPy and SciPy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import median_filter

from gapless.bridges.orders import (
    BASE,
    BINS,
    CHANNELS,
    LONGEST,
    LOWEST,
    ORDERS,
    PAD,
    STEP,
    TINY,
    WAY,
    WIDTH,
    WINDOW,
    gather,
    spectrum,
    warp,
    whiten,
    window,
)

ORDER = LOWEST + STEP * np.arange(ORDERS)


def speeding_up(rate, first=8.0, gain=1.5, order=2.0, span=4.6):
    """A tone at an order of a wheel that turns ever faster: samples, speed history."""
    t = np.arange(0.0, span, 1.0 / rate)
    way = first * t + 0.5 * gain * t**2
    tone = np.cos(2.0 * np.pi * order * way[:, None] + np.arange(CHANNELS)) * (1.0 + np.arange(CHANNELS))
    times = np.arange(0.0, span, 0.01)
    return np.column_stack([t, tone + 9.8]), times, first + gain * times


def test_a_chirp_that_follows_the_speed_is_warped_into_a_tone():
    samples, times, speeds = speeding_up(2000.0)
    begin, end, n = 0.3, 4.3, 512
    found = warp(samples, times, speeds, begin, end, n)
    way = lambda t: 8.0 * t + 0.75 * t**2  # noqa: E731
    road = way(begin) + (way(end) - way(begin)) * np.arange(n) / n
    tone = np.cos(2.0 * np.pi * 2.0 * road[:, None] + np.arange(CHANNELS)) * (1.0 + np.arange(CHANNELS))
    expected = ((tone - tone.mean(axis=0)) * np.hanning(n)[:, None]).T
    # straight lines between samples are off by (2 pi f / rate)^2 / 8 = 1e-3 of an amplitude at 28 Hz;
    # between speeds 0.01 s apart the way by 1.5 * 0.01^2 / 8 m, 2.4e-4 rad
    assert_allclose(found, expected, atol=1.5e-3 * CHANNELS)


def test_one_line_where_an_ordinary_spectrum_smears_it():
    samples, times, speeds = speeding_up(200.0)
    now = times <= 4.4
    heard = spectrum(samples, times[now], speeds[now], WINDOW, 97.0)
    assert heard.log.shape == (CHANNELS, BINS)
    assert heard.top == 40.0
    assert heard.speed == pytest.approx(8.0 + 1.5 * 2.4, abs=0.01)
    line = round(2.0 * heard.speed / WIDTH)
    assert np.abs(heard.log.argmax(axis=1) - line).max() <= 1
    rows = samples[(samples[:, 0] >= 4.4 - WINDOW) & (samples[:, 0] < 4.4), 1:]
    plain = np.abs(np.fft.rfft((rows - rows.mean(axis=0)).T * np.hanning(len(rows)), axis=1)) ** 2
    warped = np.abs(np.fft.rfft(warp(samples, times, speeds, 0.4, 4.4, 1024), axis=1)) ** 2
    strongest = [np.sort(p, axis=1)[:, -3:].sum(axis=1) / p.sum(axis=1) for p in (plain, warped)]
    # all of a Hann window's main lobe is in three bins; a chirp from 17 to 29 Hz lies in fifty
    assert (strongest[1] > 0.99).all()
    assert (strongest[0] < 0.4).all()


@pytest.mark.parametrize("columns", [1025, 4097])
def test_whitening_is_a_running_median_of_every_fourth_bin(columns):
    rng = np.random.default_rng(3)
    power = np.exp(rng.normal(size=(CHANNELS, columns)) - np.linspace(0.0, 8.0, columns))
    log = np.log(power + TINY)
    base = median_filter(log[:, ::PAD], size=(1, BASE), mode="nearest").repeat(PAD, axis=1)
    # the same numbers, taken apart in the same order: not a bit of difference but in the logarithm's last
    assert_allclose(whiten(power), log[:, :BINS] - base[:, :BINS], atol=1e-13)


def test_sums_over_orders_are_interpolation():
    rng = np.random.default_rng(4)
    log, speed, top = rng.normal(size=(CHANNELS, BINS)), 13.37, 37.0
    total, count, square = rng.normal(size=(CHANNELS, ORDERS)), rng.random(ORDERS), rng.random(CHANNELS)
    before = total.copy(), count.copy(), square.copy()
    gather(log, top, speed, total, count, square)
    told = ORDER * speed < top
    at = np.array([np.interp(ORDER * speed, WIDTH * np.arange(BINS), row) for row in log]) * told
    assert_allclose(total - before[0], at, atol=1e-11)
    assert_allclose(count - before[1], told, atol=1e-12)
    assert_allclose(square - before[2], (at**2).sum(axis=1), atol=1e-10)
    assert 0 < told.sum() < ORDERS


def window_of(speeds, dt=0.05):
    return window(dt * np.arange(len(speeds)), np.asarray(speeds, float))


def test_a_window_is_as_long_as_the_car_takes_for_its_way():
    steady = lambda v: window_of(np.full(200, v))  # noqa: E731
    assert steady(20.0) == pytest.approx(WINDOW)
    assert steady(WAY / 6.0) == pytest.approx(6.0, abs=0.06)  # history every 0.05 s
    assert steady(1.0) == pytest.approx(LONGEST)


def test_no_window_reaches_back_into_a_crawl():
    assert window_of([0.2] * 100 + [2.0] * 101) == pytest.approx(5.0, abs=0.06)
    assert window_of([0.2] * 150 + [2.0] * 50) == 0.0
    assert window_of([2.0] * 199 + [0.2]) == 0.0
    assert window_of([2.0] * 60) == 0.0


def test_a_longer_window_has_the_same_lines_and_loudness():
    """Twice the samples in as many bins: a steady car sounds the same."""
    samples, times, _ = speeding_up(200.0, first=3.0, gain=0.0, order=2.0, span=8.6)
    samples[:, 1:] += np.random.default_rng(2).normal(size=(len(samples), CHANNELS))
    steady = np.full(len(times), 3.0)
    short, long = (spectrum(samples, times, steady, length, 40.0) for length in (WINDOW, LONGEST))
    assert short.log.shape == long.log.shape
    lines = (short.log.argmax(axis=1), long.log.argmax(axis=1))
    assert np.abs(np.array(lines) - 2.0 * 3.0 / WIDTH).max() <= 1
    # white noise of some 300 independent bins a channel: a twentieth of its power either way
    assert short.level == pytest.approx(long.level, abs=0.1)
