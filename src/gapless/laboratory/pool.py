"""Jobs over processes, their outcomes in the order of the jobs."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")
Progress = Callable[[float], None]
"""Told how many jobs are done."""


def in_order(
    work: Callable[[T], R], jobs: Sequence[T], processes: int, progress: Progress | None = None
) -> Iterator[R]:
    """Outcomes in the order of the jobs.

    Parameters
    ----------
    work : callable
        Does one.
    jobs : sequence
    processes : int
        With one, everything runs in this process.
    progress : callable, optional

    Yields
    ------
    object
        What `work` made of a job.
    """
    tell = progress or (lambda done: None)
    if processes == 1:
        for k, job in enumerate(jobs):
            yield work(job)
            tell(k + 1.0)
        return
    with _workers(processes) as pool:
        futures = [pool.submit(work, job) for job in jobs]
        for k, future in enumerate(as_completed(futures)):
            future.result()  # whatever went wrong ends it all now
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
