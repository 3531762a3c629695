"""The page of one run: its tables from the summary, its track and charts from the solution."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from gapless.evaluation import Scores
from gapless.io.marks import check_ours, is_page
from gapless.io.writers.atomic import atomic
from gapless.reports import rehearsals, tables, wheels
from gapless.reports.background import Feature
from gapless.reports.numbers import distance, duration, known
from gapless.reports.page import Content, fill, render, section
from gapless.reports.payload import payload
from gapless.reports.summary import summarise
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

_SECTIONS = (
    ("outages", "Outages", tables.outages),
    ("wheels", "Wheels", wheels.text),
    ("rehearsals", "Rehearsals", rehearsals.text),
    ("decisions", "Decisions", tables.decisions),
    ("innovations", "Innovations", tables.innovations),
    ("states", "States at the end", tables.states),
    ("notices", "Noticed on the way", tables.notices),
    ("notes", "Noticed in the recording", tables.notes),
)


def write_report(
    solution: Solution,
    recording: Recording,
    scores: Scores | None,
    path: str | Path,
    background: Sequence[Feature] = (),
    force: bool = False,
) -> None:
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
        Where to. A page of ours that is there is replaced, once the new one is
        complete.
    background : sequence of Feature
        From `gapless.reports.background.read_background`, drawn beneath the track.
    force : bool
        Replace what is there, whoever wrote it.

    Raises
    ------
    ConfigError
        If a file is there that gapless did not write.
    """
    check_ours([path := Path(path)], force, is_page, "force=True")
    text = page(solution, recording, scores, background=background)
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def page(
    solution: Solution,
    recording: Recording | None,
    scores: Scores | None,
    summary: Mapping[str, Any] | None = None,
    background: Sequence[Feature] = (),
) -> str:
    """The report as text.

    Parameters
    ----------
    solution : Solution
    recording : Recording, optional
        Without it, neither fixes nor a reference are drawn.
    scores : Scores, optional
    summary : mapping, optional
        From `summarise`, if it is there already.
    background : sequence of Feature

    Returns
    -------
    str
        HTML.
    """
    told = summarise(solution, scores) if summary is None else summary
    gnss = None if recording is None else recording.gnss
    exhibits = [*wheels.charts(told, gnss), *rehearsals.charts(told)]
    content = Content(
        name=solution.name,
        kind=solution.system,
        lead=_lead(told),
        tiles=tables.tiles(told),
        body=fill("fuse/body.html", {key: section(key, title, make(told)) for key, title, make in _SECTIONS}),
        data=payload(solution, recording, scores, background, exhibits),
        scripts=("fuse/track.js", "fuse/main.js"),
        verdict=told.get("verdict", ""),
    )
    return render(content)


def _lead(summary: Mapping[str, Any]) -> str:
    lasting, moved = duration(known(summary["duration"])), distance(known(summary["distance"]))
    text = f"{lasting} and {moved}, fused by the system \u201c{summary['system']}\u201d"
    count, scores = len(summary["outages"]), summary["scores"]
    if count:
        text += f" through {count} GNSS outage{'s' * (count > 1)}"
    return text + ("." if scores is None else f". Truth: {scores['statement']}.")
