"""Leaderboards and pairs: what many outages say of a few systems."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

import numpy as np

from gapless.evaluation.pairs import Pair, holm, pair
from gapless.evaluation.resampling import FIGURES, Order, interval, order, resample
from gapless.laboratory.rows import Row
from gapless.trip.recording import Array

POOLED: Final = "pooled"
"""Stands for all recordings together."""
MOST_RECORDINGS: Final = 50
"""Beyond so many recordings only the pool is told."""
_COVERAGES: Final = ("coverage_50", "coverage_95", "coverage_99")


def counts(row: Row) -> bool:
    """Whether an outage is in the pool.

    Parameters
    ----------
    row : dict
        Of `outages.parquet`.

    Returns
    -------
    bool
    """
    return not row["labels"] and math.isfinite(row["horizontal_max"])


def leaderboard(outages: Sequence[Row], seed: int = 0) -> list[Row]:
    """Largest horizontal error over outages, by protocol, group, recording and system.

    Parameters
    ----------
    outages : sequence of dict
        Rows of `outages.parquet`.
    seed : int
        Of the bootstrap.

    Returns
    -------
    list of dict
        Each figure with its 95 % interval, `..._lo` and `..._hi`; coverages over truth epochs;
        `left_out`: outages that a label sets apart.
    """
    board = []
    for head, rows in _pools(outages):
        for system in _unique(row["system"] for row in rows):
            own = [row for row in rows if row["system"] == system]
            pool = [row for row in own if counts(row)]
            values, drawn = _errors(pool), resample(_order(pool), seed)
            line: Row = {**head, "system": system, "n": len(pool)}
            for name, figure in FIGURES.items():
                found = interval(values, drawn, figure)
                line |= {name: found.value, f"{name}_lo": found.lo, f"{name}_hi": found.hi}
            line |= {name: _over_epochs(pool, name) for name in _COVERAGES}
            board.append(line | {"left_out": len(own) - len(pool)})
    return board


def pairs(outages: Sequence[Row], base: str, seed: int = 0) -> list[Row]:
    """Every system against a base system, on the outages in which both count.

    Parameters
    ----------
    outages : sequence of dict
        Rows of `outages.parquet`.
    base : str
        Name of a system.
    seed : int
        Of the bootstrap.

    Returns
    -------
    list of dict
        p values are corrected for the number of systems of the same protocol, group and recording.
    """
    found = []
    for head, rows in _pools(outages):
        own = {system: _by_outage(rows, system) for system in _unique(row["system"] for row in rows)}
        others = [system for system in own if system != base]
        told = [(system, _against(own[system], own.get(base, {}), seed)) for system in others]
        corrected = holm([one.p for _, one in told])
        for (system, one), p in zip(told, corrected, strict=True):
            found.append({**head, "system": system, "base": base, **_pair_row(one), "p_corrected": p})
    return found


def set_apart(outages: Sequence[Row]) -> list[Row]:
    """Outages that are not in the pool, by protocol, group, system and label.

    Parameters
    ----------
    outages : sequence of dict

    Returns
    -------
    list of dict
        With their number and the median of their largest horizontal error [m], as far as it is known.
    """
    heads = ("protocol", "group", "system", "label")
    found: dict[tuple[str, ...], list[float]] = {}
    for row in outages:
        for label in filter(None, row["labels"].split("; ")):
            key = (row["protocol"], row["group"], row["system"], label)
            found.setdefault(key, []).append(row["horizontal_max"])
    return [
        {**dict(zip(heads, key, strict=True)), "n": len(errors), "median": _median(errors)}
        for key, errors in found.items()
    ]


def _median(errors: Sequence[float]) -> float:
    told = [e for e in errors if math.isfinite(e)]
    return float(np.median(told)) if told else math.nan


def _pools(outages: Sequence[Row]) -> Iterator[tuple[Row, list[Row]]]:
    """Rows that are looked at together: all recordings, then one by one."""
    for protocol in _unique(row["protocol"] for row in outages):
        for group in _unique(row["group"] for row in outages):
            rows = [row for row in outages if row["protocol"] == protocol and row["group"] == group]
            if not rows:
                continue
            head = {"protocol": protocol, "group": group, "length": rows[0]["length"]}
            names = _unique(row["recording"] for row in rows)
            yield {**head, "recording": POOLED}, rows
            for name in names if 1 < len(names) <= MOST_RECORDINGS else ():
                yield {**head, "recording": name}, [row for row in rows if row["recording"] == name]


def _unique(values: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(values))


def _errors(rows: Sequence[Row]) -> Array:
    return np.array([row["horizontal_max"] for row in rows], float)


def _order(rows: Sequence[Row]) -> Order:
    starts, ends = (np.array([row[name] for row in rows], float) for name in ("start", "end"))
    return order([row["recording"] for row in rows], starts, ends)


def _over_epochs(rows: Sequence[Row], name: str) -> float:
    """A share of each outage's epochs as one of all epochs."""
    told = [(row[name], row["truth_epochs"]) for row in rows if math.isfinite(row[name])]
    total = sum(n for _, n in told)
    return sum(share * n for share, n in told) / total if total else math.nan


def _by_outage(rows: Sequence[Row], system: str) -> dict[tuple[str, str, float], Row]:
    return {
        (row["recording"], row["scenario"], row["start"]): row
        for row in rows
        if row["system"] == system and counts(row) and row["horizontal_max"] > 0.0
    }


def _against(
    own: dict[tuple[str, str, float], Row], base: dict[tuple[str, str, float], Row], seed: int
) -> Pair:
    both = [key for key in own if key in base]
    rows = [own[key] for key in both]
    return pair(_errors(rows), _errors([base[key] for key in both]), _order(rows), seed)


def _pair_row(one: Pair) -> Row:
    return {
        "n": one.count,
        "median_ratio": one.median_ratio,
        "geometric": one.geometric.value,
        "geometric_lo": one.geometric.lo,
        "geometric_hi": one.geometric.hi,
        "better": one.better,
        "worst_ratio": one.worst_ratio,
        "p": one.p,
    }
