"""Runs in, rows out as they are completed, whatever happens to those who do them."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from itertools import islice
from typing import Final

from gapless.errors import GaplessError, SweepError
from gapless.sweeps.execute import Row, execute, failed
from gapless.sweeps.run import Run
from gapless.sweeps.workers import Crew

TRIES: Final = 3
"""A run whose worker dies so often is given up."""

Task = Callable[[Run], Row]


def completed(runs: Iterable[Run], crew: Crew, task: Task = execute) -> Generator[Row, None, None]:
    """Rows in the order in which runs end; no more than `crew.ahead` runs are held at a time.

    Where a worker dies, the pool is gone with everything in hand. Those runs are done again one by
    one, so that the one to blame shows: after `TRIES` deaths it becomes a failed row.

    Parameters
    ----------
    runs : iterable of Run
    crew : Crew
    task : callable
        Of one run, giving its row.

    Yields
    ------
    Row

    Raises
    ------
    SweepError
        If the executor is gone for another reason than a run.
    GaplessError
        That a task raised: not the run is to blame, but the place where it is done.
    """
    waiting = iter(runs)
    while lost := (yield from _shift(waiting, crew, crew.workers, crew.ahead, task)):
        deaths, doubtful = Counter(run.key for run in lost), deque(lost)
        while doubtful:
            for run in (yield from _shift(_taken(doubtful), crew, 1, 1, task)):
                deaths[run.key] += 1
                if deaths[run.key] < TRIES:
                    doubtful.appendleft(run)
                else:
                    yield failed(run, SweepError(f"its worker died {TRIES} times"))


def _taken(doubtful: deque[Run]) -> Iterator[Run]:
    while doubtful:
        yield doubtful.popleft()


def _shift(
    runs: Iterator[Run], crew: Crew, workers: int, ahead: int, task: Task
) -> Generator[Row, None, list[Run]]:
    """Rows of one executor until the runs are done or it breaks; returns what it then had in hand."""
    executor = crew.hire(workers)
    hand: dict[Future[Row], Run] = {}
    lost: list[Run] = []
    try:
        while not lost:
            for run in islice(runs, ahead - len(hand)):
                hand[_submitted(executor, task, run)] = run
            if not hand:
                break
            for future in wait(hand, return_when=FIRST_COMPLETED).done:
                run = hand.pop(future)
                try:
                    row = _row(future, run, crew.blames)
                except BrokenExecutor:
                    lost.append(run)
                else:
                    yield row
        return lost + list(hand.values())
    finally:
        for future in hand:
            future.cancel()
        crew.dismiss(executor)


def _submitted(executor: Executor, task: Task, run: Run) -> Future[Row]:
    try:
        return executor.submit(task, run)
    except BrokenExecutor as error:
        broken: Future[Row] = Future()
        broken.set_exception(error)
        return broken


def _row(future: Future[Row], run: Run, blames: tuple[type[Exception], ...]) -> Row:
    try:
        return future.result()
    except (BrokenExecutor, GaplessError):
        raise
    except blames as error:
        return failed(run, error)
    except Exception as error:
        raise SweepError(
            f"a worker cannot do its work ({type(error).__name__}: {error}); run again to go on"
        ) from error
