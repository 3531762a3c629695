"""Solution as GPX 1.1."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

from gapless.io.marks import MARK
from gapless.io.writers.atomic import atomic
from gapless.io.writers.kml import clean
from gapless.io.writers.table import solution_columns
from gapless.trip.solution import Solution


def write_gpx(solution: Solution, path: Path, epoch: datetime | None = None) -> None:
    """Write the track as one segment, without a break.

    Parameters
    ----------
    solution : Solution
    path : Path
    epoch : datetime, optional
        UTC at which the recording's clock reads zero; without it the points carry no time.
    """
    columns = solution_columns(solution)
    parts = [
        f'<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="{MARK}" '
        f'xmlns="http://www.topografix.com/GPX/1/1"><trk><name>{clean(solution.name)}</name><trkseg>\n'
    ]
    rows = zip(*(columns[name].tolist() for name in ("time", "lat", "lon", "height")), strict=True)
    for time, lat, lon, height in rows:
        stamp = "" if epoch is None else f"<time>{_iso(epoch + timedelta(seconds=time))}</time>"
        parts.append(f'<trkpt lat="{lat:.9f}" lon="{lon:.9f}"><ele>{height:.3f}</ele>{stamp}</trkpt>\n')
    with atomic(path) as temporary:
        temporary.write_text("".join([*parts, "</trkseg></trk></gpx>\n"]), "utf-8")


def _iso(moment: datetime) -> str:
    return moment.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
