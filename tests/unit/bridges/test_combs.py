"""Combs that differ by speed."""

import numpy as np
from numpy.testing import assert_allclose

from gapless.bridges.comb import Memory
from gapless.bridges.combs import Combs
from gapless.bridges.knots import KNOTS, shares
from gapless.bridges.orders import BINS, CHANNELS, LOWEST, ORDERS, STEP, WIDTH, Spectrum

ORDER = LOWEST + STEP * np.arange(ORDERS)
FREQUENCY = WIDTH * np.arange(BINS)
WHEEL, LOW_GEAR, HIGH_GEAR = 0.5, 1.4, 0.8
"""Orders of lines: of a wheel, and of an engine below and above a change of gear [cycles/m]."""
CHANGE = 9.0
"""Speed of the change [m/s]."""


def spectra(n, seed=0, gears=True, slowest=4.0, fastest=20.0, line=3.0):
    """Log power of noise of one with a wheel's line, and an engine's."""
    rng = np.random.default_rng(seed)
    for speed in rng.uniform(slowest, fastest, n):
        noise = rng.normal(size=(CHANNELS, BINS))
        engine = LOW_GEAR if speed < CHANGE else HIGH_GEAR
        for order in (WHEEL, *([engine] if gears else [])):
            noise += line * np.exp(-0.5 * ((FREQUENCY - order * speed) / (2.0 * WIDTH)) ** 2)
        yield Spectrum(noise, 40.0, float(speed), -2.0)


def learned(n, **what):
    memory = Memory.empty(40.0)
    for heard in spectra(n, **what):
        memory = memory.after(heard)
    return memory


def height(comb, order):
    return comb.height.mean(axis=0)[np.abs(ORDER - order) <= STEP].max()


def test_speeds_are_shared_by_the_knots_around_them():
    speeds = np.linspace(0.0, 30.0, 301)
    found = shares(speeds)
    assert_allclose(found.sum(axis=1), 1.0, atol=1e-12)
    inside = (speeds >= KNOTS[0]) & (speeds <= KNOTS[-1])
    assert_allclose(found[inside] @ np.array(KNOTS), speeds[inside], atol=1e-12)
    assert_allclose(found[speeds < KNOTS[0]], [[1.0, 0.0, 0.0]] * int((speeds < KNOTS[0]).sum()))


def test_a_gear_s_lines_are_where_it_is_driven():
    combs = Combs.of(learned(300))
    slow, fast = combs.at(KNOTS[0]), combs.at(KNOTS[-1])
    # 3 in the spectra; a trend and its neighbours' share take some of it
    assert height(slow, LOW_GEAR) > 1.5 > 1.0 > height(fast, LOW_GEAR)
    assert height(fast, HIGH_GEAR) > 1.5 > 1.0 > height(slow, HIGH_GEAR)
    assert min(height(slow, WHEEL), height(fast, WHEEL)) > 1.5


def test_a_gear_says_more_of_the_speed_than_the_mean_of_all():
    combs, gain = Combs.of(learned(300, line=0.8)), []
    for heard in spectra(100, seed=7, line=0.8):
        speeds = heard.speed + np.arange(-3.0, 3.01, 0.1)
        for sign, comb in ((1.0, combs.at(heard.speed)), (-1.0, combs.common)):
            told = 0.15 * comb.evidence(heard, speeds)
            gain.append(sign * (told[30] - np.log(np.mean(np.exp(told)))))
    # nats a spectrum
    assert 2.0 * np.mean(gain) > 0.2


def test_without_gears_only_the_width_of_lines_differs():
    """A line as wide as the window's resolution is wider over orders the slower the car."""
    combs = Combs.of(learned(300, gears=False))
    flanks = np.abs(np.abs(ORDER - WHEEL) - 0.03) < 0.025
    slow, fast = (combs.at(v).height.mean(axis=0)[flanks].mean() for v in (KNOTS[0], KNOTS[-1]))
    assert slow > fast + 0.5
    far = np.abs(ORDER - WHEEL) > 0.15
    # a line's height is 3; of noise, what is less than its standard error is zero and the rest is cut down
    assert np.sqrt(np.mean(combs.others[:, :, far] ** 2)) < 0.05


def test_where_nothing_was_driven_the_common_comb_is_at_hand():
    combs = Combs.of(learned(200, slowest=4.0, fastest=4.9))
    assert np.array_equal(combs.others[1:], np.zeros_like(combs.others[1:]))
    assert_allclose(combs.at(20.0).height, combs.common.height)


def test_the_common_comb_is_that_of_all_spectra():
    memory = learned(150)
    assert np.array_equal(Combs.of(memory).common.height, memory.comb().height)
