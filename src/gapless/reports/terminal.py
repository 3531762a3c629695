"""A summary as lines for a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from gapless.reports.numbers import distance, duration, known, measured, number, percent
from gapless.reports.summary import decision_of, decision_value, unstated

_WIDTH = 80


def summary_lines(summary: Mapping[str, Any], head: bool = True) -> list[str]:
    """A summary for the terminal.

    Parameters
    ----------
    summary : mapping
        As `summarise` returns it, or as it comes back from JSON.
    head : bool
        Whether to begin with what was fused.

    Returns
    -------
    list of str
        At most 80 columns wide.
    """
    lines = [summary["verdict"]] if summary.get("verdict") else []
    if head:
        lines.insert(0, f"{summary['name']} · {summary['system']} · gapless {summary['gapless']}")
        lines.append(f"{duration(summary['duration'])}, {distance(summary['distance'])}")
    for title, part in (
        ("Decisions", _decision_lines),
        ("States at the end", _state_lines),
        ("Innovations", _innovation_lines),
        ("Accuracy", _score_lines),
        ("Outages", _outage_lines),
        ("Noticed on the way", _notice_lines),
        ("Noticed in the recording", _note_lines),
    ):
        found = list(part(summary))
        if found:
            lines += [*[""] * bool(lines), title, *found]
    wrapped = (_wrapped(line) for line in lines)
    return [line.replace("\u00a0", " ") for part in wrapped for line in part]


def _wrapped(line: str) -> list[str]:
    """A line on as many as it takes; what is indented goes on further in."""
    deeper = " " * 6 if line.startswith(" ") else ""
    return textwrap.wrap(line, _WIDTH, subsequent_indent=deeper) or [""]


def _decision_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    for one in summary["decisions"]:
        value = decision_value(decision_of(one))
        yield f"  {one['name']}: {value} ({one['source']}: {one['evidence']})"


def _state_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    left: dict[str, list[float]] = {}
    for o in summary.get("observability", ()):
        left.setdefault(o["block"], []).append(known(o["ratio"]))
    for name, one in summary["states"].items():
        parts = (measured(known(v), known(sd)) for v, sd in zip(one["value"], one["sd"], strict=True))
        text = f"  {name.replace('_', ' ')}: {', '.join(parts)} {one['unit']}".rstrip()
        shares = " ".join(f"{100.0 * share:.0f}" for share in left.get(name, ()))
        yield text + (f" (sd down to {shares} %)" if shares else "")


def _innovation_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    if summary["innovations"]:
        yield f"  {'channel':<16}{'count':>8}{'NIS/dof':>9}{'in 95 %':>9}{'inflated':>10}{'rejected':>10}"
    for name, c in summary["innovations"].items():
        nis, share = number(known(c["mean_nis"])), percent(known(c["within_95"]))
        yield f"  {name:<16}{c['count']:>8}{nis:>9}{share:>9}{c['inflated']:>10}{c['rejected']:>10}"


def _score_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    scores = summary["scores"]
    if scores is None:
        return
    aided = scores["aided"]
    yield f"  truth: {scores['statement']}"
    if scores["truth"] == "reference":
        line = f"  horizontal {number(known(aided['horizontal_rmse']), 'm')} RMS outside outages"
        yield line + f" (raw fixes {number(known(scores['fixes_horizontal_rmse']), 'm')})"
        angles = [known(aided[f"{a}_rmse_deg"]) for a in ("roll", "pitch", "heading")]
        if np.isfinite(angles).any():
            yield f"  roll, pitch, heading {', '.join(map(number, angles))} deg RMS"
    if said := unstated(scores):
        yield f"  {said}"
    if scores["height_offset"] is not None:
        side = "above" if scores["height_offset"] > 0.0 else "below"
        yield f"  height {number(abs(scores['height_offset']), 'm')} {side} the truth as a rule, taken off"


def _outage_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    scores = summary["scores"]
    if scores is None or not summary["outages"]:
        return
    yield f"  {'start:end s':<14}{'largest':>9}{'at end':>9}{'travelled':>11}{'heading':>9}  "
    for o in summary["outages"]:
        cells = [number(known(o[key]), "m") for key in ("horizontal_max", "horizontal_end")]
        heading = number(known(o["heading_max_deg"]), "deg", 2)
        line = f"  {o['start']:g}:{o['end']:g}".ljust(16) + f"{cells[0]:>9}{cells[1]:>9}"
        yield (line + f"{distance(o['distance']):>11}{heading:>9}  {', '.join(o['labels'])}").rstrip()
    s = scores["horizontal_max"]
    if s["count"]:
        median, p90, root, worst = (number(s[key], "m") for key in ("median", "p90", "rms", "worst"))
        yield f"  largest error over {s['count']}: median {median}, P90 {p90}, RMS {root}, worst {worst}"
    if scores["outages_apart"]:
        yield f"  {scores['outages_apart']} of {scores['outages']} left out of these figures"


def _notice_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    for notice in summary.get("notices", ()):
        yield f"  {notice['text']}"


def _note_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    for note in summary["notes"]:
        times = f" ({note['count']})" if note["count"] else ""
        yield f"  {note['where']}: {note['what']}{times}"
