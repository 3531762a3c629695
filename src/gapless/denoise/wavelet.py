"""Wavelet thresholding: the denoiser that the EMD family is compared with, and a part of EMD-CIIT."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Final

import numpy as np

from gapless.denoise.base import WholeRecord
from gapless.errors import ConfigError, MissingExtraError
from gapless.trip.recording import Array

THRESHOLDINGS: Final = ("soft", "hard", "bayes")
MEDIAN: Final = 0.6745
"""Median absolute value of a Gaussian variable, in its standard deviations."""


def pywavelets() -> ModuleType:
    """PyWavelets, where it is installed.

    Returns
    -------
    module

    Raises
    ------
    MissingExtraError
        Where it is not.
    """
    try:
        import pywt
    except ImportError as error:
        raise MissingExtraError("PyWavelets", "learn") from error
    return pywt  # type: ignore[no-any-return]


@dataclass(frozen=True)
class Wavelet(WholeRecord):
    """Thresholding of the details of an orthogonal wavelet transform; the approximation is kept.

    The noise's sigma is median|d| / 0.6745 of the finest details d. "soft" and "hard" take the
    universal threshold sigma sqrt(2 ln n) (Donoho and Johnstone 1994); "bayes" shrinks softly, each
    level by sigma^2 / sqrt(max(mean d^2 - sigma^2, 0)) (BayesShrink: Chang, Yu and Vetterli 2000).

    Parameters
    ----------
    thresholding : str
        "soft", "hard" or "bayes".
    wavelet : str
        Name of an orthogonal wavelet of PyWavelets; liu2019 names none.

    Raises
    ------
    ConfigError
        If the thresholding is none of these.
    """

    thresholding: str = "bayes"
    wavelet: str = "sym8"

    def __post_init__(self) -> None:
        if self.thresholding not in THRESHOLDINGS:
            choices = ", ".join(THRESHOLDINGS)
            raise ConfigError(f"no wavelet thresholding {self.thresholding!r}; the choices are {choices}")

    def _denoised(self, record: Array, rate: float) -> Array:
        pywt = pywavelets()
        if self.wavelet not in pywt.wavelist(kind="discrete"):
            raise ConfigError(f"no discrete wavelet {self.wavelet!r} in PyWavelets; try sym8 or db4")
        coarse, *details = pywt.wavedec(record, self.wavelet, mode="symmetric")
        sigma = float(np.median(np.abs(details[-1]))) / MEDIAN if details else 0.0
        shrunk = [self._shrink(pywt, d, sigma, len(record)) for d in details]
        return np.asarray(pywt.waverec([coarse, *shrunk], self.wavelet, mode="symmetric")[: len(record)])

    def _shrink(self, pywt: ModuleType, detail: Array, sigma: float, n: int) -> Array:
        if sigma == 0.0:
            return detail
        if self.thresholding != "bayes":
            limit = sigma * np.sqrt(2.0 * np.log(n))
            return np.asarray(pywt.threshold(detail, limit, self.thresholding))
        power = float(np.mean(np.square(detail))) - sigma**2
        if power <= 0.0:
            return np.zeros_like(detail)
        return np.asarray(pywt.threshold(detail, sigma**2 / np.sqrt(power), "soft"))

    @property
    def name(self) -> str:
        """As in the registry, with the thresholding."""
        return f"wavelet ({self.thresholding})"
