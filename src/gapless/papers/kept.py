"""Outcomes that are kept while a reproduction runs, so that hours of work outlive an interruption.

One file a job, named after all that its outcome depends on: code, recipes, seed or recording. Arrays and
numbers in msgpack, so that what is read back has the bits of what was computed.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, Final

import msgspec
import numpy as np

from gapless.io.writers.atomic import atomic
from gapless.papers.jobs import Job, Outcome
from gapless.recording import Array

FOLDER: Final = "unfinished"
"""Where they are, in the folder of the results."""


def place(folder: Path, job: Job) -> Path:
    """Where the outcome of a job is kept.

    Parameters
    ----------
    folder : Path
    job : Job

    Returns
    -------
    Path
    """
    files = [file for path in job.paths for file in _files(path)]
    drive = job.experiment.drive
    told = [
        _code(),
        (job.experiment.name, repr(job.experiment.road), repr(drive and replace(drive, segments=""))),
        [(r.method.name, r.method.smoothed, msgspec.to_builtins(r.system)) for r in job.ready],
        (job.seed, job.shown),
        [(str(f.resolve()), f.stat().st_size, f.stat().st_mtime_ns) for f in files],
    ]
    return folder / f"{hashlib.sha256(msgspec.msgpack.encode(told)).hexdigest()[:24]}.msgpack"


def load(path: Path) -> Outcome | None:
    """An outcome that was kept.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Outcome or None
        None where there is none, or not a whole one.
    """
    try:
        return msgspec.msgpack.decode(path.read_bytes(), type=Outcome, dec_hook=_decoded)
    except (FileNotFoundError, msgspec.DecodeError):
        return None


def save(path: Path, outcome: Outcome) -> None:
    """Keep an outcome, whole or not at all.

    Parameters
    ----------
    path : Path
        Its folder is made if it is not there.
    outcome : Outcome
    """
    with atomic(path) as made:
        made.write_bytes(msgspec.msgpack.encode(outcome, enc_hook=_encoded))


def _files(path: Path) -> list[Path]:
    return sorted(p for p in path.iterdir() if p.is_file()) if path.is_dir() else [path]


@cache
def _code() -> str:
    """A digest of this package's source: other code, other outcomes."""
    found = hashlib.sha256()
    root = Path(__file__).parents[1]
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
