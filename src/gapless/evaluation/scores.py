"""The score of a solution: against its reference, or else against the fixes that were withheld."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from gapless.evaluation.ages import Ages, ages
from gapless.evaluation.errors import Errors, at_antenna, gnss_truth, solution_errors
from gapless.evaluation.outages import (
    LABELS,
    OutageScore,
    height_offset,
    outside_labels,
    score_outage,
    score_outages,
)
from gapless.evaluation.statistics import Consistency, Spread, consistency, rms, spread
from gapless.scenarios import Outage, withheld
from gapless.trip.motion import first_motion
from gapless.trip.recording import Array, Recording, Trajectory
from gapless.trip.solution import Solution

DECISIONS_TAKEN: Final = "decisions taken late"
"""The decision that says that an outage had begun before anything could be decided."""


@dataclass(frozen=True)
class Accuracy:
    """Errors over many epochs.

    Parameters
    ----------
    epochs : int
        With a known position error.
    horizontal_rmse, horizontal_p95, horizontal_max : float
        Of the horizontal position error [m].
    vertical_rmse : float
        [m], the height offset taken off.
    velocity_rmse : float
        Of the horizontal velocity error [m/s].
    roll_rmse, pitch_rmse, heading_rmse : float
        [rad]
    coverage : float
        Share of epochs whose stated 95 % ellipse holds the truth; one that states none is outside.
    nees : Consistency
        Of the horizontal error; the band supposes independent epochs.
    """

    epochs: int
    horizontal_rmse: float
    horizontal_p95: float
    horizontal_max: float
    vertical_rmse: float
    velocity_rmse: float
    roll_rmse: float
    pitch_rmse: float
    heading_rmse: float
    coverage: float
    nees: Consistency


@dataclass(frozen=True, eq=False)
class Scores:
    """Everything that comparing a solution with a truth gave.

    Parameters
    ----------
    truth : str
        "reference" or "gnss".
    statement : str
        What the truth is, for people.
    clock_offset : float
        Added to the truth's stamps to land on the IMU clock [s].
    height_offset : float
        Solution above truth outside outages [m], taken off all vertical errors; NaN if unknown.
    errors : Errors
        Epoch by epoch.
    aided : Accuracy
        Outside outages. Against the GNSS itself that is agreement with what was used, not accuracy.
    fixes_rmse : float
        Horizontal RMSE of the raw fixes against the reference [m]; NaN without one.
    outages : tuple of OutageScore
    """

    truth: str
    statement: str
    clock_offset: float
    height_offset: float
    errors: Errors
    aided: Accuracy
    fixes_rmse: float
    outages: tuple[OutageScore, ...]

    @property
    def pool(self) -> tuple[OutageScore, ...]:
        """Outages that no label sets apart."""
        return tuple(o for o in self.outages if o.counts)

    @property
    def unstated(self) -> int:
        """Epochs with a known error and no ellipse that could hold it: see `Errors.usable`."""
        return self.errors.unstated

    @property
    def horizontal(self) -> Spread:
        """Spread of the largest horizontal error over the pool [m]."""
        return pool_spread([self])

    @property
    def coverage(self) -> float:
        """Share of the pool's truth epochs that the stated 95 % ellipses hold; NaN without any."""
        told = [o for o in self.pool if not math.isnan(o.coverage_95)]
        epochs = sum(o.truth_epochs for o in told)
        return sum(o.coverage_95 * o.truth_epochs for o in told) / epochs if epochs else math.nan


@np.errstate(over="ignore", invalid="ignore")  # whatever a solution states
def score(solution: Solution, recording: Recording) -> Scores:
    """Score a solution against the recording's reference, or its GNSS where there is none.

    Withheld fixes are still in the recording, so they can be the truth of the outages. The
    clock offsets are those of the decisions "clock offset, position" and "clock offset, velocity".

    Parameters
    ----------
    solution : Solution
    recording : Recording
        The one that was fused, nothing taken out.

    Returns
    -------
    Scores
    """
    truth = _truth(recording, solution)
    errors = _errors(solution.trajectory, truth, recording, solution)
    outages = [Outage(a, b) for a, b in solution.outages]
    outside = ~withheld(errors.time, outages, solution.start + truth.late)
    rise = height_offset(errors, outages, solution.start + truth.late)
    begun, decided = first_motion(recording), _decided(solution, DECISIONS_TAKEN)
    return Scores(
        truth="gnss" if recording.reference is None else "reference",
        statement=_STATEMENTS[recording.reference is None],
        clock_offset=truth.clock_offset,
        height_offset=rise,
        errors=errors,
        aided=accuracy(errors.take(outside), rise),
        fixes_rmse=_fixes_rmse(truth, recording),
        outages=score_outages(errors, outages, solution.start, recording.imu, begun, truth.late, decided),
    )


