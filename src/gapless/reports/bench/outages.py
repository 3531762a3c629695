"""Every outage of a bench once: what each system scored in it, and the error against its age."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from gapless.reports.bench.folder import QUANTITIES, Bench, groups, number_or_none, thinned
from gapless.reports.pack import packed_errors

SCORES: Final = (
    *("horizontal_max", "horizontal_rmse", "horizontal_end", "vertical_max", "along_max", "cross_max"),
    *("velocity_max", "heading_deg_max", "percent", "coverage_95", "nees", "inside_95_end"),
)
"""Columns of an outage's card."""
CURVES: Final = ("age", *QUANTITIES, "bound")
"""Columns of the error against age."""
_VALUES = 1_000_000
"""Numbers of all curves together: 2.7 MB of the page."""
_KEYS = ("recording", "protocol", "scenario", "start")


def outage_cards(bench: Bench) -> tuple[list[dict[str, Any]], dict[tuple[Any, ...], int]]:
    """Outages, in the order of recordings and times.

    Parameters
    ----------
    bench : Bench

    Returns
    -------
    cards : list of dict
        JSON-able: `r`, `p` (indices), `scenario`, `group`, `start`, `end`, `labels`, `truth`,
        `distance`, and `scores`: by index of the system the numbers of `SCORES`.
    places : dict
        Index of the card by (recording, protocol, scenario, start).
    """
    table, protocols = bench.outages, list(bench.facts["protocols"])
    cards: list[dict[str, Any]] = []
    places: dict[tuple[Any, ...], int] = {}
    found = [
        (bench.recordings.index(key[0]), protocols.index(key[1]), key, rows)
        for key, rows in groups(table, _KEYS)
        if key[0] in bench.recordings and key[1] in protocols
    ]
    for r, p, key, rows in sorted(found, key=lambda one: (*one[:2], one[2][3], one[2][2])):
        first = rows[0]
        places[key] = len(cards)
        cards.append(
            {
                "r": r,
                "p": p,
                "scenario": key[2],
                "group": str(table["group"][first]),
                "start": round(float(key[3]), 3),
                "end": round(float(table["end"][first]), 3),
                "labels": [word for word in str(table["labels"][first]).split("; ") if word],
                "truth": str(table["truth"][first]),
                "distance": number_or_none(table["distance"][first]),
                "scores": _scores(bench, rows),
                "curves": {},
                "tracks": {},
            }
        )
    return cards, places


def _scores(bench: Bench, rows: Any) -> dict[int, list[float | None]]:
    table, systems, found = bench.outages, bench.systems, {}
    for row in rows:
        if table["system"][row] in systems:
            index = systems.index(table["system"][row])
            found[index] = [number_or_none(table[name][row]) for name in SCORES]
    return found


def curves(bench: Bench, cards: list[dict[str, Any]], places: dict[tuple[Any, ...], int]) -> dict[str, Any]:
    """Error against age of every system in every outage; `curves` of the cards say where each is.

    Parameters
    ----------
    bench : Bench
    cards : list of dict
        Filled in: by index of the system, first point and number of points.
    places : dict
        From `outage_cards`.

    Returns
    -------
    dict
        `most`, the points of a curve, and one packed column for each of `CURVES`.
    """
    table = bench.ages
    found = [(key, rows) for key, rows in groups(table, (*_KEYS, "system")) if key[:4] in places]
    most = int(np.clip(_VALUES / (len(CURVES) * max(len(found), 1)), 12, 240))
    chosen, at = [], 0
    for key, rows in found:
        if key[4] not in bench.systems:
            continue
        kept = thinned(rows[np.argsort(table["age"][rows], kind="stable")], most)
        cards[places[key[:4]]]["curves"][bench.systems.index(key[4])] = [at, len(kept)]
        chosen.append(kept)
        at += len(kept)
    every = np.concatenate(chosen) if chosen else np.zeros(0, int)
    return {"most": most} | {name: packed_errors(table[name][every]) for name in CURVES}
