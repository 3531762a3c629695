"""What a denoiser is, how well one does, and what a sound record is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from gapless.errors import ConfigError, RecordingError
from gapless.trip.recording import Array

SHORTEST = 32
"""A record of fewer samples has no modes to speak of: it is left as it is."""


class Denoiser(Protocol):
    """A signal without its noise: a value (frozen dataclass) that holds its parameters and is called.

    It is called with the record of one channel, shape (n,), finite, and its samples per second [Hz];
    it returns a new array of the same shape, finite, the same bits for the same record. A record
    shorter than `SHORTEST` comes back as it is.
    """

    def __call__(self, x: Array, rate: float) -> Array:
        """Denoise one channel."""
        ...

    @property
    def name(self) -> str:
        """Of the method: "emd"."""
        ...

    @property
    def text(self) -> str:
        """What ran, as a result states it: "emd, whole record: not a real-time result"."""
        ...


class WholeRecord(ABC):
    """A denoiser that is given a whole record, and so sees the future."""

    @property
    @abstractmethod
    def name(self) -> str:
        """Of the method, as in the registry."""

    @property
    def text(self) -> str:
        """What ran, as a result states it."""
        return f"{self.name}, whole record: not a real-time result"

    def __call__(self, x: Array, rate: float) -> Array:
        """Denoise one channel.

        Parameters
        ----------
        x : ndarray, shape (n,)
        rate : float
            Samples per second [Hz]; most methods do not use it.

        Returns
        -------
        ndarray, shape (n,)

        Raises
        ------
        ConfigError
            If what was chosen cannot denoise this record.
        MissingExtraError
            Where PyWavelets is needed and not installed.
        RecordingError
            If a value is not finite.
        """
        record = sound(x)
        return record if len(record) < SHORTEST else self._denoised(record, rate)

    @abstractmethod
    def _denoised(self, record: Array, rate: float) -> Array:
        """A sound record, long enough and free to be changed, without its noise."""


def at_least(least: float, **values: float) -> None:
    """Refuse parameters that are too small.

    Parameters
    ----------
    least : float
        Allowed itself.
    **values : float
        By their names.

    Raises
    ------
    ConfigError
        If one is less, or not a number.
    """
    for name, value in values.items():
        if not value >= least:
            raise ConfigError(f"denoising: {name} = {value:g}; give {least:g} or more")


def sound(x: Array) -> Array:
    """A copy of a record, in which every value is finite.

    Parameters
    ----------
    x : array_like, shape (n,)

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    RecordingError
        If it is not one channel, or a value is not finite.
    """
    record = np.array(x, dtype=np.float64)
    if record.ndim != 1:
        raise RecordingError(f"denoising takes one channel, not shape {record.shape}; give columns")
    bad = np.flatnonzero(~np.isfinite(record))
    if bad.size:
        raise RecordingError(f"denoising: sample {bad[0]} is {record[bad[0]]}; fill or cut the record there")
    return record


def snr(signal: Array, estimate: Array) -> float:
    """Signal-to-noise ratio, 10 lg(sum s^2 / sum (x - s)^2) (papers page, section 2).

    Parameters
    ----------
    signal : ndarray, shape (n,)
        s: the truth in simulation, `LowPass` of the raw signal on the road.
    estimate : ndarray, shape (n,)
        x, raw or denoised.

    Returns
    -------
    float
        [dB]; infinite for an estimate without error.
    """
    error = float(np.sum(np.square(np.asarray(estimate) - signal)))
    power = float(np.sum(np.square(signal)))
    with np.errstate(divide="ignore"):
        return float(10.0 * (np.log10(power) - np.log10(error)))
