"""The six channels of an IMU denoised."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from gapless.denoise.base import Denoiser
from gapless.trip.recording import Array, Imu

HOLE: Final = 0.5
"""A longer silence [s] parts one stretch of a log from the next: each is denoised as a record of its own."""


def stretches(time: Array) -> list[slice]:
    """Rows of a log between silences.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]

    Returns
    -------
    list of slice
        Together all rows.
    """
    cuts = np.flatnonzero(np.diff(time) > HOLE) + 1
    edges = [0, *(int(c) for c in cuts), len(time)]
    return [slice(a, b) for a, b in pairwise(edges) if b > a]


def denoised(imu: Imu, denoiser: Denoiser) -> Imu:
    """An IMU's increments after its angular rates and specific forces were denoised, channel by channel.

    Stretches between silences are denoised apart. Channels run in threads; results do not depend on how
    many. What ran is `denoiser.text`. A causal denoiser keeps it causal as long as the rate is the same
    for a log and for its beginning (the median interval); the denoisers here do not use it.

    Parameters
    ----------
    imu : Imu
    denoiser : Denoiser

    Returns
    -------
    Imu
        Of the same times and intervals.

    Raises
    ------
    RecordingError
        If a rate or force is not finite.
    """
    if not len(imu):
        return imu
    rate, rows = imu.rate, stretches(imu.time)
    channels = np.vstack([imu.dtheta.T, imu.dvel.T]) / imu.dt
    out = np.empty_like(channels)

    def run(task: tuple[int, slice]) -> None:
        out[task] = denoiser(channels[task], rate)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for _ in pool.map(run, [(channel, stretch) for channel in range(6) for stretch in rows]):
            pass
    increments = (out * imu.dt).T
    return replace(
        imu, dtheta=np.ascontiguousarray(increments[:, :3]), dvel=np.ascontiguousarray(increments[:, 3:])
    )
