"""Who does the runs: processes of this machine, or a dask cluster.

Nothing heavy is imported here or by the package: a new process imports this module first, and says
what the numerical libraries are to find when their turn comes.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, Final

from gapless.errors import ConfigError, MissingExtraError, SweepError

_THREADS: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_DASK: Final = "dask://"
ANSWER: Final = 10.0
"""A scheduler must answer within this [s]."""


@dataclass(frozen=True)
class Crew:
    """Where executors come from, and how they go.

    Parameters
    ----------
    hire : callable
        A new executor with so many workers.
    dismiss : callable
        Lets an executor go at once, with what it has in hand.
    workers : int
    ahead : int
        Most runs handed out at a time: enough that no worker waits, few enough to keep in mind.
    blames : tuple of exception types
        What a future raises where the run itself is to blame for a worker's death.
    """

    hire: Callable[[int], Executor]
    dismiss: Callable[[Any], None]
    workers: int
    ahead: int
    blames: tuple[type[Exception], ...] = ()


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


def crew(text: str = "processes", jobs: int | None = None) -> Crew:
    """The workers that a command line asks for.

    Parameters
    ----------
    text : str
        "processes", or "dask://HOST:PORT" for the scheduler of a cluster.
    jobs : int, optional
        Number of processes; one a core if not given. A cluster has its own.

    Returns
    -------
    Crew

    Raises
    ------
    GaplessError
        If there is no such executor, or no cluster at that address, or distributed is not installed.
    """
    if text == "processes":
        count = jobs or os.cpu_count() or 1
        return Crew(_processes, Processes.dismiss, count, 2 * count)
    if not text.startswith(_DASK):
        raise ConfigError(f"executor {text!r} is unknown; choose processes or {_DASK}HOST:PORT")
    if jobs is not None:
        raise ConfigError(f"{text}: a cluster has its own number of workers; leave --jobs out")
    return _cluster(text)


def _processes(count: int) -> Processes:
    pool = Processes(count)
    try:  # if not even this works, no run is to blame
        pool.submit(os.getpid).result()
    except BrokenExecutor:
        pool.dismiss()
        raise SweepError(
            "worker processes do not start; a script that sweeps needs `if __name__ == '__main__':`"
        ) from None
    return pool


def hired(executor: Executor, ahead: int = 64) -> Crew:
    """A crew of somebody's own executor, which outlives the sweep.

    Parameters
    ----------
    executor : concurrent.futures.Executor
    ahead : int
        Most runs handed out at a time.

    Returns
    -------
    Crew
    """
    once = iter([executor])

    def hire(_: int) -> Executor:
        for given in once:
            return given
        raise SweepError("the executor has lost a worker; make a new one and sweep again to go on")

    return Crew(hire, lambda _: None, 1, ahead)


def _cluster(text: str) -> Crew:
    try:
        import distributed
    except ImportError as error:
        raise MissingExtraError("distributed", "cluster") from error
    try:
        client = distributed.Client(f"tcp://{text.removeprefix(_DASK)}", timeout=ANSWER, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ConfigError(f"{text}: no dask scheduler answers ({error}); check host and port") from None
    threads = sum(client.nthreads().values())
    # a cluster runs what a lost worker had in hand again elsewhere, so that its pool never breaks
    return Crew(
        lambda _: client.get_executor(pure=False),
        lambda _: client.close(),
        threads,
        max(16, 4 * threads),
        (distributed.KilledWorker,),
    )
