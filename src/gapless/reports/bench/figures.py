"""Static figures of a bench, for papers; needs matplotlib."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from gapless.errors import MissingExtraError
from gapless.io.marks import MARK, check_ours
from gapless.io.writers.atomic import atomic
from gapless.reports.background import east_north
from gapless.reports.bench.folder import POOLED, Bench, groups, pools_of, read_bench
from gapless.trip.recording import Array
from gapless.units import DEG

_COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#4b545c")
_DASHES: Final = ("-", "--", ":", "-.")
_MARKS: Final = ("o", "s", "^", "D", "P", "X")
_ONE_COLUMN: Final = (3.5, 2.6)
"""Width and height [in] of a column of the usual journals."""
_DPI = 300
_AGES = 120
MADE_BY: Final = {"png": {"Software": MARK}, "pdf": {"Creator": MARK}}
"""Attributes by format: the mark of ours."""


def check_figures(folder: Path, suffix: str, force: bool) -> None:
    """Refuse to draw over figures that gapless did not draw.

    Parameters
    ----------
    folder : Path
        Where `gapless bench` wrote its results.
    suffix : str
    force : bool
        Let them be replaced.

    Raises
    ------
    ConfigError
        If there is one; or a file is missing or is not what a bench writes.
    """
    check_ours((_path(folder, name, suffix) for name, _ in _plans(read_bench(folder))), force)


def write_figures(folder: Path, suffix: str, force: bool = False) -> list[Path]:
    """Write tracks, leaderboards and errors against age into `figures` of a bench folder.

    Parameters
    ----------
    folder : Path
        Where `gapless bench` wrote its results.
    suffix : str
        "png" or "pdf".
    force : bool
        Replace figures that gapless did not draw.

    Returns
    -------
    list of Path
        Of the files.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    ConfigError
        If a file is missing or is not what a bench writes, or a figure there is not ours.
    """
    make = figure_class()
    written = []
    check_figures(folder, suffix, force)
    for name, draw in _plans(read_bench(folder)):
        figure = make(figsize=_ONE_COLUMN, layout="constrained")
        axes = figure.add_subplot()
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=8)
        draw(axes)
        path = _path(folder, name, suffix)
        with atomic(path) as temporary:
            figure.savefig(temporary, format=suffix, dpi=_DPI, metadata=MADE_BY[suffix])
        written.append(path)
    return written


def _path(folder: Path, name: str, suffix: str) -> Path:
    return folder / "figures" / f"{re.sub('[^a-zA-Z0-9._-]+', '-', name)}.{suffix}"


def figure_class() -> Callable[..., Any]:
    """Matplotlib's `Figure`, without its windows.

    Returns
    -------
    callable

    Raises
    ------
    MissingExtraError
        Where it is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtraError("matplotlib", "figures") from error
    made: Callable[..., Any] = Figure
    return made


def _plans(bench: Bench) -> Iterator[tuple[str, Callable[[Any], None]]]:
    """Name of each figure, and what draws it."""
    for recording in bench.recordings:
        yield f"track-{recording}", partial(_track, bench, recording)
    for protocol in bench.facts["protocols"]:
        yield f"leaderboard-{protocol}", partial(_leaderboard, bench, protocol)
        for group in pools_of(bench.outages):
            yield f"ages-{protocol}-{group}", partial(_ages, bench, protocol, group)


def _style(k: int) -> dict[str, Any]:
    return {"color": _COLOURS[k % len(_COLOURS)], "linestyle": _DASHES[k % len(_DASHES)]}


def _finish(axes: Any, x: str, y: str, note: str = "") -> None:
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.grid(alpha=0.25, linewidth=0.5)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize=7, frameon=False, title=note or None, title_fontsize=6.5)


