"""Denoising of inertial signals: of a whole record, or window by window from the past alone.

`DENOISERS` names them; a new one is a file and a line here. PyWavelets is imported when it is needed.
"""

from __future__ import annotations

from typing import Final

from gapless.denoise.base import Denoiser, snr
from gapless.denoise.emd import Emd
from gapless.denoise.imu import denoised
from gapless.denoise.interval import EmdCiit, EmdIit, EmdIt
from gapless.denoise.low_pass import LowPass
from gapless.denoise.wavelet import Wavelet
from gapless.denoise.windowed import Windowed

DENOISERS: Final[dict[str, type[Denoiser]]] = {
    "wavelet": Wavelet,
    "emd": Emd,
    "emd-it": EmdIt,
    "emd-iit": EmdIit,
    "emd-ciit": EmdCiit,
}
"""Denoisers of whole records by their names in recipes; each can be called without parameters."""

__all__ = [
    "DENOISERS",
    "Denoiser",
    "Emd",
    "EmdCiit",
    "EmdIit",
    "EmdIt",
    "LowPass",
    "Wavelet",
    "Windowed",
    "denoised",
    "snr",
]
