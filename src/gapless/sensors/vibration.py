"""How much a log's gyros shake: the density of what changes from sample to sample."""

from __future__ import annotations

import numpy as np

from gapless.trip.recording import Imu

FASTEST_MOTION = 40.0
"""Below this sample rate [Hz] the vehicle's own motion changes from sample to sample."""


def gyro_density(imu: Imu) -> float:
    """White density that would explain the differences between neighbouring samples.

    Engine and road shake the box far above the motion that matters, and what a gyro makes of
    shaking (aliasing, sensitivity to acceleration) grows with it.

    Parameters
    ----------
    imu : Imu

    Returns
    -------
    float
        RMS over the axes [rad/sqrt(s)]; 0 for a log too slow to tell shaking from driving.
    """
    if len(imu) < 100 or imu.rate < FASTEST_MOTION:
        return 0.0
    step = np.diff(imu.dtheta / imu.dt[:, None], axis=0)
    step = step[imu.time[1:] - imu.time[:-1] < 1.5 * np.median(imu.dt)]
    return float(np.sqrt(0.5 * np.mean(step**2) * np.median(imu.dt)))
