"""Solution as Parquet."""

from __future__ import annotations

from pathlib import Path

from gapless.io.marks import marked
from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import arrow_table, solution_columns
from gapless.trip.solution import Solution


def write_parquet(solution: Solution, path: Path) -> None:
    """Write every column of `solution_columns`, and `source` as a dictionary of strings.

    Parameters
    ----------
    solution : Solution
    path : Path
    """
    import pyarrow.parquet as pq

    table = marked(arrow_table(solution_columns(solution), solution.trajectory.source))
    with atomic(path) as temporary:
        pq.write_table(table, temporary, compression="zstd", use_dictionary=["source"])
