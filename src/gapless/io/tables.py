"""Parquet, and CSV with a header, to columns of numbers.

pyarrow parses in several threads. Its own ways into NumPy import pandas where that is installed
(0.2 s or more), so columns cross by DLPack, which does not.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np

from gapless.errors import RecordingError
from gapless.io.log import Log
from gapless.trip.recording import Array


def load(path: Path, wanted: Collection[str]) -> Log:
    """Read the known columns of a Parquet file or of a CSV with a header; others are left.

    Parameters
    ----------
    path : Path
        Ends in ".parquet" or in anything else for CSV.
    wanted : collection of str

    Returns
    -------
    Log

    Raises
    ------
    RecordingError
        If the file cannot be read, a known column is there twice or is not numeric.
    """
    try:
        return _load(path, wanted)
    except RecordingError:
        raise
    except Exception as error:  # whatever a parser makes of damaged bytes, the user gets one line
        raise unreadable(path, error) from error


def unreadable(path: Path, error: BaseException) -> RecordingError:
    """One line for a file that is absent, cut short or damaged.

    Parameters
    ----------
    path : Path
    error : BaseException
        What the parser or the system said.

    Returns
    -------
    RecordingError
    """
    if isinstance(error, FileNotFoundError):
        return RecordingError(f"{path}: no such file; check the path")
    lines = str(error).strip().splitlines() or [type(error).__name__]
    row = re.search(r"Row #(\d+)", lines[0])
    place = f"{path}:{row.group(1)}" if row else str(path)
    return RecordingError(
        f"{place}: cannot be read ({lines[0][:160]}); it may be cut short or damaged: copy or export it again"
    )


def is_number(word: bytes) -> bool:
    """Whether a cell is a number, NaN and infinity included.

    Parameters
    ----------
    word : bytes

    Returns
    -------
    bool
    """
    try:
        float(word)
    except ValueError:
        return False
    return True


def _load(path: Path, wanted: Collection[str]) -> Log:
    is_parquet = path.suffix == ".parquet"
    table = _parquet(path) if is_parquet else _csv(path)
    first_row = 1 if is_parquet else 2
    columns: dict[str, Array] = {}
    for label, column in zip(table.column_names, table.columns, strict=True):
        name = label.strip().lstrip("\ufeff")
        if name in columns:
            raise RecordingError(f"{path}: column {name} is there twice; keep one")
        if name in wanted:
            columns[name] = _numbers(column, name, path, first_row)
    return Log(str(path), columns, first_row)


def _parquet(path: Path) -> Any:
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        return file.read()


def _csv(path: Path) -> Any:
    import pyarrow as pa
    from pyarrow import csv

    raw = path.read_bytes()
    if not raw.strip():
        raise RecordingError(f"{path}: the file is empty; give a log of two rows or more")
    try:
        return csv.read_csv(pa.BufferReader(raw))
    except pa.ArrowInvalid:  # one thread counts rows: its message says which one is at fault
        return csv.read_csv(pa.BufferReader(raw), read_options=csv.ReadOptions(use_threads=False))


def _numbers(column: Any, name: str, path: Path, first_row: int) -> Array:
    import pyarrow as pa

    kind = column.type
    if pa.types.is_string(kind) or pa.types.is_large_string(kind):
        for k, word in enumerate(column.to_pylist()):
            if word is not None and not is_number(word.strip().encode()):
                raise RecordingError(
                    f"{path}:{first_row + k}: {name} is {word[:40]!r}, not a number; mend or empty that cell"
                )
        return np.array([float("nan" if word is None else word) for word in column.to_pylist()])
    if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_null(kind)):
        raise RecordingError(f"{path}: column {name} holds {kind}, not numbers; store it as float64")
    return join(column)


def join(column: Any) -> Array:
    """A column of numbers as an array; NaN where it is empty.

    Parameters
    ----------
    column : pyarrow.ChunkedArray

    Returns
    -------
    ndarray, shape (n,)
    """
    import pyarrow as pa

    chunks = []
    if column.type != pa.float64():  # casting imports pyarrow.compute: not where it can be helped
        column = column.cast(pa.float64(), safe=False)
    for chunk in column.chunks:
        chunks.append(np.from_dlpack(chunk.fill_null(float("nan")) if chunk.null_count else chunk))
    return np.concatenate([*chunks, np.empty(0)])
