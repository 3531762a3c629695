"""What was heard of a car, kept for its next drive: JSON, nothing that runs."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from gapless.bridges.comb import Memory
from gapless.errors import ConfigError

KIND, VERSION = "gapless wheels", 3
TRUST: Final = 60.0
"""Spectra that an earlier drive counts for at most: tyres wear, and boxes are moved."""
LARGEST: Final = 2_000_000
"""No such file has more bytes."""


def written(memory: Memory) -> bytes:
    """A memory as the contents of a file; the same memory gives the same bytes.

    Parameters
    ----------
    memory : Memory

    Returns
    -------
    bytes
    """
    held = {f.name: np.asarray(getattr(memory, f.name)).tolist() for f in fields(Memory)}
    return json.dumps({"kind": KIND, "version": VERSION, **held}).encode()


def recalled(path: str) -> Memory:
    """The memory in a file that `gapless fuse --save-model` wrote, as a prior for another drive.

    Parameters
    ----------
    path : str

    Returns
    -------
    Memory
        Of `TRUST` spectra at most.

    Raises
    ------
    ConfigError
        If there is no such file, or it holds anything else.
    """
    cure = "give one that gapless fuse --system wheels --save-model wrote"
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise ConfigError(f"bridge.parameters.vehicle: {path}: {error.strerror or error}; {cure}") from None
    try:
        memory = _parsed(data)
    except (ValueError, KeyError, TypeError, RecursionError, OverflowError) as error:
        raise ConfigError(f"bridge.parameters.vehicle: {path}: no car's wheels ({error}); {cure}") from None
    less = min(1.0, TRUST / max(memory.windows, 1e-9))
    sums = ("total", "count", "square", "mean", "speeds", "levels", "windows")
    return replace(memory, **{name: getattr(memory, name) * less for name in sums})


def _parsed(data: bytes) -> Memory:
    if len(data) > LARGEST:
        raise ValueError("too large")
    held: Any = json.loads(data)
    if not isinstance(held, dict) or held.get("kind") != KIND:
        raise ValueError("another kind of file")
    if held.get("version") != VERSION:
        raise ValueError(f"version {held.get('version')}, not {VERSION}")
    like = Memory.empty(0.0)
    found: dict[str, Any] = {}
    for f in fields(Memory):
        value, shape = np.asarray(held[f.name], float), np.shape(getattr(like, f.name))
        if value.shape != shape:
            raise ValueError(f"{f.name} of shape {value.shape}, not {shape}")
        if not np.isfinite(value).all():
            raise ValueError(f"{f.name} is not finite")
        found[f.name] = value if shape else float(value)
    for name in ("count", "square", "speeds", "windows", "top"):
        if np.min(found[name]) < 0.0:
            raise ValueError(f"{name} is negative")
    if np.min(found["levels"][:, ::2]) < 0.0:
        raise ValueError("levels hold a negative count or square")
    return Memory(**found)
