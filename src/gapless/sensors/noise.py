"""Random sequences that sensor errors are made of, each exact at its samples."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from gapless._numba import kernel

Array = NDArray[np.float64]


@kernel
def _recur(decay: Array, driven: Array) -> None:
    """x[k] = decay[k] x[k - 1] + driven[k], in place."""
    for k in range(1, len(driven)):
        for j in range(driven.shape[1]):
            driven[k, j] += decay[k] * driven[k - 1, j]


def gauss_markov(dt: Array, sd: float, tau: float, rng: Generator, axes: int = 3) -> Array:
    """Stationary first-order Gauss-Markov process.

    Parameters
    ----------
    dt : ndarray, shape (n,)
        Time from the sample before to each sample [s]; the first is not used.
    sd : float
        Standard deviation of the process.
    tau : float
        Correlation time [s]: the autocorrelation is sd^2 exp(-|lag| / tau).
    rng : numpy.random.Generator
    axes : int
        Independent columns.

    Returns
    -------
    ndarray, shape (n, axes)
        x_k = phi x_{k-1} + sd sqrt(1 - phi^2) w, phi = exp(-dt / tau): exact for any dt
        (Gelb 1974, sec. 3.6 and 3.8).
    """
    scale = sd * np.sqrt(-np.expm1(-2.0 * np.asarray(dt, float) / tau))
    scale[:1] = sd
    process = scale[:, None] * rng.standard_normal((len(dt), axes))
    _recur(np.exp(-dt / tau), process)
    return process


def random_walk(dt: Array, density: float, rng: Generator, axes: int = 3) -> Array:
    """Wiener process that starts at zero.

    Parameters
    ----------
    dt : ndarray, shape (n,)
        Time from the sample before to each sample [s].
    density : float
        Its standard deviation after one second.
    rng : numpy.random.Generator
    axes : int
        Independent columns.

    Returns
    -------
    ndarray, shape (n, axes)
    """
    return np.cumsum(density * np.sqrt(dt)[:, None] * rng.standard_normal((len(dt), axes)), axis=0)


def band_limited(n: int, dt: float, band: tuple[float, float], rng: Generator, axes: int = 3) -> Array:
    """Gaussian noise of unit variance with power in one band only, so that its integral stays bounded.

    Parameters
    ----------
    n : int
        Number of samples.
    dt : float
        Their spacing [s].
    band : tuple of 2 floats
        Lower and upper edge [Hz]; what lies above half the sample rate is left out.
    rng : numpy.random.Generator
    axes : int
        Independent columns.

    Returns
    -------
    ndarray, shape (n, axes)
        Zero where the band holds no frequency of the record.
    """
    spectrum = np.fft.rfft(rng.standard_normal((n, axes)), axis=0)
    frequency = np.fft.rfftfreq(n, dt)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    spectrum[~inside] = 0.0
    share = 2.0 * np.count_nonzero(inside) / n
    return np.asarray(np.fft.irfft(spectrum, n, axis=0) / np.sqrt(max(share, 1.0 / n)))
