"""The wheels' circumference from an order spectrum."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gapless.trip.exhibits import fundamental

ORDERS = 0.2 + 0.01 * np.arange(311)
ERROR = np.full((6, 311), 0.1)


def comb(around, strengths, rng):
    """Lines of 0.02 cycles/m width in unit noise, and what shrinking leaves of them."""
    raw = rng.standard_normal((6, 311))
    raw = (raw + np.roll(raw, 1, axis=1) + np.roll(raw, -1, axis=1)) / np.sqrt(3.0)  # as bins are: alike
    for k, strength in enumerate(strengths, 1):
        raw += strength * np.exp(-0.5 * ((ORDERS - k / around) / 0.02) ** 2)
    return ERROR * raw * np.maximum(0.0, 1.0 - 1.0 / raw**2)


@settings(deadline=None, max_examples=40)
@given(
    around=st.floats(1.5, 2.6),
    strengths=st.lists(st.floats(6.0, 15.0), min_size=5, max_size=6),
    seed=st.integers(0, 2**32 - 1),
)
def test_finds_the_fundamental_and_not_its_half_or_double(around, strengths, seed):
    found, contrast = fundamental(ORDERS, comb(around, strengths, np.random.default_rng(seed)), ERROR)
    assert contrast > 5.0
    # the fourth line, 0.02 wide, fixes the fundamental to a fraction of 0.005 cycles/m: below 2 %
    assert found == pytest.approx(around, rel=0.02)


def test_noise_alone_has_no_circumference():
    contrasts = []
    for seed in range(40):
        found, contrast = fundamental(ORDERS, comb(2.0, (), np.random.default_rng(seed)), ERROR)
        assert found is None
        contrasts.append(contrast)
    assert max(contrasts) > 2.0  # so the threshold is tried by something


def test_one_line_is_no_comb():
    height = np.zeros((6, 311))
    height[:, 80] = 1.0
    found, contrast = fundamental(ORDERS, height, ERROR)
    # a line at 1 cycle/m could be the second of 2 m or the third of 3 m: nothing tells which
    assert contrast < 20.0
    assert found is None or abs(1.0 / found * round(found) - 1.0) < 0.01


def test_silence_has_no_circumference():
    assert fundamental(ORDERS, np.zeros((6, 311)), ERROR) == (None, 0.0)
