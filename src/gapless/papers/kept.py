"""Outcomes that are kept while a reproduction runs, so that hours of work outlive an interruption.

One file a job, named after all that its outcome depends on: code, recipes, seed or recording. Arrays and
numbers in msgpack, so that what is read back has the bits of what was computed.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, Final

import msgspec
import numpy as np

from gapless.io.writers.atomic import atomic
from gapless.laboratory.study import Stored
from gapless.papers.jobs import Job, Outcome
from gapless.sweeps.run import versions
from gapless.sweeps.sources import fingerprint
from gapless.trip.recording import Array

FOLDER: Final = "unfinished"
"""Where they are, in the folder of the results."""


def once(folder: Path, work: Callable[[Job], Outcome], job: Job) -> Outcome:
    """The outcome of a job: read where it is kept, and kept otherwise, whole or not at all.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    work : callable
        Does a job.
    job : Job

    Returns
    -------
    Outcome
    """
    path = folder / f"{_key(job)}.msgpack"
    try:
        return msgspec.msgpack.decode(path.read_bytes(), type=Outcome, dec_hook=_decoded)
    except (FileNotFoundError, msgspec.DecodeError):  # not there, or damaged
        outcome = work(job)
    with atomic(path) as made:
        made.write_bytes(msgspec.msgpack.encode(outcome, enc_hook=_encoded))
    return outcome


def forget(folder: Path) -> None:
    """Throw away what was kept, and the folder if nothing else is in it.

    Parameters
    ----------
    folder : Path
    """
    for path in folder.glob("*.msgpack"):
        if re.fullmatch("[0-9a-f]{24}", path.stem):
            path.unlink(missing_ok=True)
    with suppress(OSError):  # not there, or somebody else's files are in it
        folder.rmdir()


def _key(job: Job) -> str:
    drive = job.experiment.drive
    files = [str(path) for path in job.source.paths] if isinstance(job.source, Stored) else []
    told = [
        (_code(), versions()),
        (job.experiment.name, repr(job.experiment.road), repr(drive and replace(drive, segments=""))),
        [(r.method.name, r.method.smoothed, msgspec.to_builtins(r.system)) for r in job.ready],
        (job.seed, job.shown, repr(job.source), fingerprint(files)),
    ]
    return hashlib.sha256(msgspec.msgpack.encode(told)).hexdigest()[:24]


@cache
def _code() -> str:
    """A digest of this package's source: other code, other outcomes."""
    found, root = hashlib.sha256(), Path(__file__).parents[1]
    for path in sorted(p for p in root.rglob("*") if p.suffix in {".py", ".toml"}):
        found.update(f"{path.relative_to(root)}\n".encode() + path.read_bytes())
    return found.hexdigest()


def _encoded(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return [list(value.shape), np.ascontiguousarray(value, float).tobytes()]
    if isinstance(value, np.generic):
        return value.item()
    raise NotImplementedError(f"{type(value).__name__} in an outcome")


def _decoded(kind: Any, value: Any) -> Any:
    shape, content = value
    array: Array = np.frombuffer(content, float).reshape(shape)
    return array
