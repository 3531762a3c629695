"""What the page draws, decimated to what a screen shows: the track and the charts over time.

Times are seconds after the first IMU sample, the track is in metres east and north of its middle.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from gapless.evaluation import Scores, chi_square_quantile
from gapless.evaluation.errors import gnss_truth
from gapless.reports.background import Feature, east_north, placed
from gapless.reports.charts import charts, decimated, focus
from gapless.reports.decimate import POINTS, simplify
from gapless.reports.pack import rounded
from gapless.scenarios import Outage, withheld
from gapless.trip.recording import Array, Recording, Trajectory
from gapless.trip.solution import Solution

_ELLIPSES = 24
"""Ellipses drawn along one outage."""
_FIXES = 3000
_COASTING = 3.0
"""Stretches without GNSS shorter than this [s] are the rhythm of the receiver, not an outage."""


def payload(
    solution: Solution,
    recording: Recording | None,
    scores: Scores | None,
    background: Sequence[Feature] = (),
    exhibits: Iterable[dict[str, Any]] = (),
) -> dict[str, Any]:
    """Data of the page's scripts.

    Parameters
    ----------
    solution : Solution
    recording : Recording, optional
        Its fixes and its reference are drawn.
    scores : Scores, optional
    background : sequence of Feature
        Drawn beneath the track.
    exhibits : iterable of dict
        Charts of further sections, from `chart`.

    Returns
    -------
    dict
        JSON-able; arrays are lists of rounded numbers, None where unknown.
    """
    drawn = [*charts(solution, scores), *(decimated(one, focus(solution)) for one in exhibits)]
    end = float(solution.trajectory.time[-1]) - solution.start
    return {
        "span": [rounded(solution.trajectory.time[:1] - solution.start, 2)[0], round(end, 2)],
        "outages": [[round(a, 3), round(b, 3)] for a, b in solution.outages],
        "track": _track(solution, recording, scores, background),
        "times": _shared_times(drawn),
        "charts": drawn,
        "embedded": _embedded(solution),
    }


def _embedded(solution: Solution) -> str:
    """What of the solution's rows is on the page, for its reader."""
    n = len(solution.trajectory)
    if n <= POINTS:
        return f"Charts show all {n} rows of the solution."
    finer = ", half of them in and around the outages" if solution.outages else ""
    return (
        f"Charts hold the extremes of the solution's {n} rows in about {POINTS} points{finer}; "
        "every row is in solution.parquet."
    )


def _shared_times(drawn: list[dict[str, Any]]) -> list[str]:
    """Times of all charts, each once; `t` of a chart becomes the index of its own."""
    times: list[str] = []
    for one in drawn:
        if one["t"] not in times:
            times.append(one["t"])
        one["t"] = times.index(one["t"])
    return times


def _track(
    solution: Solution, recording: Recording | None, scores: Scores | None, background: Sequence[Feature]
) -> dict[str, Any]:
    t = solution.trajectory
    start = solution.start
    origin = t.lla[len(t) // 2]
    track = path(t, origin, start)
    offset = 0.0 if scores is None else scores.clock_offset
    reference = None if recording is None else recording.reference
    return {
        **track,
        "coasting": [[round(a - start, 2), round(b - start, 2)] for a, b in coasting(solution)],
        "fixes": _fixes(solution, recording, origin),
        "reference": None if reference is None else path(reference, origin, start - offset),
        "ellipses": _ellipses(solution, origin),
        "background": placed(background, t.lla),
    }


def _fixes(solution: Solution, recording: Recording | None, origin: Array) -> list[dict[str, Any]]:
    """Fixes that were used, and those that were withheld."""
    if recording is None:
        return [{"t": [], "x": [], "y": []}] * 2
    fixes, start = gnss_truth(recording.gnss), solution.start
    chosen = fixes.take(
        np.unique(np.linspace(0, len(fixes) - 1, _FIXES).astype(int)) if len(fixes) else slice(0)
    )
    away = withheld(chosen.time, [Outage(a, b) for a, b in solution.outages], start)
    return [path(chosen.take(m), origin, start, whole=True) for m in (~away, away)]


def path(t: Trajectory, origin: Array, start: float, whole: bool = False) -> dict[str, Any]:
    """A path as a map draws it.

    Parameters
    ----------
    t : Trajectory
    origin : ndarray, shape (3,)
        Latitude, longitude [rad], height [m] of x = y = 0.
    start : float
        Its time zero [s].
    whole : bool
        Keep every row, not only those that shape it.

    Returns
    -------
    dict
        `t` [s], `x` east, `y` north [m].
    """
    t = t.take(np.isfinite(t.lla[:, :2]).all(axis=1))
    xy = east_north(t.lla, origin)
    if not whole:
        rows = simplify(t.time, xy)
        t, xy = t.take(rows), xy[rows]
    return {
        "t": rounded(t.time - start, 2),
        "x": rounded(xy[:, 0], 2),
        "y": rounded(xy[:, 1], 2),
    }


def coasting(solution: Solution) -> list[tuple[float, float]]:
    """Stretches that the solution spent without GNSS, whoever took it away.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    list of (float, float)
        IMU times [s] of runs of 3 s or more.
    """
    t = solution.trajectory
    alone = (t.source != "gnss") | solution.in_outage(t.time)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], alone, [False]]).astype(int)))
    runs = ((float(t.time[a]), float(t.time[b - 1])) for a, b in edges.reshape(-1, 2))
    return [(a, b) for a, b in runs if b - a >= _COASTING]


def _ellipses(solution: Solution, origin: Array) -> list[list[float | None]]:
    """Rows of t, x, y, semi-major axis, semi-minor axis, direction of the major axis from east."""
    t = solution.trajectory
    rows = []
    for a, b in solution.outages:
        lo, hi = np.searchsorted(t.time - solution.start, [a, b])
        if hi > lo:
            rows.append(np.unique(np.linspace(lo, hi - 1, _ELLIPSES).astype(int)))
    if not rows:
        return []
    chosen = t.take(np.concatenate(rows))
    chosen = chosen.take(np.isfinite(chosen.sd[:, :2]).all(axis=1) & np.isfinite(chosen.horizontal))
    covariance = np.empty((len(chosen), 2, 2))
    covariance[:, 0, 0], covariance[:, 1, 1] = chosen.sd[:, 1] ** 2, chosen.sd[:, 0] ** 2
    covariance[:, 0, 1] = covariance[:, 1, 0] = chosen.horizontal
    size, direction = np.linalg.eigh(covariance)
    axes = np.sqrt(chi_square_quantile(0.95, 2) * np.maximum(size[:, ::-1], 0.0))
    angle = np.arctan2(direction[:, 1, 1], direction[:, 0, 1])
    xy = east_north(chosen.lla, origin)
    table = np.column_stack([chosen.time - solution.start, xy, axes, angle])
    return [rounded(row, 3) for row in table]
