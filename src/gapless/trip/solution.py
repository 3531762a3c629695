"""What a navigator found: the trajectory, the states beside it, and the evidence for both."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless.trip.exhibits import Exhibit
from gapless.trip.recording import Array, Columns, Note, Trajectory


@dataclass(frozen=True)
class Decision:
    """One thing that fusion settled before or while it ran.

    Parameters
    ----------
    name : str
        For instance "clock offset, position".
    value : float, tuple of float or str
        In the unit given.
    unit : str
        "" where there is none.
    source : str
        "data", "recording", "user" or "default".
    evidence : str
        One clause: what in the data says so, with figures.
    sd : float, optional
        One standard deviation of a value found in the data.
    """

    name: str
    value: float | tuple[float, ...] | str
    unit: str
    source: str
    evidence: str
    sd: float | None = None


@dataclass(frozen=True, eq=False)
class Innovations(Columns):
    """What one kind of observation said against the prediction.

    Parameters
    ----------
    time : ndarray, shape (k,)
        Time the observation holds for, IMU clock [s].
    z : ndarray, shape (k, d)
        Observed minus predicted, SI units.
    sd : ndarray, shape (k, d)
        Predicted standard deviation of z, from S = H P H' + R before any adaptation.
    nis : ndarray, shape (k,)
        Normalised innovation squared z' S^-1 z, before any adaptation.
    factor : ndarray, shape (k,)
        By how much R was inflated (mean over its variances): 1 as stated, inf where the
        observation was rejected.
    """

    z: Array
    sd: Array
    nis: Array
    factor: Array


@dataclass(frozen=True)
class Notice:
    """Something that went wrong on the way and was noticed.

    Parameters
    ----------
    start, end : float
        Seconds after the first IMU sample; the same for what happened in a moment.
    channel : str
        "position", "velocity", "odometer", "nonholonomic", or "imu", "gyro", "filter".
    text : str
        One clause, with its times.
    kind : str
        "silenced", "believed", "turned", "leaned", "heading", "drifted", "felt", "anew", "surprised"; "more"
        for the rest of many.
    lasting : float
        For how long, all told [s]; 0 for what happened in a moment.
    size : float
        How large it was, SI units; 0 where that says nothing.
    """

    start: float
    end: float
    channel: str
    text: str
    kind: str = ""
    lasting: float = 0.0
    size: float = 0.0


@dataclass(frozen=True, eq=False)
class Solution:
    """Result of fusing a recording.

    Parameters
    ----------
    name : str
        Of the recording.
    system : str
        Of the recipe that navigated.
    trajectory : Trajectory
        The IMU's path, the box's attitude; first row at the end of alignment.
    states : dict of str to ndarray, shape (n, k)
        Further states at the trajectory's times by block name: "gyro_bias" [rad/s],
        "accel_bias" [m/s^2], "mounting" [rad], "odometer_scale", ...
    states_sd : dict of str to ndarray, shape (n, k)
        Their standard deviations.
    innovations : dict of str to Innovations
        By channel: "position", "velocity", "nonholonomic", "zero_velocity", "odometer", ...
    decisions : tuple of Decision
    outages : tuple of (float, float)
        Withheld stretches, seconds after the first IMU sample.
    start : float
        Time of the first IMU sample [s].
    notes : tuple of Note
        What was mended in the recording.
    learned : tuple of object
        Fitted learners of bridges, to be saved.
    start_sd : dict of str to ndarray, shape (k,)
        By block, standard deviations before there were observations, where the first row knows of later ones.
    exhibits : tuple of Exhibit
        What bridges heard and how the run rehearsed.
    notices : tuple of Notice
        What went wrong on the way, in order of time.
    verdict : str
        What all of that means for the result, in a sentence; "" where nothing did.
    """

    name: str
    system: str
    trajectory: Trajectory
    states: dict[str, Array]
    states_sd: dict[str, Array]
    innovations: dict[str, Innovations]
    decisions: tuple[Decision, ...]
    outages: tuple[tuple[float, float], ...]
    start: float
    notes: tuple[Note, ...] = field(default=())
    learned: tuple[object, ...] = field(default=())
    start_sd: dict[str, Array] = field(default_factory=dict)
    exhibits: tuple[Exhibit, ...] = field(default=())
    notices: tuple[Notice, ...] = field(default=())
    verdict: str = ""

    def in_outage(self, time: Array) -> NDArray[np.bool_]:
        """Which times lie in a withheld stretch.

        Parameters
        ----------
        time : ndarray, shape (n,)
            [s] on the IMU clock.

        Returns
        -------
        ndarray of bool, shape (n,)
        """
        inside = np.zeros(len(time), bool)
        for a, b in self.outages:
            inside |= (time - self.start >= a) & (time - self.start < b)
        return inside


class Observed(NamedTuple):
    """How well one error state came to be known.

    Parameters
    ----------
    block : str
        "position", "velocity", "attitude", or a further block.
    axis : int
    start, end : float
        Standard deviation at the first row (of the filter, where a smoother came after it) and at the last
        one, SI units.
    ratio : float
        End over start; NaN where nothing was uncertain at the start.
    """

    block: str
    axis: int
    start: float
    end: float
    ratio: float


def observability(solution: Solution) -> tuple[Observed, ...]:
    """How far the standard deviation of each error state fell: what the run showed, and what it did not.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    tuple of Observed
        Axis by axis; empty without rows.
    """
    found = []
    for block, sds in _deviations(solution).items():
        for axis in range(sds.shape[1] if len(sds) else 0):
            start, end = float(solution.start_sd.get(block, sds[0])[axis]), float(sds[-1, axis])
            found.append(Observed(block, axis, start, end, end / start if start > 0.0 else math.nan))
    return tuple(found)


def first_deviations(solution: Solution) -> dict[str, Array]:
    """Standard deviations at the first row, for `Solution.start_sd`.

    Parameters
    ----------
    solution : Solution
        Of a filter.

    Returns
    -------
    dict of str to ndarray, shape (k,)
    """
    return {block: sds[0] for block, sds in _deviations(solution).items() if len(sds)}


def _deviations(solution: Solution) -> dict[str, Array]:
    sd = solution.trajectory.sd
    names = ("position", "velocity", "attitude")
    return {name: sd[:, 3 * k : 3 * k + 3] for k, name in enumerate(names)} | solution.states_sd
