"""Denoisers side by side: the signal-to-noise ratios of liu2019, Table 2."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np

from gapless.denoise import DENOISERS
from gapless.denoise.base import Denoiser, snr
from gapless.denoise.imu import denoised
from gapless.denoise.windowed import Windowed
from gapless.trip.recording import Array, Imu

CHANNELS: Final = ("f_x", "f_y", "f_z", "w_x", "w_y", "w_z")
"""Specific forces and angular rates, in the order of Table 2."""


class Row(NamedTuple):
    """One line of the table.

    Parameters
    ----------
    name : str
        "raw", or what the denoiser goes by.
    text : str
        What ran, and whether it saw the future.
    snr : tuple of 6 floats
        Of `CHANNELS` [dB].
    """

    name: str
    text: str
    snr: tuple[float, ...]

    def gain(self, raw: Row) -> float:
        """Mean over the channels of what denoising added.

        Parameters
        ----------
        raw : Row

        Returns
        -------
        float
            [dB]
        """
        return float(np.mean(np.subtract(self.snr, raw.snr)))


def compare(signal: Imu, measured: Imu, denoisers: Mapping[str, Denoiser]) -> list[Row]:
    """Signal-to-noise ratios, raw and after each denoiser.

    Parameters
    ----------
    signal : Imu
        The truth: error-free in simulation, `denoised(measured, LowPass())` on the road.
    measured : Imu
        Of the same samples.
    denoisers : mapping of str to Denoiser
        By the names of their rows.

    Returns
    -------
    list of Row
        The first is "raw".
    """
    rows = [Row("raw", "raw", _ratios(signal, measured))]
    for name, denoiser in denoisers.items():
        rows.append(Row(name, denoiser.text, _ratios(signal, denoised(measured, denoiser))))
    return rows


def whole_and_causal(length: int = 512, step: int = 128) -> dict[str, Denoiser]:
    """Every registered denoiser as it stands, and made causal.

    Parameters
    ----------
    length, step : int
        Of the windows [samples].

    Returns
    -------
    dict of str to Denoiser
        By the name in the registry, with ", causal" where it is.
    """
    each: dict[str, Denoiser] = {}
    for name, kind in DENOISERS.items():
        each[name] = kind()
        each[f"{name}, causal"] = Windowed(kind(), length, step)
    return each


def _ratios(signal: Imu, estimate: Imu) -> tuple[float, ...]:
    return tuple(snr(s, x) for s, x in zip(_channels(signal), _channels(estimate), strict=True))


def _channels(imu: Imu) -> Array:
    return np.vstack([imu.dvel.T, imu.dtheta.T]) / imu.dt
