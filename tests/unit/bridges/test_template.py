"""How well spectra fit a comb, against the two normals that it stands for."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.bridges.orders import BINS, CHANNELS, LOWEST, ORDERS, STEP, WIDTH, Spectrum
from gapless.bridges.template import BEYOND, Comb

ORDER = LOWEST + STEP * np.arange(ORDERS)
SPEEDS = np.array([2.5, 9.0, 14.2, 31.0])


def comb(rng):
    height = rng.normal(size=(CHANNELS, ORDERS))
    height[:, 100:150] = 0.0
    variance = rng.uniform(0.5, 2.0, CHANNELS)
    return Comb(height, np.ones_like(height), variance, rng.normal(size=(CHANNELS, BINS)), np.zeros((3, 3)))


def at_orders(log, speed):
    return np.array([np.interp(ORDER * speed, WIDTH * np.arange(BINS), row) for row in log])


def test_evidence_is_the_log_likelihood_ratio_of_two_normals():
    rng = np.random.default_rng(5)
    one, log, top = comb(rng), 0.1 * rng.normal(size=(CHANNELS, BINS)), 40.0
    found = one.evidence(Spectrum(one.mean + log, top, 9.0, -2.0), SPEEDS)
    for speed, got in zip(SPEEDS, found, strict=True):
        told, y = ORDER * speed < top, at_orders(log, speed)
        against = (y**2 - (y - one.height) ** 2) / (2.0 * one.variance[:, None])
        assert got == pytest.approx(against[:, told].sum(), rel=1e-9, abs=1e-9)


def test_what_is_far_from_both_is_no_more_news():
    rng = np.random.default_rng(6)
    one, log, top = comb(rng), 6.0 * rng.normal(size=(CHANNELS, BINS)), 40.0
    found = one.evidence(Spectrum(one.mean + log, top, 9.0, -2.0), SPEEDS)
    far = BEYOND * np.sqrt(one.variance)[:, None]
    for speed, got in zip(SPEEDS, found, strict=True):
        told, y = ORDER * speed < top, at_orders(log, speed)
        y = np.clip(y, np.minimum(one.height, 0.0) - far, np.maximum(one.height, 0.0) + far)
        against = (y**2 - (y - one.height) ** 2) / (2.0 * one.variance[:, None])
        assert got == pytest.approx(against[:, told].sum(), rel=1e-9)


def test_a_stranger_s_line_moves_the_evidence_by_a_bounded_amount():
    """However loud: with a line of 3 or of 300 nats through all channels, the same bits."""
    rng = np.random.default_rng(7)
    one, log = comb(rng), rng.normal(size=(CHANNELS, BINS))
    found = []
    for loud in (20.0, 300.0):
        line = log.copy()
        line[:, 205:212] += loud
        found.append(one.evidence(Spectrum(one.mean + line, 40.0, 9.0, -2.0), SPEEDS))
    assert_allclose(found[0], found[1], rtol=1e-12)
