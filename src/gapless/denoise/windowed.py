"""Any denoiser made causal: the value at a sample knows of no later one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gapless._numba import inline, long_kernel
from gapless.denoise.base import Denoiser, sound
from gapless.denoise.wavelet import MEDIAN
from gapless.errors import ConfigError
from gapless.trip.recording import Array

SPANS: Final = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
"""Memories of the moving averages that a value is made of [samples]."""
REGIMES: Final = np.array([1.0, 2.0, 4.0])
"""Distances of a fast from a slow average, in sigmas of noise, that part the regimes of motion."""
MEMORY: Final = 10.0
"""What was learned fades by 1 / e over this many lengths of a window."""
MOST: Final = 3.0
"""A sample is moved by no more than this many sigmas: white noise goes no further."""
EDGE: Final = 16
"""Within this part of its length (1 / EDGE) a window's ends are not learned from: they are mirrored there."""


@dataclass(frozen=True)
class Windowed:
    """A strictly causal denoiser that imitates another one, which it watches at work on the past.

    Every `step` samples the inner denoiser is given the last `length` samples. At the very end of a
    window it is at its worst, and it would be too slow at every sample. So its result further inside is
    taken as the target of a regression on what a causal filter has: exponential moving averages of the
    raw signal. Least squares finds E[denoised | past], which is E[truth | past] if the inner one finds
    E[truth | whole record]: the causal Wiener filter of this very signal. There is one set of weights for
    each regime of motion (how far a fast average is from a slow one), sums are forgotten slowly, and
    no sample is moved further than noise would. Weights hold for the next `step` samples.

    The scheme is ours; liu2019 has only the whole record.

    Parameters
    ----------
    inner : Denoiser
    length : int
        Samples of a window, 64 or more; until there are so many, and at any time while no noise is seen,
        samples are left as they are.
    step : int
        Samples from one window to the next, at most half of `length`.

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    """

    inner: Denoiser
    length: int = 512
    step: int = 128

    def __post_init__(self) -> None:
        if self.length < 64 or not 1 <= self.step <= self.length // 2:
            raise ConfigError(
                f"denoising: windows of {self.length} samples every {self.step}; give a length of 64 or more "
                "and a step from 1 to half of it"
            )

    def __call__(self, x: Array, rate: float) -> Array:
        """Denoise one channel.

        Parameters
        ----------
        x : ndarray, shape (n,)
        rate : float
            Samples per second [Hz], for the inner denoiser.

        Returns
        -------
        ndarray, shape (n,)
            The first k values are those of the first k samples alone, bit for bit.

        Raises
        ------
        RecordingError
            If a value is not finite.
        """
        record = sound(x)
        out, lags = record.copy(), np.empty((len(record), len(SPANS)))
        average(record, SPANS, lags)
        a, b, edge = *_nothing(), self.length // EDGE
        kept = math.exp(-self.step / (MEMORY * self.length))
        for end in range(self.length, len(record) + 1, self.step):
            begin = end - self.length
            change = self.inner(record[begin:end], rate) - record[begin:end]
            noise = float(np.median(np.abs(change[edge:-edge]))) / MEDIAN
            # the sample at end - 1 is the first that the window's weights are used for
            until = min(end - 1 + self.step, len(record))
            fresh = self.length - 2 * edge if begin == 0 else self.step
            if noise > 0.0:
                last = self.length - edge
                learn(lags[begin:end], change, last - fresh, last, noise, kept, a, b)
                imitate(record, lags, _weights(a, b), noise, end - 1, until, out)
        return out

    @property
    def name(self) -> str:
        """That of the inner denoiser."""
        return self.inner.name

    @property
    def text(self) -> str:
        """What ran, as a result states it."""
        return f"{self.name}, causal window of {self.length} samples"


def _nothing() -> tuple[Array, Array]:
    """Normal equations of each regime that nothing was learned from."""
    regimes, k = len(REGIMES) + 1, len(SPANS)
    return np.zeros((regimes, k, k)), np.zeros((regimes, k))


def _weights(a: Array, b: Array) -> Array:
    """Weights of the averages in each regime; the unit ridge is one sample's noise in each, towards none."""
    return np.asarray(np.linalg.solve(a + np.eye(a.shape[-1]), b[..., None])[..., 0])


@long_kernel
def average(x: Array, spans: Array, lags: Array) -> None:
    """Exponential moving averages of a signal, less the signal.

    Parameters
    ----------
    x : ndarray, shape (n,)
    spans : ndarray, shape (k,)
        Memory of each [samples].
    lags : ndarray, shape (n, k)
        Written.
    """
    k = spans.shape[0]
    mean = np.zeros(k)
    for i in range(x.shape[0]):
        for j in range(k):
            mean[j] = x[0] if i == 0 else mean[j] + (x[i] - mean[j]) / spans[j]
            lags[i, j] = mean[j] - x[i]


@inline
def _regime(lag: Any, noise: float) -> int:
    """How far a fast average is from a slow one."""
    distance, which = abs(lag[1] - lag[lag.shape[0] - 2]), 0
    for bound in REGIMES:
        if distance > bound * noise:
            which += 1
    return which


@long_kernel
def learn(
    lags: Array, change: Array, begin: int, end: int, noise: float, kept: float, a: Array, b: Array
) -> None:
    """Add samples to the normal equations of their regimes, in units of the noise.

    Parameters
    ----------
    lags : ndarray, shape (n, k)
    change : ndarray, shape (n,)
        Denoised less raw.
    begin, end : int
        Samples that count.
    noise : float
        Standard deviation.
    kept : float
        Share of what `a` and `b` held that is not forgotten.
    a : ndarray, shape (r, k, k)
        Replaced in place.
    b : ndarray, shape (r, k)
    """
    k = lags.shape[1]
    for r in range(a.shape[0]):
        for p in range(k):
            b[r, p] *= kept
            for q in range(k):
                a[r, p, q] *= kept
    weight = 1.0 / noise**2
    for i in range(begin, end):
        r = _regime(lags[i], noise)
        for p in range(k):
            scaled = weight * lags[i, p]
            b[r, p] += scaled * change[i]
            for q in range(k):
                a[r, p, q] += scaled * lags[i, q]


@long_kernel
def imitate(x: Array, lags: Array, weights: Array, noise: float, begin: int, end: int, out: Array) -> None:
    """Denoise samples with the weights of their regimes.

    Parameters
    ----------
    x : ndarray, shape (n,)
    lags : ndarray, shape (n, k)
    weights : ndarray, shape (r, k)
    noise : float
    begin, end : int
        Samples to denoise.
    out : ndarray, shape (n,)
        Written there.
    """
    most = MOST * noise
    for i in range(begin, end):
        r, move = _regime(lags[i], noise), 0.0
        for p in range(lags.shape[1]):
            move += weights[r, p] * lags[i, p]
        out[i] = x[i] + max(-most, min(most, move))
