"""Executors that lose their workers: nothing is lost with them, and who is to blame is found."""

import os
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from functools import partial
from multiprocessing import get_context

import pytest
from studies import run

from gapless.errors import ConfigError, MissingExtraError, SweepError
from gapless.sweeps.execute import blank
from gapless.sweeps.stream import TRIES, completed
from gapless.sweeps.workers import crew, hired


def quick(one):
    return blank(one, "done", "")


def deadly(folder, killers, one):
    """Seeds with a number kill their worker so many times."""
    tries = folder / str(one.seed)
    with tries.open("a") as file:
        file.write("x")
    if tries.stat().st_size <= killers.get(one.seed, 0):
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(one)


def test_a_worker_that_dies_takes_nothing_with_it(tmp_path):
    runs = [run(seed) for seed in range(12)]
    task = partial(deadly, tmp_path, {4: 1, 9: 1000})
    rows = list(completed(runs, crew("processes", 2), task))
    assert sorted(row.seed for row in rows) == list(range(12))
    (bad,) = (row for row in rows if row.outcome != "done")
    assert (bad.seed, bad.outcome) == (9, "failed")
    assert bad.reason == f"SweepError: its worker died {TRIES} times"
    assert (tmp_path / "9").stat().st_size == TRIES


def test_few_runs_are_held_at_a_time():
    made = []

    def runs() -> Iterator:
        for seed in range(1000):
            made.append(seed)
            yield run(seed)

    with ThreadPoolExecutor(1) as pool, closing(completed(runs(), hired(pool, ahead=8), quick)) as rows:
        for count, _ in enumerate(rows, 1):
            assert len(made) <= count + 8
    assert count == 1000


def test_stopping_early_cancels_what_waits():
    cancelled = []

    class Waiting(ThreadPoolExecutor):
        def submit(self, task, one):
            future = super().submit(task, one) if one.seed == 0 else Future()
            future.add_done_callback(lambda f: cancelled.append(one.seed) if f.cancelled() else None)
            return future

    with Waiting(1) as pool:
        rows = completed((run(seed) for seed in range(9)), hired(pool, ahead=4), quick)
        assert next(rows).seed == 0
        rows.close()
    assert sorted(cancelled) == [1, 2, 3]


def test_somebodys_own_executor_that_breaks_ends_the_sweep(tmp_path):
    task = partial(deadly, tmp_path, {1: 1})
    with (
        ProcessPoolExecutor(1, get_context("spawn")) as pool,
        pytest.raises(SweepError, match="lost a worker"),
    ):
        list(completed([run(seed) for seed in range(4)], hired(pool), task))


def test_a_run_that_a_cluster_blames_is_a_failed_row():
    class KilledWorker(Exception):
        pass

    def task(one):
        if one.seed == 1:
            raise KilledWorker("attempted on 4 workers, all of them died")
        return quick(one)

    with ThreadPoolExecutor(1) as pool:
        workers = replace(hired(pool), blames=(KilledWorker,))
        rows = list(completed([run(seed) for seed in range(3)], workers, task))
    assert [(r.seed, r.outcome) for r in sorted(rows, key=lambda r: r.seed)] == [
        (0, "done"), (1, "failed"), (2, "done")
    ]  # fmt: skip


def unreachable(one):
    raise ModuleNotFoundError("No module named 'gapless'")


def misplaced(one):
    raise ConfigError("the study was planned with other versions")


@pytest.mark.parametrize(
    ("task", "error", "words"),
    [(unreachable, SweepError, "cannot do its work"), (misplaced, ConfigError, "other versions")],
)
def test_where_the_place_is_to_blame_no_row_is_written(task, error, words):
    with ThreadPoolExecutor(1) as pool, pytest.raises(error, match=words):
        list(completed([run(0)], hired(pool), task))


@pytest.mark.parametrize(
    ("text", "jobs", "words"),
    [
        ("thread", None, "choose processes or dask://HOST:PORT"),
        ("dask://127.0.0.1:1", 4, "leave --jobs out"),
    ],
)
def test_executors_that_do_not_exist(text, jobs, words):
    with pytest.raises(ConfigError, match=words):
        crew(text, jobs)


def test_without_distributed_one_line_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'gapless\[cluster\]'"):
        crew("dask://127.0.0.1:8786")
