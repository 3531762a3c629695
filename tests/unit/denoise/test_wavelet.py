"""Wavelet thresholding against its formulas written out, and without PyWavelets."""

import sys

import numpy as np
import pytest
import pywt

from gapless.denoise import EmdCiit, Wavelet
from gapless.errors import ConfigError, MissingExtraError

RATE = 100.0


def noisy(n=1024):
    t = np.arange(n) / n
    return np.sin(6.0 * np.pi * t) + (t > 0.4) + 0.3 * np.random.default_rng(5).normal(size=n)


def rules(d, sigma, n):
    """Each thresholding of one level's details, from its formula."""
    universal = sigma * np.sqrt(2.0 * np.log(n))
    bayes = sigma**2 / np.sqrt(np.mean(d**2) - sigma**2) if np.mean(d**2) > sigma**2 else np.inf
    return {
        "soft": np.sign(d) * np.maximum(np.abs(d) - universal, 0.0),
        "hard": d * (np.abs(d) > universal),
        "bayes": np.sign(d) * np.maximum(np.abs(d) - bayes, 0.0),
    }


@pytest.mark.parametrize("thresholding", ["soft", "hard", "bayes"])
@pytest.mark.parametrize("wavelet", ["sym8", "db4"])
def test_thresholding(thresholding, wavelet):
    """Apart by rounding alone."""
    x = noisy()
    coarse, *details = pywt.wavedec(x, wavelet, mode="symmetric")
    sigma = np.median(np.abs(details[-1])) / 0.6745
    kept = [rules(d, sigma, len(x))[thresholding] for d in details]
    expected = pywt.waverec([coarse, *kept], wavelet, mode="symmetric")
    assert np.abs(Wavelet(thresholding, wavelet)(x, RATE) - expected).max() < 1e-12


def test_bayesian_shrinkage_leaves_least_error():
    """On a signal with a step, as Chang et al. found on pictures with edges."""
    x, rng = noisy(), np.random.default_rng(0)
    smooth = x - x + np.sin(6.0 * np.pi * np.arange(1024) / 1024) + (np.arange(1024) > 0.4 * 1024)
    errors = dict.fromkeys(("soft", "bayes"), 0.0)
    for _ in range(20):
        raw = smooth + 0.3 * rng.normal(size=1024)
        for k in errors:
            errors[k] += float(np.mean((Wavelet(k)(raw, RATE) - smooth) ** 2))
    assert errors["bayes"] < errors["soft"]


@pytest.mark.parametrize("denoiser", [Wavelet(), EmdCiit()])
def test_without_pywavelets_one_line_says_what_to_install(denoiser, monkeypatch):
    monkeypatch.setitem(sys.modules, "pywt", None)
    with pytest.raises(MissingExtraError, match=r"PyWavelets is not .* pip install 'gapless\[learn\]'"):
        denoiser(noisy(), RATE)


def test_names_are_checked():
    with pytest.raises(ConfigError, match="soft, hard, bayes"):
        Wavelet("firm")
    for name in ("nothing", "mexh"):
        with pytest.raises(ConfigError, match="no discrete wavelet"):
            Wavelet(wavelet=name)(noisy(), RATE)
