"""One recording, some methods, all scenarios: what one process does, and what it hands back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from gapless.errors import LaboratoryError
from gapless.evaluation import Ages, OutageScore, Scores, outage_ages, score, score_pieces
from gapless.evaluation.outages import BEFORE_DECISIONS
from gapless.laboratory.methods import Method, Run
from gapless.laboratory.rows import (
    Block,
    Describe,
    Key,
    Row,
    age_columns,
    outage_row,
    run_row,
    track_columns,
    truth_columns,
)
from gapless.laboratory.study import ISOLATED, PASSES, Scenario, Source
from gapless.scenarios import Outage
from gapless.trip.recording import Recording


@dataclass(frozen=True)
class Job:
    """What one process is given.

    Parameters
    ----------
    source : Source
    methods : tuple of Method
    scenarios : tuple of Scenario
    protocols : tuple of str
    describe : callable
        As `rows.run_row` takes it.
    seed : int
        Of the samples at which the prefix law is checked.
    tracks : bool
        Whether tracks are kept.
    truth : bool
        Whether the truth's track is kept.
    """

    source: Source
    methods: tuple[Method, ...]
    scenarios: tuple[Scenario, ...]
    protocols: tuple[str, ...]
    describe: Describe
    seed: int = 0
    tracks: bool = True
    truth: bool = True


@dataclass
class Outcome:
    """What one process hands back.

    Parameters
    ----------
    recording : dict
        Name, duration, distance, rates and truth of the recording.
    outages, runs : list of dict
    ages, tracks : list of dict of columns
    checks : dict of str to str
        By system: what the check of the prefix law came to.
    """

    recording: Row
    outages: list[Row] = field(default_factory=list)
    runs: list[Row] = field(default_factory=list)
    ages: list[Block] = field(default_factory=list)
    tracks: list[Block] = field(default_factory=list)
    checks: dict[str, str] = field(default_factory=dict)


def execute(job: Job) -> Outcome:
    """Run, check and score.

    Parameters
    ----------
    job : Job

    Returns
    -------
    Outcome

    Raises
    ------
    LaboratoryError
        If a system that calls itself causal reads the future.
    GaplessError
        If the recording cannot be read or navigated.
    """
    recording = job.source.open()
    planned = [(s, s.outages(recording)) for s in job.scenarios]
    planned = [(s, outages) for s, outages in planned if outages]
    outcome = Outcome(_about(recording))
    for method in job.methods:
        bench = _Bench(job, method, recording, outcome)
        for protocol in job.protocols:
            if protocol == PASSES:
                for scenario, outages in planned:
                    bench.passes(scenario, outages)
            else:
                for together in _same_starts(planned):
                    bench.isolated(together)
        outcome.checks[method.name] = bench.verdict()
    return outcome


Planned = Sequence[tuple[Scenario, tuple[Outage, ...]]]


def _same_starts(planned: Planned) -> Iterable[Planned]:
    """Scenarios whose outages begin at the same times: one forward run serves them all."""
    found: dict[tuple[float, ...], list[tuple[Scenario, tuple[Outage, ...]]]] = {}
    for one in planned:
        found.setdefault(tuple(o.start for o in one[1]), []).append(one)
    return found.values()


def _about(recording: Recording) -> Row:
    gnss = recording.gnss.time
    return {
        "name": recording.name,
        "duration": recording.duration,
        "distance": float("nan"),
        "imu_rate": recording.imu.rate,
        "gnss_rate": float(1.0 / np.median(np.diff(gnss))) if len(gnss) > 1 else float("nan"),
        "truth": "gnss" if recording.reference is None else "reference",
    }


class _Bench:
    """One method on one recording."""

    def __init__(self, job: Job, method: Method, recording: Recording, outcome: Outcome) -> None:
        self.job, self.method, self.recording, self.outcome = job, method, recording, outcome
        self.blind = replace(recording, reference=None)
        self.rng = np.random.default_rng([job.seed, len(method.name), len(recording.imu)])
        self.checked = 0
        self.wants_truth = job.tracks and job.truth and method is job.methods[0]

    def passes(self, scenario: Scenario, outages: tuple[Outage, ...]) -> None:
        """All outages in one run."""
        run = self.method.passes(self.blind, outages)
        solution = replace(run.solution, outages=tuple((o.start, o.until) for o in outages))
        scores = score(solution, self.recording)
        told = list(zip(outages, scores.outages, outage_ages(solution, scores), strict=True))
        self._check(run, [(o, one) for o, one, _ in told])
        key = self._run(scenario, PASSES, run, scores)
        for outage, one, aged in told:
            self._keep(key, scenario, scores.truth, outage, one, aged, run)

    def isolated(self, together: Planned) -> None:
        """Each outage alone, those of several scenarios from one forward run."""
        every = tuple(sorted({o for _, outages in together for o in outages}))
        run = self.method.isolated(self.blind, every)
        scores, scored = score_pieces(run.solution, run.pieces, self.recording)
        told = {o: found for (o, _), found in zip(run.pieces, scored, strict=True)}
        self._check(run, [(o, one) for o, (one, _) in told.items()])
        for scenario, outages in together:
            key = self._run(scenario, ISOLATED, run, scores)
            for outage in outages:
                self._keep(key, scenario, scores.truth, outage, *told[outage], run)

    def _check(self, run: Run, scored: Sequence[tuple[Outage, OutageScore]]) -> None:
        if not self.method.causal:
            return
        outages = [outage for outage, one in scored if BEFORE_DECISIONS not in one.labels]
        found = self.method.peek(self.blind, outages, run, self.rng)
        self.checked += len(outages)
        if found is not None:
            raise LaboratoryError(
                f"{self.method.name} reads the future: on {self.recording.name}, in outage {found.outage}, "
                f"its row at {found.time:.2f} s is another one where nothing is there after it and the "
                "withheld fixes are nonsense; mend it, or declare it not causal"
            )

    def verdict(self) -> str:
        """What the check of the prefix law came to."""
        if not self.method.causal:
            return "declared not causal; not checked"
        return f"held in {self.checked} outages"

    def _run(self, scenario: Scenario, protocol: str, run: Run, scores: Scores) -> Key:
        key = Key(self.recording.name, self.method.name, protocol, scenario.text)
        self.outcome.runs.append(run_row(key, run.solution, scores, self.job.describe))
        if len(scores.errors):
            self.outcome.recording["distance"] = float(scores.errors.distance[-1])
        if self.wants_truth:
            self.outcome.tracks.append(truth_columns(self.recording, scores))
            self.wants_truth = False
        return key

    def _keep(
        self, key: Key, scenario: Scenario, truth: str, outage: Outage, one: OutageScore, aged: Ages, run: Run
    ) -> None:
        self.outcome.outages.append(outage_row(key, scenario, truth, one))
        self.outcome.ages.append(age_columns(key, one.start, aged))
        if self.job.tracks:
            rows: Any = dict(run.pieces).get(outage, run.solution.trajectory)
            self.outcome.tracks.append(track_columns(key, outage, rows, self.recording.start))
