"""The parts of a run's page that are words and tables: made of its summary, they stand without a script."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from gapless.reports.numbers import DASH, distance, duration, known, measured, number, percent
from gapless.reports.page import Tile
from gapless.reports.quantities import channel, state
from gapless.reports.summary import decision_of, decision_value, unstated

Cell = str | tuple[str, str]
"""Text, or text with the class of its cell."""
Summary = Mapping[str, Any]
"""As `summarise` returns it, or as it comes back from JSON."""


def table(caption: str, head: Sequence[Cell], rows: Iterable[Sequence[Cell]]) -> str:
    """A table that scrolls sideways in its own frame where the page is narrow.

    Parameters
    ----------
    caption : str
        Escaped here.
    head : sequence of str or (str, str)
        Column titles: text, or text and class.
    rows : iterable of sequence of str or (str, str)
        Cells as HTML, already escaped; the first of each row is its header.

    Returns
    -------
    str
        HTML.
    """
    titles = "".join(_cell("th", cell, ' scope="col"') for cell in head)
    body = []
    for row in rows:
        first = _cell("th", row[0], ' scope="row"')
        rest = (_cell("td", cell, "") for cell in row[1:])
        body.append(f"<tr>{first}{''.join(rest)}</tr>")
    label = escape(caption)
    return (
        f'<div class="scroll" role="region" tabindex="0" aria-label="{label}"><table>'
        f'<caption class="quiet">{label}</caption><thead><tr>{titles}</tr></thead>'
        f"<tbody>{''.join(body)}</tbody></table></div>"
    )


def _cell(tag: str, cell: Cell, attributes: str) -> str:
    text, kind = (cell, "") if isinstance(cell, str) else cell
    return f"<{tag}{attributes}{f' class={kind}' if kind else ''}>{text}</{tag}>"


def numeric(*texts: str) -> list[Cell]:
    """Cells that align as figures.

    Parameters
    ----------
    *texts : str

    Returns
    -------
    list of (str, str)
    """
    return [(text, "n") for text in texts]


def count(value: int) -> str:
    """A whole number, its thousands apart.

    Parameters
    ----------
    value : int

    Returns
    -------
    str
    """
    return f"{value:,}".replace(",", "\u202f")


def tiles(summary: Summary) -> list[Tile]:
    """Headline figures.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    list of (str, str, str)
        Title, value, note.
    """
    lasting, moved = known(summary["duration"]), known(summary["distance"])
    withheld = sum(one["end"] - one["start"] for one in summary["outages"])
    found: list[Tile] = [
        ("Duration", duration(lasting), f"{count(summary['rows'])} rows"),
        (
            "Distance",
            distance(moved),
            f"{number(3.6 * moved / lasting, 'km/h')} on average" if lasting else "",
        ),
        (
            "Outages",
            str(len(summary["outages"])),
            f"{duration(withheld)} without GNSS" if withheld else "none withheld",
        ),
        *_accuracy_tiles(summary),
    ]
    sd = number(known(summary["position_sd"]), "m", 2)
    return [*found, ("Position sd", sd, "median, horizontal, with GNSS")]


def _accuracy_tiles(summary: Summary) -> list[Tile]:
    scores, found = summary["scores"], []
    if scores is None:
        return []
    if scores["truth"] == "reference":
        fixes = number(known(scores["fixes_horizontal_rmse"]), "m", 2)
        rmse = number(known(scores["aided"]["horizontal_rmse"]), "m", 2)
        found.append(("Horizontal RMSE", rmse, f"raw fixes {fixes}"))
    told = [o for o in summary["outages"] if not o["labels"] and o["horizontal_max"] is not None]
    if told:
        worst = max(told, key=lambda o: float(o["horizontal_max"]))
        median = number(known(scores["horizontal_max"]["median"]), "m")
        found.append(("Median outage", median, f"largest error of each of {len(told)}"))
        share = f"{number(known(worst['percent']), '%', 2)} of {distance(known(worst['distance']))}"
        found.append(("Worst outage", number(worst["horizontal_max"], "m"), share))
    return found


def outages(summary: Summary) -> str:
    """What each outage cost.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" without scored outages.
    """
    if summary["scores"] is None or not summary["outages"]:
        return ""
    head: list[Cell] = ["Outage", *numeric("From", "Largest", "RMS", "At end", "Along", "Cross", "Vertical")]
    head += [*numeric("Velocity", "Heading", "Travelled", "Drift", "In 95&nbsp;%"), "Set apart"]
    rows = [_outage_row(k + 1, one) for k, one in enumerate(summary["outages"])]
    return table("Errors in each outage", head, rows) + _pool(summary)


def _outage_row(index: int, o: Summary) -> list[Cell]:
    name = f'<button type="button" data-from="{o["start"]:g}" data-to="{o["end"]:g}">{index}</button>'
    others = ("horizontal_rmse", "horizontal_end", "along_max", "cross_max", "vertical_max")
    cells = numeric(
        f"{o['start']:g}\u2013{o['end']:g}&nbsp;s",
        f"<b>{number(known(o['horizontal_max']), 'm')}</b>",
        *(number(known(o[key]), "m") for key in others),
        number(known(o["velocity_max"]), "m/s", 2),
        number(known(o["heading_max_deg"]), "", 2) + "°",
        distance(known(o["distance"])),
        number(known(o["percent"]), "%", 2),
        percent(known(o["coverage_95"])),
    )
    return [name, *cells, escape(", ".join(o["labels"])) or DASH]


def _pool(summary: Summary) -> str:
    scores = summary["scores"]
    s, apart, words = scores["horizontal_max"], scores["outages_apart"], []
    if s["count"]:
        figures = (("median", "median"), ("P90", "p90"), ("RMS", "rms"), ("worst", "worst"))
        words.append(
            f"Largest horizontal error over {s['count']}: "
            + ", ".join(f"{name} <b>{number(known(s[key]), 'm')}</b>" for name, key in figures)
            + f"; {percent(known(scores['coverage_95']))} of epochs inside the stated 95&nbsp;% ellipse."
        )
    if apart:
        words.append(f"{apart} of {scores['outages']} set apart and left out of these figures.")
    if said := unstated(scores):
        words.append(f"{said}.")
    height = scores["height_offset"]
    if height is not None:
        high = f"{number(abs(height), 'm')} {'above' if height > 0.0 else 'below'}"
        words.append(f"The solution lies {high} the truth as a rule; vertical errors are without that.")
    return f"<p>{' '.join(words)}</p>"


def decisions(summary: Summary) -> str:
    """What fusion settled, and why.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" without decisions.
    """
    if not summary["decisions"]:
        return ""
    rows: list[list[Cell]] = [
        [
            escape(one["name"]),
            (escape(decision_value(decision_of(one))), "value"),
            (f'<span class="source {escape(one["source"])}">{escape(one["source"])}</span>', "short"),
            escape(one["evidence"]),
        ]
        for one in summary["decisions"]
    ]
    made = table("Decisions and their evidence", ["Decision", "Value", "Source", "Evidence"], rows)
    return f'<div class="decisions">{made}</div>'


def innovations(summary: Summary) -> str:
    """How each channel's innovations agree with their stated size.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" without innovations.
    """
    if not summary["innovations"]:
        return ""
    head: list[Cell] = [
        "Channel",
        *numeric("Count", "Mean NIS / dof", "Median NIS", "In 95&nbsp;%", "Inflated", "Rejected"),
    ]
    rows: list[list[Cell]] = []
    for name, s in summary["innovations"].items():
        figures = (
            number(known(s["mean_nis"])),
            number(known(s["median_nis"])),
            percent(known(s["within_95"])),
        )
        counts = [count(s[key]) for key in ("count", "inflated", "rejected")]
        rows.append([escape(channel(name, s["dof"])[0].label), *numeric(counts[0], *figures, *counts[1:])])
    return table("Innovation statistics", head, rows) + (
        "<p>An honest filter has a mean and a median of 1 and 95&nbsp;% inside. Inflated observations were "
        "used with a larger noise, rejected ones not at all.</p>"
    )


def states(summary: Summary) -> str:
    """Biases and other states at the end of the run, and how much of their uncertainty is left.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML; "" without further states.
    """
    rows: list[list[Cell]] = []
    left = {(o["block"], o["axis"]): known(o["ratio"]) for o in summary.get("observability", ())}
    for name, one in summary["states"].items():
        label = escape(state(name, len(one["value"])).label)
        for k, (axis, value, sd) in enumerate(zip(one["axes"], one["value"], one["sd"], strict=True)):
            text = measured(known(value), sd, one["unit"])
            share = percent(left.get((name, k), math.nan))
            rows.append([label, escape(axis), (escape(text), "n"), (share, "n")])
    head: list[Cell] = ["State", "Axis", ("Value", "n"), ("Deviation left", "n")]
    return table("States at the end", head, rows) if rows else ""


def notices(summary: Summary) -> str:
    """What went wrong on the way.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML: a list; "" where nothing was noticed.
    """
    items = "".join(f"<li>{escape(notice['text'])}</li>" for notice in summary.get("notices", ()))
    return f"<ul class=notes>{items}</ul>" if items else ""


def notes(summary: Summary) -> str:
    """What was mended or noticed in the recording.

    Parameters
    ----------
    summary : mapping

    Returns
    -------
    str
        HTML: a list, or one line where nothing was.
    """
    if not summary["notes"]:
        return "<p>Nothing had to be mended in this recording.</p>"
    items = (
        f"<li><b>{escape(note['where'])}</b> {escape(note['what'])}"
        + (f' <span class="quiet">({note["count"]:,}&times;)</span>' if note["count"] else "")
        + "</li>"
        for note in summary["notes"]
    )
    return f"<ul class=notes>{''.join(items)}</ul>"
