"""The charts of the page: which series, in which unit, over which range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from gapless.evaluation import Scores
from gapless.reports.decimate import POINTS, Stretch, envelope, scatter
from gapless.reports.pack import packed, packed_times
from gapless.reports.quantities import Quantity, channel, state
from gapless.trip.recording import Array
from gapless.trip.solution import Innovations, Solution
from gapless.units import DEG

Range = tuple[float, float]
_AROUND = 0.25
"""How much before and after an outage is shown in its detail, in its lengths."""


def charts(solution: Solution, scores: Scores | None) -> list[dict[str, Any]]:
    """Every chart, in the order of the page.

    Parameters
    ----------
    solution : Solution
    scores : Scores, optional

    Returns
    -------
    list of dict
        JSON-able: `group`, `title`, `unit`, `range`, `log`, `dots`, `gap` (longest step that a line
        may cross, s), packed `t`, and `series`, each with `name`, packed `y` and, if it has one, half
        a `band`.
    """
    found: list[dict[str, Any]] = []
    if scores is not None and np.isfinite(scores.errors.horizontal).any():
        found += _error_charts(scores, solution.start)
    found += _motion_charts(solution)
    found += _sd_charts(solution)
    for name, values in solution.states.items():
        found.append(_state_chart(solution, name, values))
    for name, one in solution.innovations.items():
        if len(one):
            found += _innovation_charts(name, one, solution.start)
    return [decimated(one, focus(solution)) for one in found]


def focus(solution: Solution) -> list[Stretch]:
    """Stretches that are shown finer: the outages and what is around them.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    list of (float, float)
        Seconds after the first IMU sample.
    """
    return [(a - _AROUND * (b - a), b + _AROUND * (b - a)) for a, b in solution.outages]


def chart(
    group: str,
    title: str,
    unit: str,
    time: Array,
    series: Sequence[tuple[str, Array]],
    bands: Array | None = None,
    **more: Any,
) -> dict[str, Any]:
    """One chart, as it is handed to `decimated`.

    Parameters
    ----------
    group, title, unit : str
    time : ndarray, shape (n,)
        [s]
    series : sequence of (str, ndarray)
        Names and values, shape (n,).
    bands : ndarray, shape (n, len(series)), optional
        Half widths.
    **more : object
        Further entries, see `charts`.

    Returns
    -------
    dict
    """
    return {
        "group": group,
        "title": title,
        "unit": unit,
        "range": list(more.pop("range", None) or extent(np.column_stack([y for _, y in series]), bands)),
        "log": False,
        "dots": False,
        "t": time,
        "series": series,
        "bands": bands,
        **more,
    }


def decimated(one: dict[str, Any], finer: Sequence[Stretch]) -> dict[str, Any]:
    """A chart with as many rows as are embedded, packed.

    Parameters
    ----------
    one : dict
        From `chart`.
    finer : sequence of (float, float)
        Stretches that are shown finer [s].

    Returns
    -------
    dict
        See `charts`.
    """
    time, series, bands = one["t"], one["series"], one.pop("bands")
    columns = np.column_stack([y for _, y in series])
    table = columns if bands is None else np.column_stack([columns, bands])
    if one["dots"]:
        rows = scatter(np.abs(columns).max(axis=1))
        t, table = time[rows], table[rows]
    else:
        t, table = envelope(time, table, POINTS, finer)
    drawn: list[dict[str, Any]] = [
        {"name": name, "y": packed(table[:, i])} for i, (name, _) in enumerate(series)
    ]
    if bands is not None:
        for i, line in enumerate(drawn):
            line["band"] = packed(table[:, len(series) + i])
    step = float(np.median(np.diff(time))) if len(time) > 1 else 1.0
    widest = step * max(1.0, 2.0 * len(time) / max(len(t), 1))
    gap = round(max(2.0, 4.0 * widest), 2)
    return {"gap": gap} | one | {"t": packed_times(t), "series": drawn}


def extent(columns: Array, bands: Array | None = None) -> Range:
    """Range that shows all but what would flatten the rest.

    Parameters
    ----------
    columns : ndarray, shape (n, k)
    bands : ndarray, shape (n, k), optional
        Half widths; their median belongs into the range.

    Returns
    -------
    low, high : float
    """
    x = columns[np.isfinite(columns)]
    if not len(x):
        return 0.0, 1.0
    low, high = float(x.min()), float(x.max())
    a, b = (float(q) for q in np.percentile(x, [0.2, 99.8]))
    room = max(b - a, 1e-12)
    if high - low > 3.0 * room:
        low, high = max(low, a - 0.5 * room), min(high, b + 0.5 * room)
    if bands is not None and (np.isfinite(bands) & np.isfinite(columns)).any():
        some = np.isfinite(bands).any(axis=0) & np.isfinite(columns).any(axis=0)
        half, middle = np.nanmedian(bands[:, some], axis=0), np.nanmedian(columns[:, some], axis=0)
        low, high = min(low, float(np.nanmin(middle - half))), max(high, float(np.nanmax(middle + half)))
    pad = 0.06 * (high - low) or 0.5 * abs(high) or 1.0
    return low - pad, high + pad


def _error_charts(scores: Scores, start: float) -> Iterator[dict[str, Any]]:
    e = scores.errors
    t, size, bound = e.time - start, e.horizontal, e.bound()
    title = "Horizontal error" if scores.truth == "reference" else "Horizontal distance to the fixes"
    worst = float(np.nanmax(size))
    top = (
        worst
        if not np.isfinite(bound).any()
        else max(worst, min(float(np.nanpercentile(bound, 99.0)), 2.0 * worst))
    )
    yield chart(
        "Errors",
        title,
        "m",
        t,
        [(title.split(" ")[1], size), ("95 % bound", bound)],
        range=(0.0, 1.06 * top or 1.0),
        area=1,
        wide=True,
        note="The shaded area is the error that the filter itself expects: the line should stay "
        "in it 95 % of the time.",
    )
    if np.isfinite(e.along).any():
        yield chart("Errors", "Along and across the course", "m", t, [("along", e.along), ("cross", e.cross)])
    down = -e.position[:, 2] - (scores.height_offset if np.isfinite(scores.height_offset) else 0.0)
    yield chart("Errors", "Height error", "m", t, [("up", down)])
    if np.isfinite(e.attitude).any():
        names = ("roll", "pitch", "heading")
        series = [(name, e.attitude[:, k] / DEG) for k, name in enumerate(names)]
        yield chart("Errors", "Attitude error", "deg", t, series)
    if np.isfinite(e.velocity[:, :2]).any():
        series = [(name, e.velocity[:, k]) for k, name in enumerate(("north", "east"))]
        yield chart("Errors", "Velocity error", "m/s", t, series)


def _motion_charts(solution: Solution) -> Iterator[dict[str, Any]]:
    t = solution.trajectory
    time = t.time - solution.start
    speed = np.hypot(t.v_n[:, 0], t.v_n[:, 1])
    yield chart("Motion", "Speed", "m/s", time, [("speed", speed)])
    heading = np.where(np.isfinite(t.euler[:, 2]), t.euler[:, 2] / DEG % 360.0, np.nan)
    yield chart("Motion", "Heading", "deg", time, [("heading", heading)], range=(0.0, 360.0), wrap=360.0)
    tilt = [("roll", t.euler[:, 0] / DEG), ("pitch", t.euler[:, 1] / DEG)]
    yield chart("Motion", "Roll and pitch", "deg", time, tilt)


def _sd_charts(solution: Solution) -> Iterator[dict[str, Any]]:
    t = solution.trajectory
    time = t.time - solution.start
    parts = (
        ("Position", "m", 0, 1.0, ("north", "east", "down")),
        ("Velocity", "m/s", 3, 1.0, ("north", "east", "down")),
        ("Attitude", "deg", 6, DEG, ("roll", "pitch", "heading")),
    )
    for title, unit, first, scale, names in parts:
        sd = np.where(t.sd[:, first : first + 3] > 0.0, t.sd[:, first : first + 3] / scale, np.nan)
        known = sd[np.isfinite(sd)]
        if len(known):
            limits = (0.8 * float(known.min()), 1.25 * float(known.max()))
            series = [(name, sd[:, k]) for k, name in enumerate(names)]
            yield chart("Standard deviations", title, unit, time, series, range=limits, log=True)


def _state_chart(solution: Solution, name: str, values: Array) -> dict[str, Any]:
    shown = state(name, values.shape[1])
    sd = solution.states_sd.get(name)
    series = [(axis, values[:, k] / shown.scale) for k, axis in enumerate(shown.axes)]
    bands = None if sd is None else sd / shown.scale
    time = solution.trajectory.time - solution.start
    return chart("States", shown.label, shown.unit, time, series, bands)


def _innovation_charts(name: str, one: Innovations, start: float) -> Iterator[dict[str, Any]]:
    first = 0
    for part in channel(name, one.z.shape[1]):
        columns = slice(first, first + len(part.axes))
        first = columns.stop
        yield _innovation_chart(part, one.time - start, one.z[:, columns], one.sd[:, columns], one.factor)


def _innovation_chart(part: Quantity, time: Array, z: Array, sd: Array, factor: Array) -> dict[str, Any]:
    z, sd = z / part.scale, sd / part.scale
    used = np.abs(z[np.isfinite(factor)])
    used = used[np.isfinite(used)]
    typical = float(np.nanmedian(sd)) if np.isfinite(sd).any() else 1.0
    half = 1.1 * max(3.0 * typical, float(np.percentile(used, 99.5)) if len(used) else 0.0)
    series = [(axis, z[:, k]) for k, axis in enumerate(part.axes)]
    return chart("Innovations", part.label, part.unit, time, series, sd, range=(-half, half), dots=True)
