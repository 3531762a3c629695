"""Processes that end with their parent, and jobs over them, their outcomes in the order of the jobs.

Nothing heavy is imported here or by the package: a new process imports this module first, and says
what the numerical libraries are to find when their turn comes.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Final, TypeVar

_THREADS: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

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
    pool = Processes(processes)
    try:
        futures = [pool.submit(work, job) for job in jobs]
        for k, future in enumerate(as_completed(futures)):
            future.result()  # whatever went wrong ends it all now
            tell(k + 1.0)
        yield from (future.result() for future in futures)
    finally:
        pool.dismiss()


class Processes(ProcessPoolExecutor):
    """A pool of new processes, one thread each, that end when they are dismissed or their parent dies.

    Parameters
    ----------
    count : int
        Of processes.
    """

    def __init__(self, count: int) -> None:
        context = get_context("spawn")
        # the pipe ends when this process closes it, and by itself when this process is killed
        watched, self._lifeline = context.Pipe(duplex=False)
        super().__init__(count, context, _begin, (watched,))

    def dismiss(self) -> None:
        """End the processes, whatever they do."""
        self._lifeline.close()
        self.shutdown(wait=True, cancel_futures=True)


def _begin(lifeline: Connection) -> None:
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent to answer
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()


def _end_with(lifeline: Connection) -> None:
    try:
        lifeline.poll(None)
    finally:  # Windows raises where others return
        os._exit(1)
