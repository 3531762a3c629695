"""Leaderboard, pairs, runs and checks of a bench, as the page's scripts take them."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

from gapless.errors import ConfigError
from gapless.reports.bench.folder import POOLED, Bench, number_or_none
from gapless.reports.numbers import known, measured
from gapless.reports.quantities import channel, state
from gapless.reports.summary import decision_of, decision_value


def _recording(bench: Bench, name: str) -> int | None:
    """Index of a recording; -1 where a row is of all of them, None where the bench does not know it."""
    if name in bench.recordings:
        return bench.recordings.index(name)
    return -1 if name == POOLED else None


def rows_of(bench: Bench, table: dict[str, Any]) -> list[dict[str, Any]]:
    """Rows of the leaderboard or of the pairs.

    Parameters
    ----------
    bench : Bench
    table : dict of str to ndarray

    Returns
    -------
    list of dict
        JSON-able: `r` (-1 where pooled), `protocol`, `group`, `system`, `base` as indices and names, numbers
        under the names of the file's columns.
    """
    systems, protocols, found = bench.systems, list(bench.facts["protocols"]), []
    numbers = [name for name in table if name not in ("recording", "protocol", "group", "system", "base")]
    for k in range(len(table["system"])):
        r = _recording(bench, table["recording"][k])
        if r is None or table["system"][k] not in systems or table["protocol"][k] not in protocols:
            continue
        row: dict[str, Any] = {"r": r, "protocol": protocols.index(table["protocol"][k])}
        row |= {"group": table["group"][k], "system": systems.index(table["system"][k])}
        if "base" in table:
            row["base"] = table["base"][k]
        found.append(row | {name: number_or_none(float(table[name][k])) for name in numbers})
    return found


def runs(bench: Bench) -> tuple[list[dict[str, Any]], list[Any]]:
    """What each run decided, its biases and its innovations; equal ones are kept once.

    Parameters
    ----------
    bench : Bench

    Returns
    -------
    runs : list of dict
        `r`, `p`, `system`, `scenario`, `rmse`, `coverage`, and places of `decisions`, `biases`,
        `innovations` among the parts.
    parts : list

    Raises
    ------
    ConfigError
        If a cell is not the JSON that a bench writes.
    """
    table, protocols = bench.runs, list(bench.facts["protocols"])
    shapes = {"decisions": _decisions, "biases": _biases, "innovations": _innovations}
    parts: list[Any] = []
    places: dict[tuple[str, str], int] = {}
    found = []
    for k in range(len(table["system"])):
        r = _recording(bench, table["recording"][k])
        if r is None or table["system"][k] not in bench.systems or table["protocol"][k] not in protocols:
            continue
        row: dict[str, Any] = {
            "r": r,
            "p": protocols.index(table["protocol"][k]),
            "system": bench.systems.index(table["system"][k]),
            "scenario": table["scenario"][k],
            "rmse": number_or_none(table["rmse_open"][k]),
            "coverage": number_or_none(table["coverage_open_95"][k]),
        }
        for name, shape in shapes.items():
            text = table[name][k]
            if (name, text) not in places:
                try:
                    parts.append(shape(json.loads(text or "null")))
                except (ValueError, KeyError, TypeError, AttributeError) as error:
                    raise ConfigError(
                        f"runs.parquet, row {k + 1}: {name} is not a bench's ({error}); run it again"
                    ) from error
                places[name, text] = len(parts) - 1
            row[name] = places[name, text]
        found.append(row)
    return found, parts


def _decisions(entries: Any) -> list[list[str]]:
    """Name, value with unit, source, evidence."""
    return [
        [one["name"], decision_value(decision_of(one)), one["source"], one["evidence"]]
        for one in entries or []
    ]


def _biases(blocks: Any) -> list[list[str]]:
    """State with its axis, unit, value with its standard deviation."""
    return [
        [f"{state(name, len(one['value'])).label}, {axis}", one["unit"], measured(known(value), sd)]
        for name, one in (blocks or {}).items()
        for axis, value, sd in zip(one["axes"], one["value"], one["sd"], strict=True)
    ]


def _innovations(channels: Any) -> list[list[Any]]:
    """Title, count, mean NIS over dof, median NIS, share in 95 %, inflated, rejected."""
    return [
        [
            channel(name, s["dof"])[0].label,
            s["count"],
            *(number_or_none(known(s[key])) for key in ("mean_nis", "median_nis", "within_95")),
            s["inflated"],
            s["rejected"],
        ]
        for name, s in (channels or {}).items()
    ]


def apart(cards: list[dict[str, Any]]) -> list[list[Any]]:
    """How many outages each label sets apart.

    Parameters
    ----------
    cards : list of dict

    Returns
    -------
    list of [str, int]
        The commonest first.
    """
    counts = Counter(label for card in cards for label in card["labels"])
    return [[label, count] for label, count in counts.most_common()]


def prefix_checks(bench: Bench) -> list[dict[str, Any]]:
    """Outcome of the prefix check by system and recording.

    Parameters
    ----------
    bench : Bench

    Returns
    -------
    list of dict
        `system`, `recording`, `said`.
    """
    return [
        {"system": str(system), "recording": str(recording), "said": str(said)}
        for system, by_recording in (bench.facts.get("prefix") or {}).items()
        for recording, said in by_recording.items()
    ]
