"""What white noise looks like after empirical mode decomposition, and the thresholds that follow.

Flandrin, Rilling and Goncalves 2004 (IEEE Signal Processing Letters 11, 112; EMD equivalent filter
banks, 2005): it is a filter bank, whose modes hold known energies.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless._numba import long_kernel
from gapless.denoise.wavelet import MEDIAN
from gapless.trip.recording import Array

BETA: Final = 0.719
RHO: Final = 2.01
_SURE: Final = (0.460, -1.919)
"""a and b of the 99 % bound, log2(log2(bound / energy)) = a i + b, for white noise (Flandrin et al. 2005)."""
VANISHING: Final = 1e-300
"""What is smaller has no reciprocal, and is nothing."""


def noise_level(first: Array) -> float:
    """Standard deviation of the noise in the first mode, sigma_1 = median|h_1| / 0.6745.

    Signal in the mode hardly moves it. It takes the mode's samples for Gaussian, as Kopsinis and
    McLaughlin do; after ten siftings they are not: of white noise its square is 1.46 times the mode's
    energy, so the thresholds are a fifth higher than E_1 = mean h_1^2 would make them.

    Parameters
    ----------
    first : ndarray, shape (n,)

    Returns
    -------
    float
    """
    return float(np.median(np.abs(first))) / MEDIAN


def noise_energy(sigma: float, i: int) -> float:
    """Energy of a mode of white noise, per sample.

    Parameters
    ----------
    sigma : float
        That of the first mode.
    i : int
        1 for the first mode.

    Returns
    -------
    float
        E_1 = sigma^2, E_i = (sigma^2 / 0.719) 2.01^-i (papers page, section 2).
    """
    return sigma**2 if i == 1 else sigma**2 / BETA * RHO ** float(-i)


def energy_bound(sigma: float, i: int) -> float:
    """Energy that a mode of white noise exceeds in one record out of a hundred.

    Parameters
    ----------
    sigma : float
        Standard deviation of the first mode.
    i : int
        2 or more.

    Returns
    -------
    float
    """
    a, b = _SURE
    exponent = min(2.0 ** (a * i + b), 1000.0)  # what a float holds; 25 modes are 30 million samples
    return float(noise_energy(sigma, i) * 2.0**exponent)


def threshold(sigma: float, i: int, n: int, factor: float) -> float:
    """T_i = C sqrt(2 E_i ln N).

    Parameters
    ----------
    sigma : float
        Standard deviation of the first mode.
    i : int
        Number of the mode, from 1.
    n : int
        N, samples of the record.
    factor : float
        C.

    Returns
    -------
    float
    """
    return factor * float(np.sqrt(2.0 * noise_energy(sigma, i) * np.log(n)))


@long_kernel
def shrink_intervals(mode: Array, limit: float, out: Array) -> None:
    """Soft interval thresholding of a mode, liu2019 eq. 13, added to a sum.

    Between two zero crossings all samples are scaled as their extremum r is: by (|r| - T) / |r|, or to
    nothing where |r| <= T (Kopsinis and McLaughlin 2009).

    Parameters
    ----------
    mode : ndarray, shape (n,)
    limit : float
        T.
    out : ndarray, shape (n,)
        What is left of the mode is added to it.
    """
    n, begin, most = mode.shape[0], 0, 0.0
    for i in range(n + 1):
        if i == n or (i > begin and (mode[i] > 0.0) != (mode[begin] > 0.0)):
            if most > max(limit, VANISHING):
                scale = (most - limit) / most
                for k in range(begin, i):
                    out[k] += scale * mode[k]
            begin, most = i, 0.0
        if i < n:
            most = max(most, abs(mode[i]))
