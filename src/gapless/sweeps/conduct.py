"""A study in, rows in a store: skip what is there, do the rest, say how far it is."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import dataclass, replace
from os import PathLike

from gapless.errors import ConfigError
from gapless.sweeps.execute import Row
from gapless.sweeps.run import Run
from gapless.sweeps.store import opened
from gapless.sweeps.stream import completed
from gapless.sweeps.study import Plan, plan_study
from gapless.sweeps.workers import Crew, crew, hired


@dataclass(frozen=True)
class Tally:
    """How far a sweep is.

    Parameters
    ----------
    total : int
        Runs of the study.
    there : int
        Of those, found in the store, or equal to another of the study.
    done, refused, failed : int
        Of those that this sweep ran.
    driven : float
        Recording time of the rows of this sweep [s].
    elapsed : float
        Since its start [s].
    """

    total: int
    there: int = 0
    done: int = 0
    refused: int = 0
    failed: int = 0
    driven: float = 0.0
    elapsed: float = 0.0

    @property
    def fresh(self) -> int:
        """Rows of this sweep."""
        return self.done + self.refused + self.failed

    @property
    def throughput(self) -> float:
        """Drive-hours per minute."""
        return self.driven / 60.0 / self.elapsed if self.elapsed > 0.0 else 0.0

    @property
    def left(self) -> float:
        """Time to the end at this pace [s]; NaN before the first row."""
        to_do = self.total - self.there - self.fresh
        return to_do * self.elapsed / self.fresh if self.fresh else float("nan")


Tell = Callable[[Tally], None]


def sweep(
    study: str | PathLike[str] | Plan,
    out: str | PathLike[str],
    executor: str | Executor = "processes",
    jobs: int | None = None,
    retry: bool = False,
    tell: Tell | None = None,
    force: bool = False,
) -> Tally:
    """Do the runs of a study that its store does not hold yet.

    Parameters
    ----------
    study : path or Plan
        A TOML file, or what `plan_study` made of one.
    out : path
        Folder of the store, or a URL for fsspec; `read_sweep` reads it. The study's rows are in
        `study=NAME`, whatever ends the sweep.
    executor : str or concurrent.futures.Executor
        "processes", "dask://HOST:PORT", or an executor of your own.
    jobs : int, optional
        Number of processes; one a core if not given.
    retry : bool
        Do failed runs again, instead of leaving their rows as they are.
    tell : callable, optional
        Told how far it is after each row.
    force : bool
        Let `retry` change parts that gapless did not write as they are.

    Returns
    -------
    Tally

    Raises
    ------
    ConfigError
        If the study or the executor is wrong, or another sweep writes to the store.
    RecordingError
        If a recording is not there. One that cannot be read is a row that says so.
    SweepError
        If the workers cannot go on.
    """
    plan = study if isinstance(study, Plan) else plan_study(study)
    if isinstance(executor, str):
        workers = crew(executor, jobs)
    elif jobs is None:
        workers = hired(executor)
    else:
        raise ConfigError("an executor of your own has its own number of workers; leave jobs out")
    with opened(str(out), plan.name) as store:
        if retry:
            store.forget_failed(force)
        return _swept(plan, workers, store.keys(), store.add, tell)


def _swept(
    plan: Plan, workers: Crew, known: set[str], add: Callable[[Row], None], tell: Tell | None
) -> Tally:
    tally, start = Tally(len(plan)), time.monotonic()
    skipped: Counter[str] = Counter()
    with closing(completed(_missing(plan, known, skipped), workers)) as rows:
        for row in rows:
            add(row)
            tally = _counted(tally, row, skipped.total(), time.monotonic() - start)
            if tell is not None:
                tell(tally)
    return replace(tally, there=skipped.total(), elapsed=time.monotonic() - start)


def _missing(runs: Iterable[Run], known: set[str], skipped: Counter[str]) -> Iterator[Run]:
    """Runs whose key is new; the others are counted by system."""
    for run in runs:
        key = run.key
        if key in known:
            skipped[run.system.name] += 1
        else:
            known.add(key)
            yield run


def _counted(tally: Tally, row: Row, there: int, elapsed: float) -> Tally:
    return replace(
        tally,
        there=there,
        elapsed=elapsed,
        driven=tally.driven + (row.duration if row.duration == row.duration else 0.0),
        **{row.outcome: getattr(tally, row.outcome) + 1},
    )
