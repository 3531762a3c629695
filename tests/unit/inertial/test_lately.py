"""What a hole is bridged by, and how far that is trusted."""

import numpy as np
import pytest

from gapless.inertial.lately import Lately
from gapless.inertial.pieces import parted, without_holes
from gapless.trip.events import ImuBlock

DT = 0.01


def block(felt, start=0.0):
    """Samples of these rates and forces, shape (k, 6)."""
    k = len(felt)
    return ImuBlock(start + DT * np.arange(1, k + 1), np.full(k, DT), felt[:, :3] * DT, felt[:, 3:] * DT)


def after(felt):
    lately = Lately()
    lately.feel(block(felt))
    return lately


def shaken(seed, seconds, wander, shake):
    """Rates and forces that walk at random by `wander` a second, and shake."""
    rng, n = np.random.default_rng(seed), round(seconds / DT)
    walk = np.cumsum(rng.normal(0.0, wander * np.sqrt(DT), (n, 6)), axis=0)
    return walk + rng.normal(0.0, shake, (n, 6))


def test_what_stays_the_same_is_bridged_exactly():
    felt = np.tile([0.1, -0.2, 0.3, 1.0, 2.0, -9.8], (1000, 1))
    filling = after(felt).across(10.0, block(felt[:1], 10.73))
    filled = filling.block
    assert len(filled.time) == 73
    assert filled.time[-1] == pytest.approx(10.73, abs=1e-12)
    np.testing.assert_allclose(filled.dtheta.sum(axis=0), 0.73 * felt[0, :3], rtol=1e-12)
    np.testing.assert_allclose(filled.dvel.sum(axis=0), 0.73 * felt[0, 3:], rtol=1e-12)


def test_a_sample_that_shakes_moves_the_line_little_and_one_that_does_not_moves_it():
    ends = []
    for shake in (0.0, 0.3):
        felt = shaken(1, 300.0, 0.05, shake)
        ahead = felt[-20:].mean(axis=0) + 0.2
        filling = after(felt).across(300.0, block(ahead[None], 300.5))
        ends.append((filling.block.dvel[-1] - filling.block.dvel[0]) / (0.2 * DT))
    assert ends[0].min() > 0.8
    assert np.abs(ends[1]).max() < 0.5  # it takes over 0.2 of what it says, and the mean before is off by 0.1


@pytest.mark.parametrize("shake", [0.01, 0.3])
def test_misses_are_as_large_as_is_stated(shake):
    found = []
    felt = shaken(2, 600.0, 0.1, shake)
    for first in range(12000, 59000, 900):
        lately = after(felt[:first])
        for seconds in (0.2, 1.0, 2.0):
            end = first + round(seconds / DT)
            filling = lately.copy().across(first * DT, block(felt[end : end + 1], end * DT))
            missed = (felt[first:end].sum(axis=0) * DT) - np.hstack(
                [filling.block.dtheta.sum(axis=0), filling.block.dvel.sum(axis=0)]
            )
            stated = np.hstack([filling.tilt, filling.doubt * seconds])
            found.append(missed**2 / stated)
    # 53 holes of three lengths on six axes; the lines of neighbours share what was learned
    assert 0.7 < np.mean(found) < 1.4


def test_blocks_change_no_bits_and_a_copy_is_independent():
    felt = shaken(3, 30.0, 0.1, 0.2)
    whole, parts = after(felt), Lately()
    for first in range(0, len(felt), 7):
        parts.feel(block(felt[first : first + 7], first * DT))
    kept = parts.copy()
    closing = block(np.ones((1, 6)), 31.3)
    one, other = (lately.across(30.0, closing) for lately in (whole, kept))
    assert one.doubt.tobytes() == other.doubt.tobytes()
    np.testing.assert_array_equal(one.block.dvel, other.block.dvel)
    again = parts.across(30.0, closing)  # the copy has forgotten what was before the hole, this one not
    np.testing.assert_array_equal(one.block.dvel, again.block.dvel)


def test_a_hole_is_what_no_sample_covers():
    samples = block(np.zeros((300, 6)))
    rows = np.r_[0:100, 101:150, 180:300]
    log = ImuBlock(*(column[rows] for column in samples))
    assert [len(part.time) for part in without_holes(log)] == [100, 49, 120]
    assert parted(1.0, samples.rows(100, 101)) == 0.0
    assert parted(1.0, samples.rows(130, 131)) == pytest.approx(0.3)
