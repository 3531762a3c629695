"""The EMD family against the papers' steps taken slowly, with PyEMD's modes, and against white noise."""

from itertools import groupby

import numpy as np
import pytest
import pywt
from PyEMD import EMD

from gapless.denoise import Emd, EmdCiit, EmdIit, EmdIt
from gapless.denoise.noise_model import energy_bound, noise_energy, noise_level, shrink_intervals
from gapless.denoise.sifting import decompose
from gapless.errors import ConfigError

RATE = 100.0


def noisy(n=1200, seed=4):
    t = np.arange(n) / RATE
    return np.sin(2.0 * np.pi * 0.3 * t) + 0.3 * np.random.default_rng(seed).normal(size=n)


def pyemd(x):
    """Modes, the residue as the last row."""
    emd = EMD(FIXE=10, range_thr=0.0, total_power_thr=0.0)
    emd.emd(x)
    return np.vstack([emd.imfs, emd.residue])


def thresholded(x, sigma, factor=0.7):
    """Steps 6 and 7 of liu2019, interval by interval, eq. 13; thresholds as on the papers page."""
    *imfs, residue = pyemd(x)
    total = residue.copy()
    for i, h in enumerate(imfs, 1):
        energy = sigma**2 if i == 1 else sigma**2 / 0.719 * 2.01**-i
        limit = factor * np.sqrt(2.0 * energy * np.log(len(x)))
        for _, run in groupby(range(len(x)), key=lambda k, h=h: h[k] > 0.0):
            z = list(run)
            r = np.abs(h[z]).max()
            total[z] += h[z] * (r - limit) / r if r > limit else 0.0
    return total


def sigma_of(h):
    return np.median(np.abs(h)) / 0.6745


def bayes(h):
    """Bayesian shrinkage (Chang et al. 2000) of a mode."""
    coarse, *details = pywt.wavedec(h, "sym8", mode="symmetric")
    sigma = sigma_of(details[-1])
    for k, d in enumerate(details):
        spread = np.sqrt(max(np.mean(d**2) - sigma**2, 0.0))
        limit = sigma**2 / spread if spread > 0.0 else np.inf
        details[k] = np.sign(d) * np.maximum(np.abs(d) - limit, 0.0)
    return pywt.waverec([coarse, *details], "sym8", mode="symmetric")[: len(h)]


SLACK = 1e-9
"""Of signals of size one: PyEMD's modes are ours to 5e-15, thresholds are continuous in them."""


def test_interval_thresholding():
    x = noisy()
    assert np.abs(EmdIt()(x, RATE) - thresholded(x, sigma_of(pyemd(x)[0]))).max() < SLACK


@pytest.mark.parametrize("alteration", ["circulation", "permutation"])
@pytest.mark.parametrize("clear", [False, True])
def test_iterative_interval_thresholding(clear, alteration):
    """EMD-IIT and EMD-CIIT, steps 1 to 9 of liu2019, with the same random numbers."""
    x, rng, each = noisy(), np.random.default_rng(11), []
    first = pyemd(x)[0]
    noise = first - bayes(first) if clear else first
    for _ in range(5):
        turned = alteration == "circulation"
        moved = np.roll(noise, rng.integers(len(x))) if turned else rng.permutation(noise)
        each.append(thresholded(x - noise + moved, sigma_of(first)))
    kind = EmdCiit if clear else EmdIit
    ours = kind(alteration=alteration, seed=11)(x, RATE)
    assert np.abs(ours - np.mean(each, axis=0)).max() < SLACK


def test_partial_reconstruction_keeps_what_exceeds_noise():
    """What it leaves out are first modes, and the next one is beyond the bound."""
    x = noisy()
    rows, kept = pyemd(x), Emd()(x, RATE)
    sigma = sigma_of(rows[0])
    energies = np.mean(np.square(rows[:-1]), axis=1)
    bounds = [energy_bound(sigma, i) for i in range(2, len(rows))]
    gone = 1 + int(np.argmax(energies[1:] > bounds))
    assert gone > 1
    assert np.abs(kept - rows[gone:].sum(axis=0)).max() < SLACK


@pytest.fixture(scope="module")
def white():
    """Of 400 records of 2048 samples (Flandrin's length) of noise: sigma_1^2, energies of modes 1 to 7."""
    rng, rows = np.random.default_rng(2), []
    for _ in range(400):
        imfs, _ = decompose(rng.normal(size=2048))
        rows.append([noise_level(imfs[0]) ** 2, *np.mean(np.square(imfs[:7]), axis=1)])
    return np.array(rows)


def test_white_noise_has_the_energies_of_the_model(white):
    """Means of modes 2 to 6 within 20 %: the model is a straight line through logarithms."""
    first = np.sqrt(white[:, 1].mean())
    for i in range(2, 7):
        assert white[:, i].mean() == pytest.approx(noise_energy(first, i), rel=0.2), i


def test_white_noise_seldom_exceeds_its_bound(white):
    """One record in a hundred (of 400, 2 % at the most), and not far less: within a factor of two."""
    for i in range(2, 8):
        ratio = white[:, i] / white[:, 1]
        assert np.mean(ratio > energy_bound(1.0, i)) < 0.02, i
        assert energy_bound(1.0, i) < 2.0 * np.quantile(ratio, 0.99), i


def test_the_median_overstates_the_noise(white):
    """As `noise_level` says: by 1.46, which 400 records tell to 1 %."""
    assert np.mean(white[:, 0]) / np.mean(white[:, 1]) == pytest.approx(1.46, rel=0.03)


def test_intervals_are_scaled_as_their_extremum():
    """By hand: extrema 3, -1 and 2 at T = 1 leave 2/3, nothing and 1/2."""
    mode = np.array([1.5, 3.0, 0.3, -0.5, -1.0, 2.0, 1.0])
    out = np.full(7, 10.0)
    shrink_intervals(mode, 1.0, out)
    assert out == pytest.approx([11.0, 12.0, 10.2, 10.0, 10.0, 11.0, 10.5], abs=1e-14)


def test_nothing_is_thresholded_away_with_a_factor_of_nought():
    """EMD-CIIT then averages versions of the record that differ in where its noise lies."""
    x = noisy()
    assert np.abs(EmdIt(factor=0.0)(x, RATE) - x).max() < 1e-13


def test_the_seed_decides():
    x = noisy()
    assert np.array_equal(EmdCiit(seed=3)(x, RATE), EmdCiit(seed=3)(x, RATE))
    assert not np.array_equal(EmdCiit(seed=3)(x, RATE), EmdCiit(seed=4)(x, RATE))


@pytest.mark.parametrize(
    ("kind", "wrong", "said"),
    [
        (Emd, {"siftings": 0}, "siftings = 0"),
        (EmdIt, {"factor": -0.1}, "factor"),
        (EmdIt, {"factor": float("nan")}, "factor"),
        (EmdIit, {"iterations": 0}, "iterations = 0; give 1 or more"),
        (EmdCiit, {"alteration": "shuffle"}, "circulation or permutation"),
        (EmdCiit, {"seed": -1}, "seed"),
    ],
)
def test_wrong_parameters_are_refused(kind, wrong, said):
    with pytest.raises(ConfigError, match=said):
        kind(**wrong)
