"""Our decomposition against PyEMD's, and against what a decomposition must do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PyEMD import EMD

from gapless.denoise.sifting import decompose, extrema, modes


def pyemd(x, siftings):
    """With our number of siftings, and going on until fewer than three extrema are left, as we do.

    (By default it stops at a residue of absolute size, whatever the signal's unit.)
    """
    emd = EMD(FIXE=siftings, range_thr=0.0, total_power_thr=0.0)
    emd.emd(x)
    return emd.imfs, emd.residue


def signal(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(40, 1500))
    noise, wander = rng.uniform(0.0, 1.0) * rng.normal(size=n), 0.02 * np.cumsum(rng.normal(size=n))
    return noise + wander + np.sin(rng.uniform(0.0, 0.3) * np.arange(n))


@pytest.mark.parametrize("siftings", [1, 10])
@pytest.mark.parametrize("seed", range(25))
def test_modes_are_those_of_pyemd(seed, siftings):
    """Same extrema, mirrored ends and not-a-knot splines: apart by rounding alone.

    5e-15 of the signal's spread was seen; 1e-11 leaves room for other compilers' order of sums.
    """
    x = signal(seed)
    ours, residue = decompose(x, siftings)
    theirs, rest = pyemd(x, siftings)
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max(initial=0.0) < 1e-11 * np.std(x)
    assert np.abs(residue - rest).max() < 1e-11 * np.std(x)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-4, 4).map(float) | st.floats(-1e4, 1e4, allow_subnormal=False), max_size=80))
def test_modes_and_residue_sum_up_to_the_signal(values):
    """To rounding: each mode is taken away once, and may be some times as large as the signal."""
    x = np.array(values, dtype=float)
    imfs, residue = decompose(x)
    size = np.abs(imfs).sum(axis=0) + np.abs(residue) + np.abs(x)
    assert np.all(np.abs(imfs.sum(axis=0) + residue - x) <= 1e-14 * size)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(-2, 2).map(float), min_size=1, max_size=40))
def test_extrema_and_plateaus(values):
    """Against the signal without its repetitions, whose extrema are plain to see."""
    x = np.array(values)
    tops, bottoms = np.zeros(len(x) // 2 + 1, int), np.zeros(len(x) // 2 + 1, int)
    nt, nb = extrema(x, tops, bottoms)
    starts = np.flatnonzero(np.diff(x, prepend=np.nan) != 0.0)
    ends = np.append(starts[1:], len(x)) - 1
    level = x[starts]
    inner = range(1, len(level) - 1)
    middle = (starts + ends) // 2
    assert list(tops[:nt]) == [middle[k] for k in inner if level[k] > max(level[k - 1], level[k + 1])]
    assert list(bottoms[:nb]) == [middle[k] for k in inner if level[k] < min(level[k - 1], level[k + 1])]


def test_two_tones_come_apart():
    """Five octaves apart, to 2 % (1.1 % was seen: extrema fall between samples); without the ends."""
    t = np.arange(4000) / 100.0
    fast, slow = np.sin(2.0 * np.pi * 8.0 * t), 2.0 * np.sin(2.0 * np.pi * 0.25 * t)
    first = next(modes(fast + slow))
    assert np.abs(first - fast)[400:-400].max() < 0.02


@pytest.mark.parametrize(
    "x",
    [np.zeros(0), np.zeros(1), np.full(50, 2.0), np.arange(50.0), np.arange(50.0) ** 2, [0.0, 1.0, 0.0, 1.0]],
    ids=["empty", "one", "constant", "straight", "bent", "two extrema"],
)
def test_fewer_than_three_extrema_are_no_mode(x):
    imfs, residue = decompose(np.array(x))
    assert imfs.shape == (0, len(x))
    assert np.array_equal(residue, x)


def test_the_signal_is_left_alone():
    x = signal(3)
    kept = x.copy()
    for mode in modes(x):
        mode[:] = 0.0
    assert np.array_equal(x, kept)


def test_a_signal_of_rounding_errors_ends():
    """About an offset of 1e6, below what doubles hold beside it."""
    x = 1e6 + 1e-11 * np.random.default_rng(0).normal(size=500)
    assert len(decompose(x)[0]) < 20
