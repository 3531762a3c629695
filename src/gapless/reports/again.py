"""The page of a run made again from the files that it left: what they hold, and no more."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gapless.errors import ConfigError
from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import SD_COLUMNS
from gapless.reports.background import Feature
from gapless.reports.numbers import known
from gapless.reports.report import page
from gapless.trip.recording import Array, Trajectory
from gapless.trip.solution import Solution
from gapless.units import DEG

LEFT_OUT = "errors, biases and innovations over time, fixes, reference and ellipses"
"""What a run's own page shows that its other files do not hold."""


def is_run(folder: Path) -> bool:
    """Whether a folder looks like one of `gapless fuse`.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    bool
    """
    return (folder / "solution.parquet").is_file() and (folder / "summary.json").is_file()


def write_again(folder: Path, background: Sequence[Feature] = (), force: bool = False) -> Path:
    """Write `report.html` from `solution.parquet` and `summary.json`.

    Parameters
    ----------
    folder : Path
        Where `gapless fuse` wrote its files.
    background : sequence of Feature
    force : bool
        Replace the page that is there.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    ConfigError
        If a page is there, which the run itself wrote with more in it; or if a file is not the run's.
    """
    path = folder / "report.html"
    if path.exists() and not force:
        raise ConfigError(
            f"{path}: is there, and a page made of solution.parquet and summary.json would lack {LEFT_OUT}; "
            "remove it first, replace it with --force, or run gapless fuse again"
        )
    try:
        summary = json.loads((folder / "summary.json").read_text("utf-8"))
        solution = _solution(_columns(folder / "solution.parquet"), summary)
        text = page(solution, None, None, summary, background)
    except (KeyError, ValueError, TypeError, IndexError) as error:
        raise ConfigError(
            f"{folder}: solution.parquet and summary.json are not of one run of gapless fuse ({error!r}); "
            "run it again"
        ) from error
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


def _columns(path: Path) -> dict[str, Any]:
    import pyarrow.parquet as pq

    table = pq.read_table(path)
    found: dict[str, Any] = {n: table[n].to_numpy() for n in table.column_names if n != "source"}
    found["source"] = np.array(table["source"].to_pylist(), dtype=str)
    return found


def _solution(columns: Mapping[str, Any], summary: Mapping[str, Any]) -> Solution:
    def stack(names: Sequence[str], scale: Array) -> Array:
        return np.column_stack([columns[name] for name in names]) * scale

    if len(columns["time"]) != summary["rows"]:
        raise ValueError("different numbers of rows")
    degrees = np.array([DEG, DEG, 1.0])
    trajectory = Trajectory(
        columns["time"],
        stack(("lat", "lon", "height"), degrees),
        stack(("v_north", "v_east", "v_down"), np.ones(3)),
        stack(("roll", "pitch", "heading"), np.full(3, DEG)),
        stack(SD_COLUMNS, np.repeat([1.0, 1.0, DEG], 3)),
        np.full(len(columns["time"]), np.nan),
        columns["source"],
    )
    return Solution(
        name=summary["name"],
        system=summary["system"],
        trajectory=trajectory,
        states={},
        states_sd={},
        innovations={},
        decisions=(),
        outages=tuple((one["start"], one["end"]) for one in summary["outages"]),
        start=known(summary["start"]),
    )
