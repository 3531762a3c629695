"""What stands for the true signal where none is known: a low-pass without delay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gapless.denoise.base import WholeRecord, at_least
from gapless.errors import ConfigError
from gapless.trip.recording import Array


@dataclass(frozen=True)
class LowPass(WholeRecord):
    """A Butterworth filter run forwards and back: the signal s of `snr` on the road.

    It is a product of the spectrum and 1 / (1 + (f / cutoff)^(2 order)); the ends are mirrored about
    their first and last samples.

    Parameters
    ----------
    cutoff : float
        Where half of the amplitude is left [Hz]. 5 Hz is above what a driver does with a car and below
        what road and engine do to its sensors.
    order : int
        Of the filter that runs twice.

    Raises
    ------
    ConfigError
        If a parameter is out of range.
    """

    cutoff: float = 5.0
    order: int = 4

    def __post_init__(self) -> None:
        at_least(1e-6, cutoff=self.cutoff)
        at_least(1, order=self.order)

    def __call__(self, x: Array, rate: float) -> Array:
        """Filter one channel; see `WholeRecord`.

        Parameters
        ----------
        x : ndarray, shape (n,)
        rate : float
            Samples per second [Hz].

        Returns
        -------
        ndarray, shape (n,)

        Raises
        ------
        ConfigError
            If the samples hold nothing above the cutoff.
        """
        if self.cutoff >= rate / 2.0:
            raise ConfigError(
                f"a low-pass of {self.cutoff:g} Hz takes nothing from {rate:g} samples a second; "
                f"give a cutoff below {rate / 2.0:g} Hz"
            )
        return super().__call__(x, rate)

    def _denoised(self, record: Array, rate: float) -> Array:
        n = len(record)
        # without the line through its ends and continued oddly, it has a period without steps
        line = np.linspace(record[0], record[-1], n)
        bent = record - line
        frequency = np.fft.rfftfreq(2 * n - 2, 1.0 / rate)
        response = 1.0 / (1.0 + (frequency / self.cutoff) ** (2 * self.order))
        period = np.fft.irfft(np.fft.rfft(np.concatenate([bent, -bent[-2:0:-1]])) * response, 2 * n - 2)
        return np.asarray(line + period[:n])

    @property
    def name(self) -> str:
        """With the cutoff."""
        return f"two-sided low-pass of {self.cutoff:g} Hz"
