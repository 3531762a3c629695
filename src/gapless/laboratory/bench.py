"""The bench: jobs over processes, results together."""

from __future__ import annotations

import math
import multiprocessing
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field

from gapless.errors import ConfigError
from gapless.laboratory.boards import leaderboard, pairs, set_apart
from gapless.laboratory.jobs import Job, Outcome, execute
from gapless.laboratory.methods import Method
from gapless.laboratory.rows import Block, Describe, Row
from gapless.laboratory.study import Scenario, Simulated, Source

Progress = Callable[[float], None]
"""Told how many jobs are done."""
MOST_TRACKS = 20
"""Tracks are kept of so many recordings."""


@dataclass
class Results:
    """All that a bench found.

    Parameters
    ----------
    methods : tuple of Method
    scenarios : tuple of Scenario
    protocols : tuple of str
    recordings : list of dict
    outages, runs : list of dict
    ages, tracks : list of dict of columns
    checks : dict
        By system and recording.
    leaderboard, pairs, apart : list of dict
    seconds : float
        Wall time.
    """

    methods: tuple[Method, ...]
    scenarios: tuple[Scenario, ...]
    protocols: tuple[str, ...]
    recordings: list[Row] = field(default_factory=list)
    outages: list[Row] = field(default_factory=list)
    runs: list[Row] = field(default_factory=list)
    ages: list[Block] = field(default_factory=list)
    tracks: list[Block] = field(default_factory=list)
    checks: dict[str, dict[str, str]] = field(default_factory=dict)
    leaderboard: list[Row] = field(default_factory=list)
    pairs: list[Row] = field(default_factory=list)
    apart: list[Row] = field(default_factory=list)
    seconds: float = math.nan


def bench(
    sources: Sequence[Source],
    methods: Sequence[Method],
    scenarios: Sequence[Scenario],
    protocols: Sequence[str],
    describe: Describe,
    *,
    seed: int = 0,
    processes: int = 1,
    progress: Progress | None = None,
) -> Results:
    """Put methods on the bench.

    Parameters
    ----------
    sources : sequence of Source
    methods : sequence of Method
        The first is the one that the others are compared with.
    scenarios : sequence of Scenario
    protocols : sequence of str
        Of `study.PROTOCOLS`.
    describe : callable
        Gives "decisions", "states" and "innovations" of a solution, ready for JSON.
    seed : int
        Of the samples at which the prefix law is checked, and of the bootstrap.
    processes : int
        With one, everything runs in this process.
    progress : callable, optional

    Returns
    -------
    Results

    Raises
    ------
    LaboratoryError
        If a system that calls itself causal reads the future.
    ConfigError
        If two systems have one name, or no outage fits into any recording.
    """
    names = [method.name for method in methods]
    for name in names:
        if names.count(name) > 1:
            raise ConfigError(f"two systems are called {name}; give one of them another `name`")
    begun = time.perf_counter()
    results = Results(tuple(methods), tuple(scenarios), tuple(protocols))
    jobs = plan_jobs(sources, methods, scenarios, protocols, describe, seed)
    for outcome in run_jobs(jobs, processes, progress):
        _gather(results, outcome)
    if not results.outages:
        raise ConfigError("no outage fits into any of the recordings; begin earlier, or ask for shorter ones")
    results.leaderboard = leaderboard(results.outages, seed)
    results.pairs = pairs(results.outages, names[0], seed)
    results.apart = set_apart(results.outages)
    results.seconds = time.perf_counter() - begun
    return results


def plan_jobs(
    sources: Sequence[Source],
    methods: Sequence[Method],
    scenarios: Sequence[Scenario],
    protocols: Sequence[str],
    describe: Describe,
    seed: int,
) -> list[Job]:
    """A job for each recording and method; where recordings have to be made, one for all methods.

    Parameters
    ----------
    sources : sequence of Source
    methods : sequence of Method
    scenarios : sequence of Scenario
    protocols : sequence of str
    describe : callable
    seed : int

    Returns
    -------
    list of Job
    """
    jobs = []
    for k, source in enumerate(sources):
        together = isinstance(source, Simulated)
        parts = [tuple(methods)] if together else [(method,) for method in methods]
        for i, part in enumerate(parts):
            kept, first = k < MOST_TRACKS, i == 0
            jobs.append(
                Job(source, part, tuple(scenarios), tuple(protocols), describe, seed, kept, kept and first)
            )
    return jobs


def run_jobs(jobs: Sequence[Job], processes: int, progress: Progress | None = None) -> Iterator[Outcome]:
    """Outcomes in the order of the jobs.

    Parameters
    ----------
    jobs : sequence of Job
    processes : int
    progress : callable, optional

    Yields
    ------
    Outcome
    """
    tell = progress or (lambda done: None)
    if processes == 1:
        for k, job in enumerate(jobs):
            yield execute(job)
            tell(k + 1.0)
        return
    with _workers(processes) as pool:
        futures = [pool.submit(execute, job) for job in jobs]
        for k, future in enumerate(as_completed(futures)):
            future.result()  # whatever went wrong ends the bench now
            tell(k + 1.0)
        yield from (future.result() for future in futures)


@contextmanager
def _workers(count: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that end with the block, whatever they are doing then."""
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(
        count, mp_context=multiprocessing.get_context("spawn"), initializer=_leave_interrupts_to_the_parent
    )
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for child in set(multiprocessing.active_children()) - others:
            child.terminate()
        raise
    finally:
        pool.shutdown()


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _gather(results: Results, outcome: Outcome) -> None:
    name = outcome.recording["name"]
    known = next((row for row in results.recordings if row["name"] == name), None)
    if known is None:
        results.recordings.append(outcome.recording)
    results.outages += outcome.outages
    results.runs += outcome.runs
    results.ages += outcome.ages
    results.tracks += outcome.tracks
    for system, said in outcome.checks.items():
        results.checks.setdefault(system, {})[name] = said
