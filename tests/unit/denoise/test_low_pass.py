"""The two-sided low-pass against SciPy's, and the signal-to-noise ratio by hand."""

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from gapless.denoise import LowPass, snr
from gapless.errors import ConfigError


@pytest.mark.parametrize("cutoff", [1.0, 5.0])
def test_it_is_a_butterworth_filter_run_both_ways(cutoff):
    """Away from the ends, which SciPy pads otherwise. SciPy's is bilinear, so its frequencies are bent by
    (pi f / rate)^2 / 3, 0.8 % at 5 Hz: of white noise of size one it may differ by 1 %."""
    x = np.random.default_rng(0).normal(size=8000)
    ours = LowPass(cutoff)(x, 100.0)
    theirs = sosfiltfilt(butter(4, cutoff, fs=100.0, output="sos"), x)
    assert np.abs(ours - theirs)[1000:-1000].max() < 0.01


def test_there_is_no_delay_and_half_is_left_at_the_cutoff():
    t = np.arange(4001) / 100.0
    tone = np.sin(2.0 * np.pi * 5.0 * t)
    assert LowPass(5.0)(tone, 100.0) == pytest.approx(0.5 * tone, abs=1e-9)
    slow = np.sin(2.0 * np.pi * 0.5 * t)
    assert LowPass(5.0)(slow, 100.0) == pytest.approx(slow, abs=1e-6)


def test_a_cutoff_that_takes_nothing_is_refused():
    with pytest.raises(ConfigError, match="below 5 Hz"):
        LowPass(5.0)(np.zeros(100), 10.0)
    with pytest.raises(ConfigError, match="cutoff"):
        LowPass(0.0)


def test_the_ratio_by_hand():
    """4 against an error of 0.04 in sum of squares: 20 dB."""
    signal = np.array([1.0, -1.0, 1.0, -1.0])
    assert snr(signal, signal + 0.1) == pytest.approx(20.0, abs=1e-12)
    assert snr(signal, signal) == np.inf