@np.errstate(over="ignore", invalid="ignore")
def score_pieces(
    whole: Solution, pieces: Sequence[tuple[Outage, Trajectory]], recording: Recording
) -> tuple[Scores, tuple[tuple[OutageScore, Ages], ...]]:
    """Score outages that each have a trajectory of their own.

    Parameters
    ----------
    whole : Solution
        With every fix there is: it gives the decisions and the height offset.
    pieces : sequence of (Outage, Trajectory)
        Each trajectory covers its outage.
    recording : Recording

    Returns
    -------
    whole : Scores
        Of the solution with every fix.
    pieces : tuple of (OutageScore, Ages)
    """
    scores, truth, begun = score(whole, recording), _truth(recording, whole), first_motion(recording)
    rise = 0.0 if math.isnan(scores.height_offset) else scores.height_offset
    decided, start = _decided(whole, DECISIONS_TAKEN), whole.start
    found = []
    for outage, trajectory in pieces:
        errors = _errors(trajectory, truth, recording, whole)
        scored = Outage(outage.start, outage.until)
        labels = outside_labels(scored, start, recording.imu, begun, decided)
        one = score_outage(errors, scored, start + truth.late, rise, labels)
        found.append((one, ages(errors, scored, start + truth.late, rise)))
    return scores, tuple(found)


def outage_ages(solution: Solution, scores: Scores) -> tuple[Ages, ...]:
    """Errors by age, of every outage of a scored solution.

    Parameters
    ----------
    solution : Solution
    scores : Scores

    Returns
    -------
    tuple of Ages
        In the order of `scores.outages`.
    """
    rise = 0.0 if math.isnan(scores.height_offset) else scores.height_offset
    begin = solution.start + _decided(solution, "clock offset, position")
    return tuple(ages(scores.errors, Outage(o.start, o.end), begin, rise) for o in scores.outages)


class _Truth(NamedTuple):
    """What a solution is scored against, and by how much its stamps and those of the fixes are late."""

    trajectory: Trajectory
    fixes: Trajectory
    clock_offset: float
    late: float


def _truth(recording: Recording, solution: Solution) -> _Truth:
    late, late_velocity = (_decided(solution, f"clock offset, {of}") for of in ("position", "velocity"))
    fixes = gnss_truth(recording.gnss, late, late_velocity)
    if recording.reference is None:
        return _Truth(fixes, fixes, late, late)
    return _Truth(recording.reference, fixes, late if recording.reference_clock == "gnss" else 0.0, late)


def _errors(trajectory: Trajectory, truth: _Truth, recording: Recording, solution: Solution) -> Errors:
    if recording.reference is None:  # fixes are on the IMU clock already, and hold for the antenna
        arm = _lever_arm(solution, recording, trajectory.time)
        return solution_errors(at_antenna(trajectory, arm), truth.trajectory)
    return solution_errors(trajectory, truth.trajectory, truth.clock_offset)


def _fixes_rmse(truth: _Truth, recording: Recording) -> float:
    if recording.reference is None:
        return math.nan
    return rms(solution_errors(recording.reference, truth.fixes, -truth.clock_offset).horizontal)


def accuracy(errors: Errors, height_offset: float = 0.0) -> Accuracy:
    """Errors over all given epochs.

    Parameters
    ----------
    errors : Errors
    height_offset : float
        Solution above truth [m]; taken off.

    Returns
    -------
    Accuracy
    """
    horizontal = errors.horizontal
    band = consistency(errors.nees, 2)
    size = spread(horizontal)
    return Accuracy(
        epochs=size.count,
        horizontal_rmse=size.rms,
        horizontal_p95=size.p95,
        horizontal_max=size.worst,
        vertical_rmse=rms(errors.position[:, 2] + height_offset),
        velocity_rmse=rms(np.hypot(errors.velocity[:, 0], errors.velocity[:, 1])),
        roll_rmse=rms(errors.attitude[:, 0]),
        pitch_rmse=rms(errors.attitude[:, 1]),
        heading_rmse=rms(errors.attitude[:, 2]),
        coverage=errors.coverage(),
        nees=band,
    )


def pool_spread(scores: Iterable[Scores], apart: Collection[str] = LABELS) -> Spread:
    """Spread of the largest horizontal error over the pooled outages of several recordings.

    Parameters
    ----------
    scores : iterable of Scores
    apart : collection of str
        Labels that leave an outage out.

    Returns
    -------
    Spread
        [m]
    """
    every = (o for one in scores for o in one.outages)
    return spread(o.horizontal_max for o in every if not set(o.labels) & set(apart))


_STATEMENTS = (
    "the recording's reference, which navigation never sees",
    "the GNSS itself: in outages the withheld fixes, elsewhere the very fixes that were used",
)


def _lever_arm(solution: Solution, recording: Recording, time: Array) -> Array:
    """The arm that a solution used: as it estimated it at these times, else as it took it."""
    found = solution.states.get("lever_arm")
    if found is not None:
        rows = solution.trajectory.time
        return np.column_stack([np.interp(time, rows, axis) for axis in found.T])
    for decision in solution.decisions:
        if decision.name == "antenna lever arm":
            return np.array(decision.value, float)
    return np.zeros(3) if recording.lever_arm is None else recording.lever_arm


def _decided(solution: Solution, name: str) -> float:
    for decision in solution.decisions:
        if decision.name == name and isinstance(decision.value, (int, float)):
            return float(decision.value)
    return 0.0
