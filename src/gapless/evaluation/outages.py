"""What each outage cost: errors from its first withheld epoch to its last, and what to think of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gapless.evaluation.ages import QUANTITIES, ages
from gapless.evaluation.errors import Errors
from gapless.evaluation.statistics import rms
from gapless.scenarios import Outage, withheld
from gapless.trip.events import GAP
from gapless.trip.recording import Array, Imu

BEFORE_MOTION: Final = "before motion + 30 s"
NO_MOTION: Final = "no motion"
LITTLE_TRUTH: Final = "too little truth"
IMU_GAP: Final = "imu gap"
BEFORE_DECISIONS: Final = "before decisions"
LABELS: Final = (BEFORE_MOTION, NO_MOTION, LITTLE_TRUTH, IMU_GAP, BEFORE_DECISIONS)
"""Everything that sets an outage apart."""

SETTLING: Final = 30.0
"""An outage that begins less than this [s] after the first motion tests the alignment instead."""
_STANDING: Final = 1.0
"""Top speed [m/s] of an outage without motion."""


@dataclass(frozen=True)
class OutageScore:
    """Errors in one outage; NaN where the truth does not tell.

    Of each quantity there is the largest, the root mean square and the one at the last epoch: the
    horizontal position error, the height error (the height offset of the truth taken off), the
    error along the truth's course and across it [m], of the horizontal velocity [m/s], of the
    heading [rad].

    Parameters
    ----------
    start, end : float
        [s] after the first IMU sample.
    labels : tuple of str
        Why the outage is reported apart, of `LABELS`; empty where it counts.
    truth_epochs : int
        Epochs at which an error is known.
    distance : float
        Travelled in the outage [m].
    horizontal_max, horizontal_rmse, horizontal_end : float
    vertical_max, vertical_rmse, vertical_end : float
    along_max, along_rmse, along_end : float
    cross_max, cross_rmse, cross_end : float
    velocity_max, velocity_rmse, velocity_end : float
    heading_max, heading_rmse, heading_end : float
    percent : float
        `horizontal_max` in percent of `distance`; NaN without motion.
    coverage_50, coverage_95, coverage_99 : float
        Share of epochs whose stated ellipse of that probability holds the truth.
    nees : float
        Mean horizontal NEES, two degrees of freedom.
    inside_95_end : float
        1 where the 95 % ellipse of the last epoch holds the truth, 0 where it does not.
    """

    start: float
    end: float
    labels: tuple[str, ...]
    truth_epochs: int
    distance: float
    horizontal_max: float
    horizontal_rmse: float
    horizontal_end: float
    vertical_max: float
    vertical_rmse: float
    vertical_end: float
    along_max: float
    along_rmse: float
    along_end: float
    cross_max: float
    cross_rmse: float
    cross_end: float
    velocity_max: float
    velocity_rmse: float
    velocity_end: float
    heading_max: float
    heading_rmse: float
    heading_end: float
    percent: float
    coverage_50: float
    coverage_95: float
    coverage_99: float
    nees: float
    inside_95_end: float

    @property
    def counts(self) -> bool:
        """Whether nothing sets the outage apart from the pool."""
        return not self.labels


def score_outage(
    errors: Errors, outage: Outage, start: float, height_offset: float = 0.0, labels: tuple[str, ...] = ()
) -> OutageScore:
    """Score one outage.

    Parameters
    ----------
    errors : Errors
        Over the whole recording.
    outage : Outage
    start : float
        IMU time [s] that outage times count from: the first IMU sample plus the position clock
        offset, because outages are cut by logged GNSS stamps.
    height_offset : float
        Solution above truth outside the outages [m]; taken off.
    labels : tuple of str
        From what the truth cannot tell; those that it can are added.

    Returns
    -------
    OutageScore
    """
    begin, end = start + outage.start, start + outage.end
    part = errors.slice(begin, end)
    moved = np.interp([begin, end], errors.time, errors.distance) if len(errors) else np.zeros(2)
    distance = float(moved[1] - moved[0])
    standing = not (part.speed > _STANDING).any()
    known = part.take(np.isfinite(part.horizontal))
    labels += (NO_MOTION,) * (standing and len(part) > 0)
    labels += (LITTLE_TRUTH,) * _too_little(known.time, begin, end)
    aged = ages(errors, outage, start, height_offset)
    sizes = {
        f"{name}_{what}": of(getattr(aged, name))
        for name in QUANTITIES
        for what, of in (("max", _largest), ("rmse", rms), ("end", _last))
    }
    return OutageScore(
        start=outage.start,
        end=outage.end,
        labels=labels,
        truth_epochs=len(known),
        distance=distance,
        **sizes,
        percent=math.nan if standing or distance <= 0.0 else 100.0 * sizes["horizontal_max"] / distance,
        coverage_50=known.coverage(0.50),
        coverage_95=known.coverage(0.95),
        coverage_99=known.coverage(0.99),
        nees=_mean(known.nees),
        inside_95_end=known.take(slice(-1, None)).coverage(0.95),
    )


def score_outages(
    errors: Errors,
    outages: Sequence[Outage],
    start: float,
    imu: Imu,
    first_motion: float,
    clock_offset: float = 0.0,
    decided: float = 0.0,
) -> tuple[OutageScore, ...]:
    """Score every outage, those that are set apart too.

    Parameters
    ----------
    errors : Errors
    outages : sequence of Outage
    start : float
        Time of the first IMU sample [s].
    imu : Imu
        Where gaps that navigation does not bridge are looked for.
    first_motion : float
        Logged GNSS time at which driving began [s].
    clock_offset : float
        What has to be added to logged GNSS stamps to land on the IMU clock [s].
    decided : float
        When what was decided from the data had been logged [s after the first IMU sample].

    Returns
    -------
    tuple of OutageScore
    """
    offset = height_offset(errors, outages, start + clock_offset)
    rise = 0.0 if math.isnan(offset) else offset
    return tuple(
        score_outage(
            errors, o, start + clock_offset, rise, outside_labels(o, start, imu, first_motion, decided)
        )
        for o in outages
    )


def outside_labels(
    outage: Outage, start: float, imu: Imu, first_motion: float, decided: float = 0.0
) -> tuple[str, ...]:
    """Labels that can be told without a truth.

    Parameters
    ----------
    outage : Outage
    start : float
        Time of the first IMU sample [s].
    imu : Imu
    first_motion : float
        Logged GNSS time at which driving began [s].
    decided : float
        When what was decided from the data had been logged [s after the first IMU sample].

    Returns
    -------
    tuple of str
    """
    labels: tuple[str, ...] = ()
    if start + outage.start < first_motion + SETTLING:
        labels += (BEFORE_MOTION,)
    if outage.start < decided - 1e-3:  # s: rounded
        labels += (BEFORE_DECISIONS,)
    if _has_gap(imu, start + outage.start, start + outage.end):
        labels += (IMU_GAP,)
    return labels


def height_offset(errors: Errors, outages: Sequence[Outage], start: float) -> float:
    """How far the solution lies above the truth outside outages: the geoid, as a rule.

    Parameters
    ----------
    errors : Errors
    outages : sequence of Outage
    start : float
        IMU time that outage times count from [s].

    Returns
    -------
    float
        Median [m]; NaN if no error is known outside.
    """
    up = -errors.take(~withheld(errors.time, outages, start)).position[:, 2]
    up = up[np.isfinite(up)]
    return float(np.median(up)) if len(up) else math.nan


def _largest(values: Array) -> float:
    x = np.abs(values[np.isfinite(values)])
    return float(x.max()) if len(x) else math.nan


def _last(values: Array) -> float:
    return abs(float(values[-1])) if len(values) else math.nan


def _mean(values: Array) -> float:
    x = values[np.isfinite(values)]
    return float(x.mean()) if len(x) else math.nan


def _too_little(time: Array, begin: float, end: float) -> bool:
    """Whether truth is known in under half of the seconds, or not at all in the last quarter."""
    if not len(time):
        return True
    seconds = len(np.unique(np.floor(time - begin)))
    return bool(seconds < 0.5 * math.ceil(end - begin) or time[-1] < end - 0.25 * (end - begin))


def _has_gap(imu: Imu, begin: float, end: float) -> bool:
    if len(imu) < 2:
        return True
    step = np.diff(imu.time)
    gap = step > max(GAP, 5.0 * float(np.median(step)))
    return bool((gap & (imu.time[1:] > begin) & (imu.time[:-1] < end)).any())
