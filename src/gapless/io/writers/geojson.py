"""Solution as GeoJSON (RFC 7946)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import cut, runs, solution_columns
from gapless.trip.recording import Array
from gapless.trip.solution import Solution
from gapless.version import __version__


def write_geojson(solution: Solution, path: Path) -> None:
    """Write one line per stretch of one source, cut where it crosses 180 degrees (RFC 7946, 3.1.9).

    Each feature says its `source`, `start` and `end` [s, IMU clock], whether it lies in a withheld
    `outage`, and `sd_horizontal_end` [m], the larger horizontal standard deviation at its end.

    Parameters
    ----------
    solution : Solution
    path : Path
    """
    features = [_feature(solution, source, rows) for source, rows in runs(solution)]
    collection = {
        "gapless": __version__,  # a foreign member, which RFC 7946 allows
        "type": "FeatureCollection",
        "name": solution.name,
        "features": features,
    }
    with atomic(path) as temporary:
        temporary.write_text(json.dumps(collection, allow_nan=False), "utf-8")


def _feature(solution: Solution, source: str, rows: slice) -> dict[str, Any]:
    columns = solution_columns(solution)
    time = columns["time"][rows]
    lines = [
        _line(part) for part in cut(np.column_stack([columns[n][rows] for n in ("lon", "lat", "height")]))
    ]
    geometry = (
        {"type": "LineString", "coordinates": lines[0]}
        if len(lines) == 1
        else {"type": "MultiLineString", "coordinates": lines}
    )
    sd = float(max(columns["sd_north"][rows][-1], columns["sd_east"][rows][-1]))
    return {
        "type": "Feature",
        "geometry": geometry,
        "properties": {
            "source": source,
            "start": float(time[0]),
            "end": float(time[-1]),
            "outage": bool(solution.in_outage(time[-1:])[0]),
            "sd_horizontal_end": round(sd, 3) if sd == sd else None,
        },
    }


def _line(points: Array) -> list[list[float]]:
    return [[lon, lat, round(height, 3)] for lon, lat, height in points.round(9).tolist()]
