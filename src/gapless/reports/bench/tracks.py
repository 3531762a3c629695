"""The maps of a bench: the truth of each recording, and every system inside every outage."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gapless.reports.background import Feature, east_north, placed
from gapless.reports.bench.folder import Bench, groups, thinned
from gapless.reports.decimate import simplify
from gapless.reports.pack import packed_errors, packed_times, rounded
from gapless.trip.recording import Array
from gapless.units import DEG

_POINTS = 90_000
"""Points of all systems' tracks together: 2 MB of the page."""
_TRUTH = 3000
_KEYS = ("recording", "protocol", "scenario", "start")


def tracks(
    bench: Bench,
    cards: list[dict[str, Any]],
    places: dict[tuple[Any, ...], int],
    background: Sequence[Feature],
) -> dict[str, Any]:
    """What the map draws; `tracks` of the cards say where each system's part is.

    Parameters
    ----------
    bench : Bench
    cards : list of dict
        Filled in: by index of the system, first point and number of points.
    places : dict
        From `outage_cards`.
    background : sequence of Feature

    Returns
    -------
    dict
        `truth` by recording, in metres about its middle, with its `background`; packed columns `t`, `x`,
        `y`, `a`, `b`, `angle` of the systems.
    """
    table = bench.tracks
    lla = np.column_stack([table["lat"] * DEG, table["lon"] * DEG, np.zeros(len(table["lat"]))])
    truths, origins = _truths(bench, lla, background)
    found = [
        (key, rows)
        for key, rows in groups(table, (*_KEYS, "kind"))
        if key[:4] in places and key[4] in bench.systems and key[0] in origins
    ]
    most = int(np.clip(_POINTS / max(len(found), 1), 6, 60))
    parts, at = [], 0
    for key, rows in found:
        rows = rows[np.argsort(table["time"][rows], kind="stable")]
        rows = thinned(rows[np.isfinite(lla[rows]).all(axis=1)], most)
        cards[places[key[:4]]]["tracks"][bench.systems.index(key[4])] = [at, len(rows)]
        parts.append((rows, east_north(lla[rows], origins[key[0]])))
        at += len(rows)
    every = np.concatenate([rows for rows, _ in parts]) if parts else np.zeros(0, int)
    xy = np.concatenate([xy for _, xy in parts]) if parts else np.zeros((0, 2))
    return {
        "truth": truths,
        "t": packed_times(table["time"][every]),
        "x": packed_times(xy[:, 0]),
        "y": packed_times(xy[:, 1]),
        "a": packed_errors(table["semi_major"][every]),
        "b": packed_errors(table["semi_minor"][every]),
        "angle": packed_errors(table["direction"][every]),
    }


def _truths(
    bench: Bench, lla: Array, background: Sequence[Feature]
) -> tuple[list[dict[str, Any] | None], dict[str, Array]]:
    table = bench.tracks
    known = (table["kind"] == "truth") & np.isfinite(lla).all(axis=1)
    found: list[dict[str, Any] | None] = []
    origins = {}
    for name in bench.recordings:
        rows = np.flatnonzero(known & (table["recording"] == name))
        if not len(rows):
            found.append(None)
            continue
        rows = rows[np.argsort(table["time"][rows], kind="stable")]
        origin = origins[name] = lla[rows[len(rows) // 2]]
        xy, time = east_north(lla[rows], origin), table["time"][rows]
        kept = simplify(time, xy, _TRUTH, 0.3)
        found.append(
            {
                "t": rounded(time[kept], 2),
                "x": rounded(xy[kept, 0], 2),
                "y": rounded(xy[kept, 1], 2),
                "background": placed(background, lla[rows], origin),
            }
        )
    return found, origins
