"""Overlapping Allan deviation, and what it tells of a gyro or an accelerometer at rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_FLICKER = float(np.sqrt(2.0 * np.log(2.0) / np.pi))
"""Floor of the Allan deviation of flicker noise over its bias instability: 0.664."""


class AllanReading(NamedTuple):
    """What an Allan deviation says of a sensor.

    Parameters
    ----------
    noise : float
        Noise density: the rate's unit per root hertz, equally its integral's per root second.
    instability : float
        Bias instability, unit of the rate.
    tau : float
        Averaging time of the lowest deviation [s]; where it is the longest one evaluated, the
        record is too short for the instability, which is then an upper bound.
    """

    noise: float
    instability: float
    tau: float


def allan_deviation(rate: ArrayLike, dt: float, tau: ArrayLike | None = None) -> tuple[Array, Array]:
    """Overlapping Allan deviation of a series of rates.

    Parameters
    ----------
    rate : array_like, shape (n,) or (n, axes)
        Mean rate in each sample interval, any unit; at rest.
    dt : float
        Sample interval [s].
    tau : array_like, optional
        Averaging times [s], rounded to whole samples; if not given, ten a decade from `dt` to a
        tenth of the record, beyond which fewer than nine independent differences remain.

    Returns
    -------
    tau : ndarray, shape (m,)
        Averaging times [s].
    deviation : ndarray, shape (m,) or (m, axes)
        In the unit of the rate; IEEE Std 952-1997, annex C, on the integrated rate.

    Raises
    ------
    ValueError
        If the record is shorter than two of the averaging times.
    """
    rate = np.asarray(rate, float)
    n = len(rate)
    if tau is None:
        tau = dt * np.logspace(
            0.0, np.log10(max(n / 10.0, 1.0)), 1 + int(10.0 * np.log10(max(n / 10.0, 1.0)))
        )
    lengths = np.unique(np.maximum(np.rint(np.asarray(tau, float) / dt).astype(np.int64), 1))
    if not len(lengths) or 2 * lengths[-1] > n:
        raise ValueError(f"{n} samples of {dt:g} s are too few for this averaging time; record for longer")
    theta = np.concatenate([np.zeros((1, *rate.shape[1:])), np.cumsum(rate - rate.mean(axis=0), axis=0)]) * dt
    deviation = [
        np.sqrt(np.mean((theta[2 * m :] - 2.0 * theta[m:-m] + theta[: -2 * m]) ** 2, axis=0) / 2.0) / (m * dt)
        for m in lengths
    ]
    return lengths * dt, np.array(deviation)


def read_allan(tau: Array, deviation: Array) -> AllanReading:
    """Noise density and bias instability of one axis.

    Parameters
    ----------
    tau, deviation : ndarray, shape (m,)
        From `allan_deviation`, m >= 2.

    Returns
    -------
    AllanReading
        The instability is the first minimum (the one before the deviation rises by a tenth: that
        of a Gauss-Markov process falls again later) over 0.664; the noise density comes from the
        first stretch before it where the slope is -1/2 within 0.1, or from all of that if none is.
    """
    risen = deviation > 1.1 * np.minimum.accumulate(deviation)
    lowest = int(np.argmin(deviation[: int(np.argmax(risen))] if risen.any() else deviation))
    slope = np.gradient(np.log(deviation), np.log(tau))
    white = np.abs(slope[: lowest + 1] + 0.5) < 0.1
    first = int(np.argmax(white))
    ends = np.flatnonzero(~white[first:])
    chosen = (
        slice(first, first + int(ends[0]) if len(ends) else lowest + 1) if white.any() else slice(lowest + 1)
    )
    noise = float(np.exp(np.mean(np.log(deviation[chosen] * np.sqrt(tau[chosen])))))
    return AllanReading(noise, float(deviation[lowest]) / _FLICKER, float(tau[lowest]))