def _track(bench: Bench, recording: str, axes: Any) -> None:
    """Truth from above, its outages thick."""
    table = bench.tracks
    known = np.isfinite(table["lat"]) & np.isfinite(table["lon"])
    rows = np.flatnonzero((table["kind"] == "truth") & (table["recording"] == recording) & known)
    if len(rows):
        rows = rows[np.argsort(table["time"][rows], kind="stable")]
        lla = np.column_stack([table["lat"][rows], table["lon"][rows], np.zeros(len(rows))]) * DEG
        time, xy = table["time"][rows], east_north(lla, lla[0]) / 1000.0
        axes.plot(*xy.T, color="#4b545c", linewidth=0.9, label="truth")
        outages = bench.outages
        mine = outages["recording"] == recording
        spans = sorted(set(zip(outages["start"][mine], outages["end"][mine], strict=True)))
        for k, (a, b) in enumerate(spans):
            inside = (time >= a) & (time <= b)
            label = None if k else "outages"
            axes.plot(*xy[inside].T, color=_COLOURS[1], linewidth=3.0, alpha=0.35, label=label)
    axes.set_aspect("equal", adjustable="datalim")
    _finish(axes, "east [km]", "north [km]")


def _leaderboard(bench: Bench, protocol: str, axes: Any) -> None:
    """Median and 95th percentile of every system by length, with their intervals."""
    table = bench.leaderboard
    pooled = (table["recording"] == POOLED) & (table["protocol"] == protocol)
    names = [name for name in pools_of(table) if (table["group"][pooled] == name).any()]
    for k, system in enumerate(bench.systems):
        rows = np.flatnonzero(pooled & (table["system"] == system))
        at = np.array([names.index(name) for name in table["group"][rows]], float) + 0.16 * (
            k - 0.5 * (len(bench.systems) - 1)
        )
        for key, face in (("median", None), ("p95", "white")):
            value = table[key][rows]
            reach = np.abs(np.vstack([table[f"{key}_lo"][rows], table[f"{key}_hi"][rows]]) - value)
            axes.errorbar(
                at,
                value,
                yerr=reach,
                fmt=_MARKS[k % len(_MARKS)],
                color=_COLOURS[k % len(_COLOURS)],
                markerfacecolor=face,
                markersize=4.5,
                linewidth=1.0,
                label=system if face is None else None,
            )
    axes.set_yscale("log")
    axes.set_xticks(range(len(names)), names)
    _finish(axes, "outages", "largest horizontal error [m]", "filled: median, open: P95")


def _ages(bench: Bench, protocol: str, group: str, axes: Any) -> None:
    """Median horizontal error against age, and thinly the 95th percentile."""
    table = bench.ages
    counted = _counted(bench, protocol, group)
    grid = np.linspace(0.0, max(counted.values(), default=0.0), _AGES)
    curves: dict[str, list[Array]] = {name: [] for name in bench.systems}
    for key, rows in groups(table, ("recording", "protocol", "scenario", "start", "system")):
        if key[:4] in counted and key[4] in curves:
            rows = rows[np.argsort(table["age"][rows], kind="stable")]
            age, error = table["age"][rows], table["horizontal"][rows]
            curves[key[4]].append(np.interp(grid, age, error, left=np.nan, right=np.nan))
    for k, (system, found) in enumerate(curves.items()):
        if not found:
            continue
        block = np.array(found)
        told = np.isfinite(block).any(axis=0)
        middle, high = np.nanpercentile(block[:, told], [50.0, 95.0], axis=0)
        axes.plot(grid[told], middle, linewidth=1.5, label=system, **_style(k))
        axes.plot(grid[told], high, linewidth=0.6, alpha=0.8, **_style(k))
    axes.set_yscale("log")
    _finish(axes, "age of the outage [s]", "horizontal error [m]", "thick: median, thin: P95")


def _counted(bench: Bench, protocol: str, group: str) -> dict[tuple[Any, ...], float]:
    """Outages of a pool that no label sets apart, and how long each lasts [s]."""
    table = bench.outages
    rows = np.flatnonzero(
        (table["protocol"] == protocol) & (table["group"] == group) & (table["labels"] == "")
    )
    columns = [table[name][rows] for name in ("recording", "protocol", "scenario", "start")]
    lasting = table["end"][rows] - table["start"][rows]
    return dict(zip(zip(*columns, strict=True), lasting.tolist(), strict=True))
