"""How errors grow with the age of an outage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gapless.evaluation.errors import Errors
from gapless.scenarios import Outage
from gapless.trip.recording import Array, Columns


@dataclass(frozen=True, eq=False)
class Ages(Columns):
    """Sizes of the errors against the age of an outage.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Age: seconds since the outage began.
    horizontal, vertical, along, cross : ndarray, shape (n,)
        Position errors [m]; the height offset of the truth is taken off. All but the horizontal one
        are signed.
    velocity : ndarray, shape (n,)
        Of the horizontal velocity [m/s].
    heading : ndarray, shape (n,)
        [rad], signed.
    bound : ndarray, shape (n,)
        Semi-major axis of the stated 95 % ellipse [m].
    nees : ndarray, shape (n,)
        Squared Mahalanobis distance of the horizontal position: ellipses hold the truth where it is small.
    """

    horizontal: Array
    vertical: Array
    along: Array
    cross: Array
    velocity: Array
    heading: Array
    bound: Array
    nees: Array


QUANTITIES: Final = ("horizontal", "vertical", "along", "cross", "velocity", "heading")
"""Columns of `Ages` of which a score keeps the largest, the RMS and the last."""


def ages(errors: Errors, outage: Outage, start: float, height_offset: float = 0.0) -> Ages:
    """Errors at the truth's epochs in an outage, by age.

    Parameters
    ----------
    errors : Errors
        Over the whole recording.
    outage : Outage
    start : float
        IMU time [s] that outage times count from, as for `score_outage`.
    height_offset : float
        Solution above truth outside the outages [m]; taken off.

    Returns
    -------
    Ages
        Epochs with a known position error only.
    """
    part = errors.slice(start + outage.start, start + outage.end)
    part = part.take(np.isfinite(part.horizontal))
    return Ages(
        time=part.time - (start + outage.start),
        horizontal=part.horizontal,
        vertical=part.position[:, 2] + height_offset,
        along=part.along,
        cross=part.cross,
        velocity=np.hypot(part.velocity[:, 0], part.velocity[:, 1]),
        heading=part.attitude[:, 2],
        bound=part.bound(),
        nees=part.nees,
    )
