"""Conventional denoising by empirical mode decomposition: the modes that noise explains are left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gapless.denoise.base import WholeRecord, at_least
from gapless.denoise.noise_model import energy_bound, noise_level
from gapless.denoise.sifting import SIFTINGS, modes
from gapless.trip.recording import Array


@dataclass(frozen=True)
class Emd(WholeRecord):
    """Partial reconstruction: what is left without the fast modes whose energy is that of white noise.

    Modes go until one exceeds the 99 % bound of noise (Flandrin, Rilling and Goncalves 2004; EMD-Conv of
    Kopsinis and McLaughlin 2009). The first always goes, since it tells how much noise there is.

    Parameters
    ----------
    siftings : int
        Of each mode.

    Raises
    ------
    ConfigError
        If it is less than 1.
    """

    siftings: int = SIFTINGS

    def __post_init__(self) -> None:
        at_least(1, siftings=self.siftings)

    def _denoised(self, record: Array, rate: float) -> Array:
        kept, sigma = record, 0.0
        for i, mode in enumerate(modes(kept, self.siftings), 1):
            if i == 1:
                sigma = noise_level(mode)
            elif float(np.mean(np.square(mode))) > energy_bound(sigma, i):
                break
            kept -= mode
        return kept

    @property
    def name(self) -> str:
        """As in the registry."""
        return "emd"
