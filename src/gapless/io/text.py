"""Bare text of numbers, fast: pyarrow parses it in blocks as it streams in, in several threads."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from io import RawIOBase
from pathlib import Path
from typing import BinaryIO, Final

import numpy as np
from numpy.typing import NDArray

from gapless.errors import RecordingError
from gapless.io.log import Log
from gapless.io.tables import is_number, join, unreadable
from gapless.trip.recording import Array

_COMMENTS: Final = (b"#", b"%")
_HEAD: Final = 1 << 16
"""Bytes in which the first row of data is looked for."""
_TO_BLANK: Final = bytes.maketrans(b",\t", b"  ")
_CHUNK: Final = 1 << 18
"""Bytes worked on at a time when blanks are removed: small enough for the second-level cache."""
_BLOCK: Final = 1 << 20
"""Bytes that one parser thread takes at a time: pyarrow's default, fastest of 0.25 to 8 MB here."""


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
            if words_seen or is_number(words[0]):
                return skipped, start, words
            words_seen = 1
        skipped, start = skipped + 1, end + 1
    return skipped, len(raw), []


def _split(line: bytes) -> list[bytes]:
    return line.replace(b",", b" ").split()


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
    return [join(column) for column in table.columns[:width]]


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
            bad = next(word for word in words if not is_number(word))
            shown = bad[:40].decode("ascii", "replace")
            raise RecordingError(f"{path}:{number}: {shown!r} is not a number; mend or remove it") from error
        rows.append(number)
    table = np.frombuffer(values, float).reshape(-1, width)
    return [np.ascontiguousarray(column) for column in table.T], np.frombuffer(rows, np.int64)
