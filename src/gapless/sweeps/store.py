"""Rows on disk: `DIR/study=NAME/part-....parquet`, each part whole or not there.

A part holds some runs with their outages nested in them, so that one renaming commits both: there is
no moment at which a run counts and its outages do not, or the other way round.
"""

from __future__ import annotations

import hashlib
import io
import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, fields
from functools import cache
from typing import Any, Final, Literal, get_type_hints

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from gapless.errors import ConfigError
from gapless.io.marks import PARQUET_KEY, marked
from gapless.sweeps.execute import Row, outage_columns
from gapless.sweeps.places import Place, place

BATCH: Final = 256
"""Most rows of a part."""
PATIENCE: Final = 1.0
"""A row that comes later than this [s] after the last part is stored at once, with those that wait."""
_STUDY: Final = "study="
_RUN_KEYS: Final = ("key", "recording", "seed", "system", "override", "scenario")
"""Columns of a run that its outages repeat."""


class Store:
    """The rows of one study; `opened` makes one.

    Parameters
    ----------
    where : Place
        Folder of the study.
    """

    def __init__(self, where: Place) -> None:
        self._where = where
        self._rows: list[Row] = []
        self._stored = time.monotonic()

    def keys(self) -> set[str]:
        """Keys of the runs that are stored.

        Returns
        -------
        set of str
        """
        return {key for _, part in _parts(self._where, ["key"]) for key in part["key"].to_pylist()}

    def forget_failed(self, force: bool = False) -> None:
        """Throw away the rows of runs that failed, so that they are done again.

        Parameters
        ----------
        force : bool
            Of parts without our mark too.

        Raises
        ------
        ConfigError
            If such a part holds some; then nothing is changed.
        """
        failed = []
        for name, part in _parts(self._where):
            kept = part.filter(pc.field("outcome") != "failed")
            if len(kept) == len(part):
                continue
            if not force and PARQUET_KEY not in (part.schema.metadata or {}):
                raise ConfigError(
                    f"{name}: gapless did not write it as it is; move it away, or change it with --force"
                )
            failed.append((name, kept))
        for name, kept in failed:
            if not len(kept):
                self._where.remove(name)
            else:
                self._where.write(name, _packed(kept))

    def add(self, row: Row) -> None:
        """Take a row; it is stored with the next part.

        Parameters
        ----------
        row : Row
        """
        self._rows.append(row)
        if len(self._rows) >= BATCH or time.monotonic() - self._stored > PATIENCE:
            self.flush()

    def flush(self) -> None:
        """Store what has been taken; doing it again after an interruption gives the same part."""
        if not self._rows:
            return
        table = pa.Table.from_pylist([asdict(row) for row in self._rows], schema())
        name = hashlib.sha256("".join(row.key for row in self._rows).encode()).hexdigest()[:16]
        self._where.write(f"part-{name}.parquet", _packed(table))
        self._rows.clear()
        self._stored = time.monotonic()


@contextmanager
def opened(folder: str, study: str) -> Iterator[Store]:
    """The store of a study, for this process alone; what was taken is stored whatever ends the block.

    Parameters
    ----------
    folder : str
        A path, or a URL for fsspec.
    study : str

    Yields
    ------
    Store

    Raises
    ------
    GaplessError
        If another process writes there, or the place cannot be reached.
    """
    where = place(f"{folder.rstrip('/')}/{_STUDY}{study}")
    with where.reserve():
        where.clean()
        store = Store(where)
        try:
            yield store
        finally:
            store.flush()


def read(
    folder: str | os.PathLike[str],
    table: Literal["runs", "outages"] = "runs",
    studies: Sequence[str] = (),
    columns: Sequence[str] = (),
) -> Any:
    """What studies have found so far.

    Parameters
    ----------
    folder : path
        What they were given as `--out`; a URL goes through fsspec.
    table : {"runs", "outages"}
        A row per run, or per outage with the key and the names of its run.
    studies : sequence of str
        Names; all if none is given.
    columns : sequence of str
        Of the runs; all if none is given.

    Returns
    -------
    pyarrow.Table
        Sorted by study and key, so that the order in which runs ended does not show.

    Raises
    ------
    ConfigError
        If there is no such study, or a part is damaged.
    """
    folder = os.fspath(folder).rstrip("/")
    names = [n.removeprefix(_STUDY) for n in place(folder).folders() if n.startswith(_STUDY)]
    for name in studies:
        if name not in names:
            told = f"it holds {', '.join(names)}" if names else "it holds none"
            raise ConfigError(f"{folder}: no study {name!r}; {told}")
    found = []
    for name in studies or names:
        wanted = [*dict.fromkeys(["key", *columns])] if columns and table == "runs" else None
        for _, part in _parts(place(f"{folder}/{_STUDY}{name}"), wanted):
            rows = _outages(part) if table == "outages" else part.drop_columns(_nested(part))
            found.append(rows.add_column(0, "study", pa.repeat(pa.scalar(name), len(rows))))
    if not found:
        raise ConfigError(f"{folder}: no results of a sweep; give the folder that was its --out")
    order = ["study", "key", "start"] if table == "outages" else ["study", "key"]
    return pa.concat_tables(found, promote_options="default").sort_by([(n, "ascending") for n in order])


@cache
def schema() -> Any:
    """Columns of a part.

    Returns
    -------
    pyarrow.Schema
    """
    hints = get_type_hints(Row)
    columns = [(f.name, _arrow(hints[f.name])) for f in fields(Row) if f.name != "each"]
    outage = pa.struct([(name, _arrow(kind)) for name, kind in outage_columns().items()])
    return pa.schema([*columns, ("each", pa.list_(outage))])


def _arrow(kind: Any) -> Any:
    known = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), bool | None: pa.bool_()}
    return known.get(kind, pa.string())


def _packed(table: Any) -> bytes:
    buffer = io.BytesIO()
    pq.write_table(marked(table), buffer, compression="zstd")
    return buffer.getvalue()


def _nested(part: Any) -> list[str]:
    return [name for name in part.column_names if name == "each"]


def _outages(part: Any) -> Any:
    """One row an outage, from runs with their outages nested."""
    each = part["each"].combine_chunks()
    rows = part.select(list(_RUN_KEYS)).take(pc.list_parent_indices(each))
    return pa.table(
        dict(zip(rows.column_names, rows.columns, strict=True))
        | dict(zip(each.type.value_type.names, pc.list_flatten(each).flatten(), strict=True))
    )


def _parts(where: Place, columns: list[str] | None = None) -> Iterator[tuple[str, Any]]:
    """Name and table of every part."""
    for name in where.names():
        if name.startswith("part-"):
            try:
                part = pq.read_table(io.BytesIO(where.read(name)), columns=columns)
            except pa.ArrowInvalid as error:
                raise ConfigError(f"{name}: damaged ({error}); remove it, its runs are done again") from None
            if not {"key", *([] if columns else ["outcome"])} <= {*part.column_names}:
                raise ConfigError(f"{name}: holds no runs of a sweep; move it away")
            yield name, part
