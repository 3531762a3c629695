"""A bench as a folder of files, complete or not there at all."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gapless.io.marks import MARK, marked
from gapless.laboratory.bench import Results
from gapless.laboratory.render import as_latex, as_markdown, as_text
from gapless.laboratory.rows import Block, Row
from gapless.laboratory.tables import tables
from gapless.version import __version__

if TYPE_CHECKING:
    import pyarrow as pa

Writers = dict[str, Callable[[Path], object]]
"""By file name: writes the file at a path."""
FILES: Final = (
    *("outages.parquet", "ages.parquet", "tracks.parquet", "runs.parquet", "leaderboard.parquet"),
    *("pairs.parquet", "tables.txt", "tables.md", "tables.tex", "tables.json", "bench.json"),
)
"""Their names."""


def writers(results: Results, arguments: Mapping[str, Any]) -> Writers:
    """What has to be written of a bench.

    Parameters
    ----------
    results : Results
    arguments : mapping
        Of the command, for `bench.json`.

    Returns
    -------
    dict of str to callable
        By file name; each writes its file at the path that it is given.
    """
    found = tables(results)
    return {
        "outages.parquet": partial(_parquet_rows, results.outages),
        "ages.parquet": partial(_parquet_blocks, results.ages),
        "tracks.parquet": partial(_parquet_blocks, results.tracks),
        "runs.parquet": partial(_parquet_rows, results.runs),
        "leaderboard.parquet": partial(_parquet_rows, results.leaderboard),
        "pairs.parquet": partial(_parquet_rows, results.pairs),
        "tables.txt": partial(_text, f"{as_text(found)}\n{MARK}\n"),
        "tables.md": partial(_text, f"<!-- {MARK} -->\n\n{as_markdown(found)}"),
        "tables.tex": partial(_text, f"% {MARK}\n{as_latex(found)}"),
        "tables.json": partial(
            _json, {"gapless": __version__, "leaderboard": results.leaderboard, "pairs": results.pairs}
        ),
        "bench.json": partial(_json, about(results, arguments)),
    }


def about(results: Results, arguments: Mapping[str, Any]) -> Row:
    """What `bench.json` says.

    Parameters
    ----------
    results : Results
    arguments : mapping

    Returns
    -------
    dict
    """
    scenarios = results.scenarios
    return {
        "gapless": __version__,
        "arguments": dict(arguments),
        "recordings": results.recordings,
        "systems": [
            {"name": m.name, "description": m.description, "causal": m.causal} for m in results.methods
        ],
        "protocols": list(results.protocols),
        "scenarios": [vars(s) for s in scenarios],
        "lengths": sorted({s.length for s in scenarios if math.isfinite(s.length)}),
        "shifts": sorted({s.shift for s in scenarios}),
        "outages": len(results.outages),
        "set_apart": results.apart,
        "prefix": results.checks,
        "seconds": results.seconds,
    }


def _text(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")


def _json(value: Any, path: Path) -> None:
    path.write_text(json.dumps(_plain(value), indent=1, ensure_ascii=False, allow_nan=False) + "\n", "utf-8")


def _plain(value: Any) -> Any:
    """NaN, which JSON does not know, becomes null."""
    if isinstance(value, Mapping):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _parquet_rows(rows: Sequence[Row], path: Path) -> None:
    import pyarrow as pa

    names = list(rows[0]) if rows else []
    _write(pa.table({name: [row[name] for row in rows] for name in names}), path)


def _parquet_blocks(blocks: Sequence[Block], path: Path) -> None:
    import pyarrow as pa

    names = list(blocks[0]) if blocks else []
    columns = {}
    for name in names:
        parts = [block[name] for block in blocks]
        numbers = any(isinstance(part, np.ndarray) for part in parts)
        columns[name] = np.concatenate(parts) if numbers else [text for part in parts for text in part]
    _write(pa.table(columns), path)


def _write(table: pa.Table, path: Path) -> None:
    import pyarrow.parquet as pq

    pq.write_table(marked(table), path, compression="zstd")
