"""One self-contained page: tables as HTML, track and charts drawn by a script from embedded data."""

from __future__ import annotations

import json
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from gapless import __version__
from gapless.evaluation import Scores
from gapless.recording import Recording
from gapless.reports import tables
from gapless.reports.numbers import distance, duration
from gapless.reports.payload import payload
from gapless.reports.summary import span, travelled
from gapless.solution import Solution

_SCRIPTS = ("view.js", "chart.js", "track.js", "main.js")


def write_report(solution: Solution, recording: Recording, scores: Scores | None, path: str | Path) -> None:
    """Write the report of a run as one HTML file that needs no network.

    Parameters
    ----------
    solution : Solution
        At least one row.
    recording : Recording
        The one that was fused.
    scores : Scores, optional
        From `gapless.evaluation.score`.
    path : str or Path
        Where to; written in one go.
    """
    Path(path).write_text(page(solution, recording, scores), encoding="utf-8")


def page(solution: Solution, recording: Recording, scores: Scores | None) -> str:
    """The report as text.

    Parameters
    ----------
    solution : Solution
    recording : Recording
    scores : Scores, optional

    Returns
    -------
    str
        HTML.
    """
    sections = {
        "outages": tables.outages(scores),
        "decisions": tables.decisions(solution),
        "innovations": tables.innovations(solution),
        "states": tables.states(solution),
        "notes": tables.notes(solution, recording),
    }
    return Template(_asset("page.html")).substitute(
        name=escape(solution.name),
        system=escape(solution.system),
        lead=_lead(solution, scores),
        tiles=tables.tiles(solution, scores),
        style=_asset("style.css"),
        script="\n".join(_asset(name) for name in _SCRIPTS),
        data=embedded(payload(solution, recording, scores)),
        version=escape(__version__),
        **{key: _section(key, body) for key, body in sections.items()},
    )


def embedded(data: Any) -> str:
    """JSON that can stand inside a script element.

    Parameters
    ----------
    data : object
        JSON-able.

    Returns
    -------
    str
        Nothing in it can end the element or start a comment.
    """
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


_TITLES = {
    "outages": "Outages",
    "decisions": "Decisions",
    "innovations": "Innovations",
    "states": "States at the end",
    "notes": "Noticed in the recording",
}


def _section(key: str, body: str) -> str:
    return f'<section id="{key}"><h2>{_TITLES[key]}</h2>{body}</section>' if body else ""


def _lead(solution: Solution, scores: Scores | None) -> str:
    moved = distance(travelled(solution.trajectory))
    lasting = duration(span(solution.trajectory))
    text = f"{lasting} and {moved}, fused by the system \u201c{solution.system}\u201d"
    count = len(solution.outages)
    if count:
        text += f" through {count} GNSS outage{'s' * (count > 1)}"
    return escape(text + ("." if scores is None else f". Truth: {scores.statement}."))


def _asset(name: str) -> str:
    return (files("gapless.reports") / "assets" / name).read_text(encoding="utf-8")
