"""Solution as CSV."""

from __future__ import annotations

from pathlib import Path

from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import solution_columns
from gapless.trip.solution import Solution

_FORMATS = {"time": "%.6f", "lat": "%.10f", "lon": "%.10f", "height": "%.4f"}
"""Digits: 1 us, 0.01 mm, 0.1 mm; 1e-6 of its unit for anything else."""


def write_csv(solution: Solution, path: Path) -> None:
    """Write the columns of `solution_columns` and `source` as text; an unknown value is empty.

    Parameters
    ----------
    solution : Solution
    path : Path
    """
    columns = solution_columns(solution)
    row = ",".join(_FORMATS.get(name, "%.6f") for name in columns) + ",%s\n"
    values = zip(*(column.tolist() for column in columns.values()), solution.trajectory.source, strict=True)
    with atomic(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join([*columns, "source"]) + "\n")
        for line in values:
            file.write((row % line).replace("nan", ""))
