"""Files to columns of numbers, fast: Parquet and CSV with a header, and bare text of numbers.

pyarrow parses in several threads. Its own ways into NumPy import pandas where that is installed
(0.2 s or more), so columns cross by DLPack, which does not.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Collection, Sequence
from io import RawIOBase
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np
from numpy.typing import NDArray

from gapless.errors import RecordingError
from gapless.io.log import Log
from gapless.recording import Array

_COMMENTS: Final = (b"#", b"%")
_HEAD: Final = 1 << 16
"""Bytes in which the first row of data is looked for."""
_TO_BLANK: Final = bytes.maketrans(b",\t", b"  ")
_CHUNK: Final = 1 << 18
"""Bytes worked on at a time when blanks are removed: small enough for the second-level cache."""
_BLOCK: Final = 1 << 20
"""Bytes that one parser thread takes at a time: pyarrow's default, fastest of 0.25 to 8 MB here."""


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


def load_numbers(path: Path, names: Sequence[Sequence[str]]) -> Log:
    """Read text of numbers without a header, split by blanks, tabs or commas.

    Parameters
    ----------
    path : Path
        Lines that start with # or % are comments; a first line of words is skipped.
    names : sequence of sequence of str
        Column names of each layout; the one with as many columns as the file is taken.

    Returns
    -------
    Log

    Raises
    ------
    RecordingError
        If the file cannot be read, no layout fits, or a cell is not a number: with its line.
    """
    try:
        raw = read_head(path)
    except OSError as error:
        raise unreadable(path, error) from error
    skipped, start, first = first_data_line(raw)
    if not first:
        raise RecordingError(f"{path}: no row of data; give a log of two rows or more")
    layout = next((layout for layout in names if len(layout) == len(first)), None)
    if layout is None:
        known = " or ".join(f"{len(layout)} ({', '.join(layout)})" for layout in names)
        raise RecordingError(f"{path}:{skipped + 1}: {len(first)} columns; make them {known}")
    line = raw[start : start + 4096].split(b"\n", 1)[0].rstrip(b"\r")
    columns = _fast(path, start, line, len(layout))
    if columns is not None:
        return Log(str(path), dict(zip(layout, columns, strict=True)), skipped + 1)
    columns, rows = _slow(path, start, skipped, len(layout))
    return Log(str(path), dict(zip(layout, columns, strict=True)), rows=rows)


def read_head(path: Path) -> bytes:
    """The beginning of a text file: 64 kB, or all of it where comments fill half of that.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bytes

    Raises
    ------
    OSError
    """
    with path.open("rb") as file:
        raw = file.read(_HEAD)
        if len(raw) == _HEAD and 2 * first_data_line(raw)[1] > _HEAD:
            raw += file.read()
    return raw


def first_data_line(raw: bytes) -> tuple[int, int, list[bytes]]:
    """Skip comments, blank lines and one line of words.

    Parameters
    ----------
    raw : bytes
        A text file, or its beginning.

    Returns
    -------
    skipped : int
        Lines before the first row.
    start : int
        Its offset in bytes.
    words : list of bytes
        Its cells; empty if there is none.
    """
    start = skipped = words_seen = 0
    while start < len(raw):
        end = raw.find(b"\n", start)
        end = len(raw) if end < 0 else end
        words = _split(raw[start : min(end, start + 4096)])
        if words and not words[0].startswith(_COMMENTS):
            if words_seen or _is_number(words[0]):
                return skipped, start, words
            words_seen = 1
        skipped, start = skipped + 1, end + 1
    return skipped, len(raw), []


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


def _split(line: bytes) -> list[bytes]:
    return line.replace(b",", b" ").split()


def _is_number(word: bytes) -> bool:
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
            if word is not None and not _is_number(word.strip().encode()):
                raise RecordingError(
                    f"{path}:{first_row + k}: {name} is {word[:40]!r}, not a number; mend or empty that cell"
                )
        return np.array([float("nan" if word is None else word) for word in column.to_pylist()])
    if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_null(kind)):
        raise RecordingError(f"{path}: column {name} holds {kind}, not numbers; store it as float64")
    return _join(column)


def _join(column: Any) -> Array:
    import pyarrow as pa

    chunks = []
    if column.type != pa.float64():  # casting imports pyarrow.compute: not where it can be helped
        column = column.cast(pa.float64(), safe=False)
    for chunk in column.chunks:
        chunks.append(np.from_dlpack(chunk.fill_null(float("nan")) if chunk.null_count else chunk))
    return np.concatenate([*chunks, np.empty(0)])


def _fast(path: Path, start: int, line: bytes, width: int) -> list[Array] | None:
    """Columns by pyarrow, block by block; None where a line is not as regular as it wants."""
    import pyarrow as pa
    from pyarrow import csv

    names = [f"f{i}" for i in range(width)]
    with path.open("rb") as file:
        file.seek(start)
        try:
            table = csv.read_csv(
                file
                if len(line.split(b" ")) == width and b"" not in line.split(b" ")
                else _SingleBlanks(file),
                read_options=csv.ReadOptions(autogenerate_column_names=True, block_size=_BLOCK),
                parse_options=csv.ParseOptions(delimiter=" ", quote_char=False),
                convert_options=csv.ConvertOptions(column_types=dict.fromkeys(names, pa.float64())),
            )
        except pa.ArrowInvalid:
            return None
    extra = table.columns[width:]
    if table.num_columns < width or any(column.null_count < table.num_rows for column in extra):
        return None
    return [_join(column) for column in table.columns[:width]]


class _SingleBlanks(RawIOBase):
    """A file with tabs and commas as blanks, one blank between cells, none before the first."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._open = True

    def readable(self) -> bool:
        return True

    def read(self, size: int = -1) -> bytes:
        out = []
        while size and (piece := self._file.read(min(size, _CHUNK) if size > 0 else _CHUNK)):
            out.append(self._squeeze(piece.translate(_TO_BLANK)))
            size -= len(out[-1])
        return b"".join(out)

    def _squeeze(self, piece: bytes) -> bytes:
        text = np.frombuffer(piece, np.uint8)
        blank = text == 32
        drop = np.empty_like(blank)
        drop[0] = self._open
        np.logical_or(blank[:-1], text[:-1] == 10, out=drop[1:])
        self._open = bool(blank[-1] or text[-1] == 10)
        drop &= blank
        squeezed: bytes = text[~drop].tobytes()
        return squeezed


def _slow(path: Path, start: int, skipped: int, width: int) -> tuple[list[Array], NDArray[np.int64]]:
    """Line by line: takes comments anywhere, and knows the line that is at fault."""
    values, rows = array("d"), array("q")
    for number, line in enumerate(path.read_bytes()[start:].split(b"\n"), skipped + 1):
        words = _split(line)
        if not words or words[0].startswith(_COMMENTS):
            continue
        if len(words) != width:
            raise RecordingError(
                f"{path}:{number}: {len(words)} columns where {width} are expected; "
                "the line may be cut short: mend or remove it"
            )
        try:
            values.extend(map(float, words))
        except ValueError as error:
            bad = next(word for word in words if not _is_number(word))
            shown = bad[:40].decode("ascii", "replace")
            raise RecordingError(f"{path}:{number}: {shown!r} is not a number; mend or remove it") from error
        rows.append(number)
    table = np.frombuffer(values, float).reshape(-1, width)
    return [np.ascontiguousarray(column) for column in table.T], np.frombuffer(rows, np.int64)
