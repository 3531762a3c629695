"""The files of a bench folder, as columns."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gapless.errors import ConfigError

Columns = dict[str, Any]
"""Arrays of one length by column name: float64, or str as objects."""
Group = NDArray[np.int64]
"""Rows of a table."""
QUANTITIES: Final = ("horizontal", "vertical", "along", "cross", "velocity", "heading_deg")
POOLED: Final = "pooled"
"""Stands for all recordings together."""
_RUN = ("recording", "system", "protocol", "scenario")
_STATISTICS = tuple(f"{s}{e}" for s in ("median", "rms", "p95", "worst") for e in ("", "_lo", "_hi"))
_WANTED: Final = {
    "outages": (
        *(*_RUN, "group", "length", "shift", "start", "end", "labels", "truth", "distance", "percent"),
        *(f"{q}_{s}" for q in QUANTITIES for s in ("max", "rmse", "end")),
        *("coverage_50", "coverage_95", "coverage_99", "nees", "inside_95_end"),
    ),
    "ages": (*_RUN, "start", "age", *QUANTITIES, "bound"),
    "tracks": (
        *("recording", "kind", "protocol", "scenario", "start", "time", "lat", "lon"),
        *("semi_major", "semi_minor", "direction"),
    ),
    "runs": (*_RUN, "decisions", "biases", "innovations", "rmse_open", "coverage_open_95"),
    "leaderboard": (
        *("recording", "protocol", "group", "length", "system", "n", *_STATISTICS),
        *("coverage_50", "coverage_95", "coverage_99", "left_out"),
    ),
    "pairs": (
        *("recording", "protocol", "group", "system", "base", "n", "median_ratio", "geometric"),
        *("geometric_lo", "geometric_hi", "better", "worst_ratio", "p", "p_corrected"),
    ),
}
"""Columns that the page needs of each Parquet file."""
_FACTS = ("gapless", "recordings", "systems", "protocols")


@dataclass(frozen=True, eq=False)
class Bench:
    """A bench folder, read.

    Parameters
    ----------
    facts : dict
        `bench.json`.
    outages, ages, tracks, runs, leaderboard, pairs : dict of str to ndarray
        Columns of the Parquet files, units as in their names; a pooled row of `leaderboard` or
        `pairs` has the recording `POOLED`.
    tables : str
        `tables.txt`; "" where it is not there.
    """

    facts: dict[str, Any]
    outages: Columns
    ages: Columns
    tracks: Columns
    runs: Columns
    leaderboard: Columns
    pairs: Columns
    tables: str

    @property
    def recordings(self) -> list[str]:
        """Names, in the order of the bench."""
        return [str(one["name"]) for one in self.facts["recordings"]]

    @property
    def systems(self) -> list[str]:
        """Names, in the order of the bench."""
        return [str(one["name"]) for one in self.facts["systems"]]


def is_bench(folder: Path) -> bool:
    """Whether a folder looks like one of a bench.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    bool
    """
    return (folder / "bench.json").is_file()


def read_bench(folder: Path) -> Bench:
    """Read a bench folder.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    Bench

    Raises
    ------
    ConfigError
        If a file is missing or is not what a bench writes.
    """
    path = folder / "bench.json"
    try:
        facts = json.loads(path.read_text("utf-8"))
        missing = [key for key in _FACTS if key not in facts]
    except FileNotFoundError as error:
        raise ConfigError(f"{folder}: no bench.json in it; give the --out folder of gapless bench") from error
    except (ValueError, TypeError) as error:
        raise ConfigError(f"{path}: not JSON ({error}); run gapless bench again") from error
    if missing:
        raise ConfigError(f"{path}: lacks {', '.join(missing)}; run gapless bench again")
    text = folder / "tables.txt"
    return Bench(
        facts,
        **{name: _columns(folder / f"{name}.parquet", wanted) for name, wanted in _WANTED.items()},
        tables=text.read_text("utf-8") if text.is_file() else "",
    )


def _columns(path: Path, wanted: tuple[str, ...]) -> Columns:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        table = pq.read_table(path)
    except FileNotFoundError as error:
        raise ConfigError(f"{path}: not there; run gapless bench again") from error
    except (OSError, pa.ArrowInvalid) as error:
        raise ConfigError(f"{path}: not Parquet ({error}); run gapless bench again") from error
    if not table.num_rows:  # one system has no pairs, and nothing to name their columns by
        return {name: np.array([]) for name in wanted}
    missing = [name for name in wanted if name not in table.column_names]
    if missing:
        raise ConfigError(f"{path}: lacks the columns {', '.join(missing)}; run gapless bench again")
    return {name: _array(table[name]) for name in wanted}


def _array(column: Any) -> Any:
    import pyarrow as pa

    kind = column.type
    if pa.types.is_dictionary(kind) or pa.types.is_string(kind) or pa.types.is_large_string(kind):
        told = column.cast(pa.string()).fill_null("").dictionary_encode().combine_chunks()
        words = np.array([*told.dictionary.to_pylist(), ""], dtype=object)
        return words[told.indices.to_numpy()]
    return column.cast(pa.float64()).fill_null(np.nan).to_numpy()


def groups(columns: Columns, keys: tuple[str, ...]) -> Iterator[tuple[tuple[Any, ...], Group]]:
    """Rows that agree in some columns.

    Parameters
    ----------
    columns : dict of str to ndarray
    keys : tuple of str

    Yields
    ------
    values : tuple
        Of the keys.
    rows : ndarray of int
        In their order in the file.
    """
    if not len(columns[keys[0]]):
        return
    codes = [_codes(columns[key]) for key in keys]
    order = np.lexsort(codes[::-1])
    table = np.column_stack(codes)[order]
    cuts = np.flatnonzero((table[1:] != table[:-1]).any(axis=1)) + 1
    for rows in np.split(order, cuts):
        yield tuple(columns[key][rows[0]] for key in keys), rows


def _codes(column: Any) -> Group:
    """A number for each different value of a column; of words in the order in which they come."""
    if column.dtype != object:
        return np.asarray(np.unique(column, return_inverse=True)[1], np.int64)
    import pyarrow as pa

    return np.asarray(pa.array(column.tolist(), pa.string()).dictionary_encode().indices.to_numpy(), np.int64)


def thinned(rows: Group, most: int) -> Group:
    """So many rows, evenly, the first and the last among them.

    Parameters
    ----------
    rows : ndarray of int
    most : int

    Returns
    -------
    ndarray of int
    """
    if len(rows) <= most:
        return rows
    kept: Group = rows[np.unique(np.linspace(0, len(rows) - 1, most).astype(int))]
    return kept


def number_or_none(value: float, digits: int = 4) -> float | None:
    """A number as JSON has it, to some significant digits.

    Parameters
    ----------
    value : float
    digits : int

    Returns
    -------
    float or None
        None where it is not finite.
    """
    return float(f"{value:.{digits}g}") if np.isfinite(value) else None


def pools_of(columns: Columns) -> list[str]:
    """Groups of outages that are one pool: those of a length, or of a plan; the shorter ones first.

    Parameters
    ----------
    columns : dict of str to ndarray
        Of `outages.parquet`.

    Returns
    -------
    list of str
    """
    lengths = dict(zip(columns["group"], columns["length"], strict=True))
    return sorted(lengths, key=lambda name: (not np.isfinite(lengths[name]), lengths[name], name))
