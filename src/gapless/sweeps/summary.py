"""What a study has found, system by system."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Any, Final

from gapless.evaluation import spread

_FIGURES: Final = ("horizontal_max_median", "horizontal_max_p95", "horizontal_max_worst", "coverage_95")
COLUMNS: Final = ("outcome", "system", "override", "outages", "apart", *_FIGURES)
"""Of the runs, that a summary looks at."""


@dataclass(frozen=True)
class Line:
    """One system with one override, over its runs.

    Parameters
    ----------
    system, override : str
    runs, refused, failed : int
    outages : int
        That count.
    median, p95, worst : float
        Median over runs of a run's median, 95th percentile and worst of the outages' largest
        horizontal errors [m].
    coverage_95 : float
        Median over runs of the share inside the stated 95 % ellipses.
    """

    system: str
    override: str
    runs: int
    refused: int
    failed: int
    outages: int
    median: float
    p95: float
    worst: float
    coverage_95: float


def summary(runs: Any, keys: Container[str]) -> list[Line]:
    """Medians over the runs of each system and override.

    Parameters
    ----------
    runs : pyarrow.Table
        With the key and `COLUMNS`, as `read` gives them.
    keys : container of str
        Of the runs that are meant; a store may hold more, of an earlier version of the study.

    Returns
    -------
    list of Line
        In order of their names.
    """
    rows = [row for row in runs.to_pylist() if row["key"] in keys]
    names = itemgetter("system", "override")
    return [_line(list(part)) for _, part in groupby(sorted(rows, key=names), names)]


def _line(rows: list[dict[str, Any]]) -> Line:
    outcomes = [row["outcome"] for row in rows]
    return Line(
        rows[0]["system"],
        rows[0]["override"],
        len(rows),
        outcomes.count("refused"),
        outcomes.count("failed"),
        sum(row["outages"] - row["apart"] for row in rows),
        *(spread(row[name] for row in rows).median for name in _FIGURES),
    )
