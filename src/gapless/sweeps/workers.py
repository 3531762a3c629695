"""Who does the runs: processes of this machine, or a dask cluster."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor
from dataclasses import dataclass
from typing import Any, Final

from gapless.errors import ConfigError, MissingExtraError, SweepError
from gapless.laboratory.pool import Processes

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
