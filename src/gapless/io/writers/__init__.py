"""Formats that are written. To add one: a file with a function, and a line in `WRITERS`."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gapless.errors import ConfigError
from gapless.io.marks import check_ours
from gapless.io.writers.csv import write_csv
from gapless.io.writers.geojson import write_geojson
from gapless.io.writers.gpx import write_gpx
from gapless.io.writers.kml import write_kml
from gapless.io.writers.parquet import write_parquet
from gapless.trip.solution import Solution


@dataclass(frozen=True)
class Writer:
    """One format that solutions are written in.

    Parameters
    ----------
    description : str
        One line for the user.
    write : callable
        Takes a solution and a path; writes the file whole or not at all.
    """

    description: str
    write: Callable[[Solution, Path], None]


WRITERS: Final[dict[str, Writer]] = {
    "parquet": Writer("every column, for pandas, Polars, DuckDB", write_parquet),
    "csv": Writer("every column, as text", write_csv),
    "kml": Writer("the track by source, for Google Earth", write_kml),
    "geojson": Writer("the track by source, for web maps and GIS", write_geojson),
    "gpx": Writer("the track, for outdoor tools", write_gpx),
}
"""By suffix."""


def write(solution: Solution, path: str | os.PathLike[str], force: bool = False) -> None:
    """Write a solution in the format that the path's suffix names.

    Parameters
    ----------
    solution : Solution
    path : str or path
        Its folder is made if it is not there; a file of ours that is there is replaced, once the
        new one is complete.
    force : bool
        Replace what is there, whoever wrote it.

    Raises
    ------
    ConfigError
        If no writer has that suffix, or a file is there that gapless did not write.
    """
    path = Path(path)
    writer = WRITERS.get(path.suffix.lstrip(".").lower())
    if writer is None:
        raise ConfigError(f"{path}: no writer for it; name the file .{', .'.join(WRITERS)}")
    check_ours([path], force, cure="force=True")
    writer.write(solution, path)
