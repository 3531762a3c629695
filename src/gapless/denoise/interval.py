"""Interval thresholding of empirical modes: EMD-IT, EMD-IIT and EMD-CIIT.

Kopsinis and McLaughlin 2009 (IEEE Trans. Signal Processing 57, 1351), as liu2019 uses them; constants
from the papers page, section 2. All modes are thresholded, softly; the residue is kept. The noise's
level is that of the original record's first mode throughout.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gapless.denoise.base import WholeRecord, at_least
from gapless.denoise.noise_model import noise_level, shrink_intervals, threshold
from gapless.denoise.sifting import SIFTINGS, modes
from gapless.denoise.wavelet import Wavelet
from gapless.errors import ConfigError
from gapless.trip.recording import Array

FACTOR: Final = 0.7
"""C of the thresholds; liu2019 gives none."""
ITERATIONS: Final = 5
"""Noisy versions of a record that are averaged (liu2019, section 5.2)."""
ALTERATIONS: Final = ("circulation", "permutation")


@dataclass(frozen=True)
class EmdIt(WholeRecord):
    """EMD interval thresholding (EMD-IT).

    Parameters
    ----------
    factor : float
        C of the thresholds.
    siftings : int
        Of each mode.

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    """

    factor: float = FACTOR
    siftings: int = SIFTINGS

    def __post_init__(self) -> None:
        at_least(0, factor=self.factor)
        at_least(1, siftings=self.siftings)

    def _denoised(self, record: Array, rate: float) -> Array:
        return _thresholded(record, None, self.factor, self.siftings)

    @property
    def name(self) -> str:
        """As in the registry."""
        return "emd-it"


@dataclass(frozen=True)
class EmdIit(WholeRecord):
    """Iterative EMD interval thresholding (EMD-IIT): the mean over noisy versions of a record.

    Each has its first mode moved about, as if the noise had fallen otherwise.

    Parameters
    ----------
    factor : float
        C of the thresholds.
    iterations : int
        Versions that are averaged.
    alteration : str
        "circulation" (by a random number of samples; it keeps the noise's spectrum) or "permutation".
    siftings : int
        Of each mode.
    seed : int
        Of the random alterations; the same bits for the same seed.

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    """

    factor: float = FACTOR
    iterations: int = ITERATIONS
    alteration: str = ALTERATIONS[0]
    siftings: int = SIFTINGS
    seed: int = 0

    def __post_init__(self) -> None:
        at_least(0, factor=self.factor, seed=self.seed)
        at_least(1, iterations=self.iterations, siftings=self.siftings)
        if self.alteration not in ALTERATIONS:
            choices = " or ".join(ALTERATIONS)
            raise ConfigError(
                f"no alteration {self.alteration!r} of the first mode; the choices are {choices}"
            )

    def _denoised(self, record: Array, rate: float) -> Array:
        first = next(modes(record, self.siftings), None)
        if first is None:
            return record
        noise, total = self.noise(first, rate), np.zeros_like(record)
        rest, level, rng = record - noise, noise_level(first), np.random.default_rng(self.seed)
        for _ in range(self.iterations):
            total += _thresholded(rest + self._altered(noise, rng), level, self.factor, self.siftings)
        return total / self.iterations

    def noise(self, first: Array, rate: float) -> Array:
        """What of the first mode is taken for noise, and moved about: here, all of it.

        Parameters
        ----------
        first : ndarray, shape (n,)
        rate : float

        Returns
        -------
        ndarray, shape (n,)
        """
        return first

    def _altered(self, noise: Array, rng: np.random.Generator) -> Array:
        if self.alteration == "circulation":
            return np.roll(noise, int(rng.integers(len(noise))))
        return np.asarray(rng.permutation(noise))

    @property
    def name(self) -> str:
        """As in the registry."""
        return "emd-iit"


@dataclass(frozen=True)
class EmdCiit(EmdIit):
    """Clear iterative EMD interval thresholding (EMD-CIIT), liu2019 section 3.

    Like `EmdIit`, but what Bayesian wavelet shrinkage finds in the first mode counts as signal, eq. 9.
    """

    def noise(self, first: Array, rate: float) -> Array:
        """What of the first mode is taken for noise: what Bayesian wavelet shrinkage takes away.

        Parameters
        ----------
        first : ndarray, shape (n,)
        rate : float

        Returns
        -------
        ndarray, shape (n,)
        """
        return first - Wavelet("bayes")(first, rate)

    @property
    def name(self) -> str:
        """As in the registry."""
        return "emd-ciit"


def _thresholded(x: Array, level: float | None, factor: float, siftings: int) -> Array:
    """EMD-IT of a record; the noise's level is that of its own first mode if none is given."""
    kept = x.copy()
    for i, mode in enumerate(modes(x, siftings), 1):
        level = noise_level(mode) if level is None else level
        kept -= mode
        shrink_intervals(mode, threshold(level, i, len(x), factor), kept)
    return kept
