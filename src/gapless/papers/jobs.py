"""One drive, all methods of an experiment: what one process does, and what it hands back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

from gapless.errors import ConfigError, GaplessError
from gapless.evaluation import Errors, Scores
from gapless.laboratory.study import Source
from gapless.papers.measure import measure
from gapless.papers.model import SAME_CLOCK, WHITE, Experiment, Method, Window
from gapless.runs.fuse import fuse
from gapless.runs.smooth import smooth
from gapless.scenarios import Outage
from gapless.systems.adjust import changed
from gapless.systems.library import load
from gapless.systems.recipe import System
from gapless.trip.recording import Array, Recording
from gapless.trip.solution import Solution

BROKEN: Final = (GaplessError, ValueError, ArithmeticError)
"""What ends a method on a drive, and not the others: it cannot run, or its numbers have run away. A method
that is told to believe its learner diverges now and then, and that is a result too."""


class Ready(NamedTuple):
    """A method with its recipe."""

    method: Method
    system: System


@dataclass(frozen=True)
class Sample:
    """What was measured of a method in one window of one drive.

    Parameters
    ----------
    experiment, drive, method, where : str
    start, end : float
        Of the window [s].
    values : dict of str to float
        From `measure`.
    """

    experiment: str
    drive: str
    method: str
    where: str
    start: float
    end: float
    values: dict[str, float]


class Curve(NamedTuple):
    """Errors through one outage.

    Parameters
    ----------
    experiment, method, where : str
    age : ndarray, shape (n,)
        [s] since it began.
    position, velocity : ndarray, shape (n, 3)
        North, east, down [m], [m/s].
    """

    experiment: str
    method: str
    where: str
    age: Array
    position: Array
    velocity: Array


class Track(NamedTuple):
    """Where one drive led.

    Parameters
    ----------
    experiment : str
    time : ndarray, shape (n,)
        [s]
    east_north, velocity : ndarray, shape (n, 2)
        [m], [m/s], both east, north.
    """

    experiment: str
    time: Array
    east_north: Array
    velocity: Array


@dataclass(frozen=True)
class Job:
    """What one process is given.

    Parameters
    ----------
    experiment : Experiment
    ready : tuple of Ready
    seed : int
        Of a simulated drive.
    source : Source, optional
        A real recording instead.
    shown : bool
        Whether its curves are kept.
    """

    experiment: Experiment
    ready: tuple[Ready, ...]
    seed: int = 0
    source: Source | None = None
    shown: bool = False


@dataclass
class Outcome:
    """What one process hands back.

    Parameters
    ----------
    samples : list of Sample
    curves : list of Curve
    tracks : list of Track
    failed : dict of str to str
        By method: why it could not run on this drive.
    """

    samples: list[Sample] = field(default_factory=list)
    curves: list[Curve] = field(default_factory=list)
    tracks: list[Track] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)


def prepare(experiment: Experiment) -> tuple[tuple[Ready, ...], dict[str, str]]:
    """Recipes of an experiment's methods.

    Parameters
    ----------
    experiment : Experiment

    Returns
    -------
    ready : tuple of Ready
    missing : dict of str to str
        By method: why there is no recipe of it.
    """
    told = {**SAME_CLOCK, **WHITE} if experiment.drive is not None else {}
    ready, missing = [], {}
    for method in experiment.methods:
        try:
            system = changed(load(method.recipe), {**told, **method.changes}, method.recipe)
            ready.append(Ready(method, system))
        except ConfigError as error:
            missing[method.name] = str(error)
    return tuple(ready), missing


def told(error: Exception) -> str:
    """Why a method has no row, in a line.

    Parameters
    ----------
    error : Exception
        One of `BROKEN`.

    Returns
    -------
    str
    """
    first = next(iter(str(error).splitlines()), "")
    return str(error) if isinstance(error, GaplessError) else f"{type(error).__name__}: {first}"


def navigate(method: Method, system: System, recording: Recording, outages: tuple[Outage, ...]) -> Solution:
    """Run a method as its paper does: onwards, or looking back over the whole record.

    Parameters
    ----------
    method : Method
    system : System
    recording : Recording
    outages : tuple of Outage

    Returns
    -------
    Solution
    """
    return (smooth if method.smoothed else fuse)(recording, system, outages)


def keep(
    outcome: Outcome,
    job: Job,
    method: Method,
    recording: Recording,
    scores: Scores,
    windows: tuple[Window, ...],
) -> None:
    """Measure a method in each window and keep what comes of it.

    Parameters
    ----------
    outcome : Outcome
        Grows.
    job : Job
    method : Method
    recording : Recording
    scores : Scores
        Of the run.
    windows : tuple of Window
        An outage that a label of the bench sets apart (standing still, before the motion) is left out.
    """
    known = {(o.start, o.end): o.labels for o in scores.outages}
    for window in windows:
        if known.get((window.start, window.end)):
            continue
        begin = recording.start + window.start
        errors = scores.errors.slice(begin, recording.start + window.end)
        sample = Sample(
            job.experiment.name, recording.name, method.name, window.name, window.start, window.end,
            measure(errors),
        )  # fmt: skip
        if sample.values["epochs"]:
            outcome.samples.append(sample)
        if job.shown and window.withheld:
            outcome.curves.append(_curve(job.experiment.name, method.name, window.name, errors, begin))


def _curve(experiment: str, method: str, where: str, errors: Errors, begin: float) -> Curve:
    return Curve(experiment, method, where, errors.time - begin, errors.position, errors.velocity)
