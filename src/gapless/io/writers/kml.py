"""Solution as KML (OGC 07-147r2)."""

from __future__ import annotations

from pathlib import Path
from typing import Final
from xml.sax.saxutils import escape

import numpy as np

from gapless.io.marks import MARK
from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import cut, runs, solution_columns
from gapless.trip.recording import Array
from gapless.trip.solution import Solution

COLOURS: Final = {
    "gnss": "ffb4771f",
    "bridge": "ff2ca02c",
    "constraints": "ff0e7fff",
    "ins": "ff2827d6",
    "reference": "ff7f7f7f",
}
"""Line colour by source, as KML writes it: opacity, blue, green, red."""


def write_kml(solution: Solution, path: Path) -> None:
    """Write one line per stretch of one source, in that source's colour.

    Lines are cut where they cross 180 degrees. They lie on the ground: KML counts heights from the geoid,
    ours are above the ellipsoid.

    Parameters
    ----------
    solution : Solution
    path : Path
    """
    columns = solution_columns(solution)
    points = np.column_stack([columns[name] for name in ("lon", "lat", "height")])
    styles = "".join(
        f'<Style id="{source}"><LineStyle><color>{colour}</color><width>4</width></LineStyle></Style>\n'
        for source, colour in COLOURS.items()
    )
    parts = [
        f'<?xml version="1.0" encoding="UTF-8"?>\n<!-- {MARK} -->\n'
        '<kml xmlns="http://www.opengis.net/kml/2.2"><Document>\n'
    ]
    parts.append(f"<name>{clean(solution.name)}</name>\n{styles}")
    for source, rows in runs(solution):
        start, end = (solution.trajectory.time[rows][i] - solution.start for i in (0, -1))
        lines = [_line(part) for part in cut(points[rows])]
        drawn = lines[0] if len(lines) == 1 else f"<MultiGeometry>{''.join(lines)}</MultiGeometry>"
        parts.append(
            f"<Placemark><name>{clean(source)} {start:.1f} to {end:.1f} s</name>"
            f"<styleUrl>#{clean(source)}</styleUrl>{drawn}</Placemark>\n"
        )
    with atomic(path) as temporary:
        temporary.write_text("".join([*parts, "</Document></kml>\n"]), "utf-8")


def _line(points: Array) -> str:
    coordinates = " ".join("{:.9f},{:.9f},{:.3f}".format(*point) for point in points.tolist())
    return f"<LineString><tessellate>1</tessellate><coordinates>{coordinates}</coordinates></LineString>"


def clean(text: str) -> str:
    """Text that XML 1.0 can hold: markup escaped, control characters gone.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    return escape(
        "".join(
            c
            for c in text
            if c in "\t\n" or (c >= " " and not "\ud800" <= c <= "\udfff" and c not in "\ufffe\uffff")
        )
    )
