"""The bench: jobs over processes, results together."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

from gapless.errors import ConfigError
from gapless.laboratory.boards import leaderboard, pairs, set_apart
from gapless.laboratory.jobs import Job, Outcome, execute
from gapless.laboratory.methods import Method
from gapless.laboratory.pool import Progress, in_order
from gapless.laboratory.rows import Block, Describe, Row
from gapless.laboratory.study import Scenario, Simulated, Source

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
    for outcome in in_order(execute, jobs, processes, progress):
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
