"""Leaderboard and pairs as tables; each names its protocol."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from gapless.laboratory.bench import Results
from gapless.laboratory.boards import POOLED
from gapless.laboratory.rows import Row
from gapless.laboratory.study import PROTOCOLS

NOT_CAUSAL: Final = "*"
"""Marks a system that is declared not causal."""
_NOTE: Final = (
    "Largest horizontal error of each outage, m; in brackets 95 % intervals (block bootstrap: neighbouring "
    "and overlapping outages are drawn together). No resample is worse than the worst there was."
)
_STAR: Final = f"{NOT_CAUSAL} not causal: it sees what comes after; a bound, not a competitor."


class Table(NamedTuple):
    """A table with words around it.

    Parameters
    ----------
    title : str
    head : tuple of str
    rows : tuple of tuple of str
    note : str
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def tables(results: Results) -> list[Table]:
    """All tables of a bench.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Table
    """
    marks = {m.name: m.name + NOT_CAUSAL * (not m.causal) for m in results.methods}
    star = _STAR if any(not m.causal for m in results.methods) else ""
    found = []
    for protocol in results.protocols:
        told = f"{protocol} ({PROTOCOLS[protocol]})"
        board = [row for row in results.leaderboard if row["protocol"] == protocol]
        pooled = [row for row in board if row["recording"] == POOLED]
        if not pooled:
            continue
        found.append(_board(f"Protocol {told}", pooled, marks, f"{_NOTE} {star}".strip()))
        found += _pairs(results, protocol, marks)
        apart = [row for row in results.apart if row["protocol"] == protocol]
        if apart:
            found.append(_apart(protocol, apart, marks))
        found += _by_recording(protocol, [row for row in board if row["recording"] != POOLED], marks)
    return [*found, _checks(results, marks)]


def _board(title: str, rows: Sequence[Row], marks: dict[str, str], note: str = "") -> Table:
    head = ("outages", "system", "n", "median", "P90", "RMS", "P95", "worst", "in 50/95/99 %", "left out")
    cells = tuple(
        (
            row["group"],
            marks[row["system"]],
            str(row["n"]),
            _span(row, "median"),
            _metres(row["p90"]),
            _span(row, "rms"),
            _span(row, "p95"),
            _span(row, "worst"),
            "/".join(_percent(row[f"coverage_{c}"]) for c in (50, 95, 99)),
            str(row["left_out"]),
        )
        for row in rows
    )
    return Table(title, head, cells, note)


def _pairs(results: Results, protocol: str, marks: dict[str, str]) -> list[Table]:
    rows = [r for r in results.pairs if r["protocol"] == protocol and r["recording"] == POOLED]
    if not rows:
        return []
    head = (
        "outages",
        "system",
        "n",
        "median",
        "geometric mean",
        "better",
        "worst",
        "p",
        "p corrected",
        "says",
    )
    cells = tuple(
        (
            row["group"],
            marks[row["system"]],
            str(row["n"]),
            _ratio(row["median_ratio"]),
            f"{_ratio(row['geometric'])} [{_ratio(row['geometric_lo'])}, {_ratio(row['geometric_hi'])}]",
            f"{_percent(row['better'])} %",
            _ratio(row["worst_ratio"]),
            _p(row["p"]),
            _p(row["p_corrected"]),
            _verdict(row),
        )
        for row in rows
    )
    note = (
        "Ratios of errors on the same outages, below 1 where the system is better; p of Wilcoxon's "
        "signed-rank test on their logarithms, neighbouring outages voting together, corrected (Holm) for "
        "the number of systems."
    )
    return [Table(f"Against {marks[results.methods[0].name]}, protocol {protocol}", head, cells, note)]


def _verdict(row: Row) -> str:
    if not row["p_corrected"] < 0.05:
        return "no difference shown"
    return "better" if row["geometric"] < 1.0 else "WORSE"


def _apart(protocol: str, rows: Sequence[Row], marks: dict[str, str]) -> Table:
    cells = tuple(
        (row["group"], marks[row["system"]], row["label"], str(row["n"]), _metres(row["median"]))
        for row in rows
    )
    note = "Kept in outages.parquet; an outage with two labels is in two rows."
    return Table(
        f"Set apart, protocol {protocol}", ("outages", "system", "label", "n", "median"), cells, note
    )


def _by_recording(protocol: str, rows: Sequence[Row], marks: dict[str, str]) -> list[Table]:
    names = list(dict.fromkeys(row["recording"] for row in rows))
    return [
        _board(f"{name}, protocol {protocol}", [r for r in rows if r["recording"] == name], marks)
        for name in names
    ]


def _checks(results: Results, marks: dict[str, str]) -> Table:
    cells = tuple(
        (marks[system], said, _names(found, said))
        for system, found in results.checks.items()
        for said in dict.fromkeys(found.values())
    )
    return Table("Prefix law", ("system", "outcome", "recordings"), cells)


def _names(found: dict[str, str], said: str) -> str:
    """Recordings of one outcome; "all 8" where there are many and they agree."""
    names = sorted(name for name, what in found.items() if what == said)
    return f"all {len(names)}" if len(names) == len(found) > 3 else ", ".join(names)


def _metres(value: float) -> str:
    if math.isnan(value):
        return "-"
    return f"{value:.1f}" if value < 100.0 else f"{value:.0f}"


def _span(row: Row, name: str) -> str:
    if math.isnan(row[f"{name}_lo"]):
        return _metres(row[name])
    return f"{_metres(row[name])} [{_metres(row[f'{name}_lo'])}, {_metres(row[f'{name}_hi'])}]"


def _percent(share: float) -> str:
    return "-" if math.isnan(share) else f"{100.0 * share:.0f}"


def _ratio(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _p(value: float) -> str:
    if math.isnan(value):
        return "-"
    return "< 0.0001" if value < 1e-4 else f"{value:.4f}"
