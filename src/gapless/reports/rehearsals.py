"""What the page shows of rehearsals: how far off each candidate came, and who was chosen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np

from gapless.reports.charts import chart
from gapless.reports.numbers import known, number
from gapless.reports.tables import Cell, numeric, table

HOST = "rehearsals-charts"
NOBODY = "nobody"
"""The candidate without a bridge, with the recipe's own tuning."""


def text(summary: Mapping[str, Any]) -> str:
    """What was rehearsed and what came of it, in words and a table.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" where the recipe does not rehearse.
    """
    told = summary.get("rehearsals")
    if not told:
        return ""
    length = f"{told['length']:g}&nbsp;s"
    if not told["performances"]:
        return f"<p>No outage was rehearsed: GNSS never spoke for {length} without a break.</p>"
    words = [
        f"{len(told['performances'])} outages of {length} were rehearsed where GNSS was there to tell "
        f"how far off each candidate came. {_without(told)} {_chosen(told, known(summary['start']))}"
    ]
    head: list[Cell] = ["Candidate", *numeric("Rehearsals", "Times the error without", "One standard error")]
    rows: list[list[Cell]] = [
        [
            escape(s["name"]),
            *numeric(
                str(s["rehearsals"]), number(s["ratio"]), f"{number(s['low'])}\u2013{number(s['high'])}"
            ),
            "yes" if s["earned"] else "no",
        ]
        for s in told["standings"]
    ]
    made = table("Candidates", [*head, "Good enough"], rows)
    note = (
        "Ratios are of the largest errors in the same outage, both with the error of the track that they are "
        "held against, their geometric mean drawn towards 1 as if "
        "there had been a few rehearsals more without any difference."
    )
    return f'<p>{" ".join(words)}</p><div class="group" id="{HOST}"></div>{made}<p>{note}</p>'


def _without(told: Mapping[str, Any]) -> str:
    """Median largest errors without a bridge, and of who stands chosen in the end, in the same outages."""
    last = told["choices"][-1]["candidate"]
    pairs = [(one["worst"][NOBODY], one["worst"].get(last)) for one in told["performances"]]
    both = np.array([p for p in pairs if p[1] is not None], float).reshape(-1, 2)
    plain, chosen = (number(float(np.median(both[:, k])), "m") if len(both) else "" for k in range(2))
    if not len(both) or last == NOBODY:
        alone = number(float(np.median([p[0] for p in pairs])), "m")
        return f"Without a bridge the largest error was <b>{alone}</b> in the median."
    return (
        f"In the {len(both)} that {escape(last)} took part in, the median of the largest error was "
        f"<b>{plain}</b> without, and <b>{chosen}</b> with {escape(last)}."
    )


def _chosen(told: Mapping[str, Any], start: float) -> str:
    choices = told["choices"]
    turns = [(None, choices[0]), *pairwise(choices)]
    changed = [b for a, b in turns if b["candidate"] != (a["candidate"] if a else NOBODY)]
    scale = choices[-1]["scale"]
    sure = (
        f" Stated covariances were widened {number(scale)} times in the end." if round(scale, 2) > 1.0 else ""
    )
    if not changed:
        return f"No candidate was ever good enough: {NOBODY} spoke in an outage.{sure}"
    steps = ", ".join(f"{escape(c['candidate'])} from {c['time'] - start:.0f}&nbsp;s on" for c in changed)
    return f"Chosen: {NOBODY} at first, {steps}.{sure}"


def charts(summary: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Its charts, not decimated yet.

    Parameters
    ----------
    summary : mapping

    Yields
    ------
    dict
        See `gapless.reports.charts`; times are those at which rehearsals ended.
    """
    told = summary.get("rehearsals")
    if not told or not told["performances"]:
        return
    start = known(summary["start"])
    time = np.array([one["end"] for one in told["performances"]]) - start
    names = list(dict.fromkeys([NOBODY, *(n for one in told["performances"] for n in one["worst"])]))
    values = [
        (n, np.array([one["worst"].get(n, math.nan) for one in told["performances"]], float)) for n in names
    ]
    every = np.concatenate([y[np.isfinite(y)] for _, y in values])
    limits = (0.8 * max(float(every.min()), 0.1), 1.25 * max(float(every.max()), 0.2))
    title = "Largest error of each rehearsed outage"
    found = chart("", title, "m", time, values, range=limits, dots=True, log=True)
    note = "Each dot stands where its rehearsal ended. Along the bottom: who would have spoken in an outage."
    strips = _strips(told["choices"], names, start)
    yield found | {"host": HOST, "wide": True, "strips": strips, "note": note}
    scales = np.array([c["scale"] for c in told["choices"]])
    if scales.max() > 1.005:
        series = [("factor", scales)]
        yield chart("", "Factor on the stated covariance", "", time, series) | {"host": HOST, "gap": 1e9}


def _strips(choices: list[Mapping[str, Any]], names: list[str], start: float) -> list[list[float | int]]:
    """Begin, end [s] and index of each stretch's candidate; the last one goes on."""
    found: list[list[float | int]] = []
    turns = [*pairwise(choices), (choices[-1], None)]
    for one, after in turns:
        who = names.index(one["candidate"]) if one["candidate"] in names else 0
        end = 1e6 if after is None else round(after["time"] - start, 2)
        if found and found[-1][2] == who:
            found[-1][1] = end
        else:
            found.append([round(one["time"] - start, 2), end, who])
    return found
