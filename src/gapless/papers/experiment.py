"""Every method of a paper over many drives, in processes, and all results together."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from gapless.errors import ConfigError, MissingExtraError
from gapless.laboratory.pool import Progress, in_order
from gapless.laboratory.study import Source
from gapless.papers import drives, road
from gapless.papers.jobs import Curve, Job, Outcome, Ready, Sample, Track, prepare
from gapless.papers.kept import once
from gapless.papers.model import Experiment, Paper
from gapless.papers.studies import STUDIES, Study


@dataclass
class Results:
    """What an experiment came to.

    Parameters
    ----------
    experiment : Experiment
    drives : int
        That were run.
    samples : list of Sample
    curves : list of Curve
    tracks : list of Track
    missing : dict of str to str
        By method: why it has no row.
    failed : dict of str to str
        By method: on how many drives it could not run, and why the first time.
    """

    experiment: Experiment
    drives: int = 0
    samples: list[Sample] = field(default_factory=list)
    curves: list[Curve] = field(default_factory=list)
    tracks: list[Track] = field(default_factory=list)
    missing: dict[str, str] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)

    def of(self, method: str, where: str) -> list[Sample]:
        """Samples of a method in a window.

        Parameters
        ----------
        method, where : str

        Returns
        -------
        list of Sample
        """
        return [s for s in self.samples if s.method == method and s.where == where]


@dataclass(frozen=True)
class Reproduction:
    """A paper's experiments, done.

    Parameters
    ----------
    paper : Paper
    results : tuple of Results
    seconds : float
        Wall time.
    studies : dict of str to Study
        What the paper shows beside its drives.
    undone : dict of str to str
        Why a study could not be done.
    """

    paper: Paper
    results: tuple[Results, ...]
    seconds: float
    studies: dict[str, Study] = field(default_factory=dict)
    undone: dict[str, str] = field(default_factory=dict)


def chosen(paper: Paper, seeds: int | None, sources: Sequence[Source]) -> list[tuple[Experiment, int]]:
    """Experiments that are asked for, and over how many drives.

    Parameters
    ----------
    paper : Paper
    seeds : int, optional
        Simulated drives; those of each experiment if not given. What is looked at aside is never run
        over more than it asks for itself.
    sources : sequence of Source
        Real recordings.

    Returns
    -------
    list of (Experiment, int)

    Raises
    ------
    ConfigError
        If nothing is left to do.
    """
    found = []
    for experiment in paper.experiments:
        if experiment.drive is None:
            count = len(sources)
        else:
            count = experiment.seeds if seeds is None else seeds
            count = min(count, experiment.seeds) if experiment.aside else count
        if count:
            found.append((experiment, count))
    if not found:
        raise ConfigError(f"{paper.name}: nothing to run; give --seeds of 1 or more, or recordings")
    return found


def reproduce(
    paper: Paper,
    seeds: int | None = None,
    sources: Sequence[Source] = (),
    processes: int = 1,
    progress: Progress | None = None,
    kept: Path | None = None,
) -> Reproduction:
    """Run a paper's experiments again.

    Parameters
    ----------
    paper : Paper
    seeds : int, optional
        Simulated drives of each experiment; as each asks for if not given, 0 for none.
    sources : sequence of Source
        Real recordings for its road test.
    processes : int
        With one, everything runs in this process.
    progress : callable, optional
        Told the share that is done [%].
    kept : Path, optional
        Folder in which outcomes are kept as they come; those that are there are not computed again.

    Returns
    -------
    Reproduction

    Raises
    ------
    GaplessError
        If a recording cannot be read, or no method of an experiment can be run.
    """
    begun = time.perf_counter()
    results, jobs = [], []
    for experiment, count in chosen(paper, seeds, sources):
        ready, missing = prepare(experiment)
        if not ready:
            raise ConfigError(f"{paper.name}, {experiment.name}: {next(iter(missing.values()))}")
        found = Results(experiment, count, missing=missing)
        results.append(found)
        jobs += [(found, job) for job in _jobs(experiment, ready, count, sources)]

    def tell(done: float) -> None:
        if progress is not None:
            progress(100.0 * done / len(jobs))

    work = execute if kept is None else partial(once, kept, execute)
    outcomes = in_order(work, [job for _, job in jobs], processes, tell)
    for (found, _), outcome in zip(jobs, outcomes, strict=True):
        _gather(found, outcome)
    studies, undone = _studied(paper, results)
    return Reproduction(paper, tuple(results), time.perf_counter() - begun, studies, undone)


def _jobs(
    experiment: Experiment, ready: tuple[Ready, ...], count: int, sources: Sequence[Source]
) -> Iterator[Job]:
    """A job for each simulated drive; on a recording, which takes longer, one for each method."""
    for k in range(count):
        if experiment.drive is not None:
            yield Job(experiment, ready, k + 1, shown=k == 0)
        else:
            yield from (Job(experiment, (one,), source=sources[k], shown=k == 0) for one in ready)


def execute(job: Job) -> Outcome:
    """What one process does.

    Parameters
    ----------
    job : Job

    Returns
    -------
    Outcome

    Raises
    ------
    GaplessError
        If a recording cannot be read.
    """
    return drives.execute(job) if job.source is None else road.execute(job)


def _studied(paper: Paper, results: Sequence[Results]) -> tuple[dict[str, Study], dict[str, str]]:
    """What the paper shows beside its drives, where any of these was simulated."""
    done, undone = {}, {}
    simulated = [r.experiment for r in results if r.experiment.drive is not None]
    for name in paper.studies if simulated else ():
        try:
            done[name] = STUDIES[name](simulated[0])
        except MissingExtraError as error:
            undone[name] = str(error)
    return done, undone


def _gather(results: Results, outcome: Outcome) -> None:
    results.samples += outcome.samples
    results.curves += outcome.curves
    results.tracks += outcome.tracks
    for method, reason in outcome.failed.items():
        before = results.failed.get(method)
        count, said = (0, reason) if before is None else _counted(before)
        results.failed[method] = f"{count + 1} of {results.drives} drives: {said}"


def _counted(text: str) -> tuple[int, str]:
    count, _, rest = text.partition(" ")
    return int(count), rest.partition("drives: ")[2]
