"""The parts of the page that are words and tables: they stand without a script, and print."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from html import escape

from gapless.evaluation import OutageScore, Scores
from gapless.recording import Recording
from gapless.reports.numbers import DASH, distance, duration, measured, number, percent
from gapless.reports.quantities import channel, state
from gapless.reports.summary import channel_statistics, decision_value, span, travelled, typical_sd
from gapless.solution import Solution
from gapless.units import DEG

Cell = str | tuple[str, str]
"""Text, or text with the class of its cell."""


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
        rest = (
            _cell("td", cell, f' data-title="{escape(_text(title))}"')
            for cell, title in zip(row[1:], head[1:], strict=True)
        )
        body.append(f"<tr>{first}{''.join(rest)}</tr>")
    label = escape(caption)
    return (
        f'<div class="scroll" role="region" tabindex="0" aria-label="{label}"><table>'
        f'<caption class="quiet">{label}</caption><thead><tr>{titles}</tr></thead>'
        f"<tbody>{''.join(body)}</tbody></table></div>"
    )


def _text(cell: Cell) -> str:
    return cell if isinstance(cell, str) else cell[0]


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


def tiles(solution: Solution, scores: Scores | None) -> str:
    """Headline figures.

    Parameters
    ----------
    solution : Solution
    scores : Scores, optional

    Returns
    -------
    str
        HTML: a description list.
    """
    moved = travelled(solution.trajectory)
    lasting = span(solution.trajectory)
    withheld = sum(b - a for a, b in solution.outages)
    found = [
        ("Duration", duration(lasting), f"{len(solution.trajectory):,} rows".replace(",", "\u202f")),
        (
            "Distance",
            distance(moved),
            f"{number(3.6 * moved / lasting, 'km/h')} on average" if lasting else "",
        ),
        (
            "Outages",
            str(len(solution.outages)),
            f"{duration(withheld)} without GNSS" if withheld else "none withheld",
        ),
    ]
    found += _accuracy_tiles(scores)
    sd = typical_sd(solution)
    found.append(("Position sd", number(sd, "m", 2), "median, horizontal, with GNSS"))
    return "".join(
        f"<div><dt>{escape(title)}</dt><dd><strong>{_small_units(value)}</strong><span>{escape(note)}</span></dd></div>"
        for title, value, note in found
    )


def _small_units(text: str) -> str:
    """Words and units of a headline figure, escaped and set smaller than its digits."""
    return re.sub(r"([^\W\d_][\w/]*|%)", r"<small>\1</small>", escape(text))


def _accuracy_tiles(scores: Scores | None) -> list[tuple[str, str, str]]:
    found: list[tuple[str, str, str]] = []
    if scores is None:
        return found
    if scores.truth == "reference":
        fixes = number(scores.fixes_rmse, "m", 2)
        found.append(("Horizontal RMSE", number(scores.aided.horizontal_rmse, "m", 2), f"raw fixes {fixes}"))
    told = [o for o in scores.pool if math.isfinite(o.horizontal_max)]
    if told:
        worst = max(told, key=lambda o: o.horizontal_max)
        note = f"largest error of each of {len(told)}"
        found.append(("Median outage", number(scores.horizontal.median, "m"), note))
        share = f"{number(worst.percent, '%', 2)} of {distance(worst.distance)}"
        found.append(("Worst outage", number(worst.horizontal_max, "m"), share))
    return found


def outages(scores: Scores | None) -> str:
    """What each outage cost.

    Parameters
    ----------
    scores : Scores, optional

    Returns
    -------
    str
        HTML; "" without outages.
    """
    if scores is None or not scores.outages:
        return ""
    head: list[Cell] = ["Outage", *numeric("From", "Largest", "RMS", "At end", "Along", "Cross", "Vertical")]
    head += [*numeric("Velocity", "Heading", "Travelled", "Drift", "In 95&nbsp;%"), "Set apart"]
    rows = [_outage_row(k + 1, one) for k, one in enumerate(scores.outages)]
    return table("Errors in each outage", head, rows) + _pool(scores)


def _outage_row(index: int, o: OutageScore) -> list[Cell]:
    name = f'<button type="button" data-from="{o.start:g}" data-to="{o.end:g}">{index}</button>'
    cells = numeric(
        f"{o.start:g}\u2013{o.end:g}&nbsp;s",
        f"<b>{number(o.horizontal_max, 'm')}</b>",
        *(
            number(x, "m")
            for x in (o.horizontal_rmse, o.horizontal_end, o.along_max, o.cross_max, o.vertical_max)
        ),
        number(o.velocity_max, "m/s", 2),
        number(o.heading_max / DEG, "", 2) + "°",
        distance(o.distance),
        number(o.percent, "%", 2),
        percent(o.coverage_95),
    )
    return [name, *cells, escape(", ".join(o.labels)) or DASH]


def _pool(scores: Scores) -> str:
    s, apart = scores.horizontal, len(scores.outages) - len(scores.pool)
    words = []
    if s.count:
        figures = (("median", s.median), ("P90", s.p90), ("RMS", s.rms), ("worst", s.worst))
        words.append(
            f"Largest horizontal error over {s.count}: "
            + ", ".join(f"{name} <b>{number(value, 'm')}</b>" for name, value in figures)
            + f"; {percent(scores.coverage)} of epochs inside the stated 95&nbsp;% ellipse."
        )
    if apart:
        words.append(f"{apart} of {len(scores.outages)} set apart and left out of these figures.")
    if math.isfinite(scores.height_offset):
        side = "above" if scores.height_offset > 0.0 else "below"
        high = number(abs(scores.height_offset), "m")
        words.append(
            f"The solution lies {high} {side} the truth as a rule; vertical errors are without that."
        )
    return f"<p>{' '.join(words)}</p>"


def decisions(solution: Solution) -> str:
    """What fusion settled, and why.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    str
        HTML; "" without decisions.
    """
    if not solution.decisions:
        return ""
    rows: list[list[Cell]] = [
        [
            escape(one.name),
            (escape(decision_value(one)), "value"),
            (f'<span class="source {escape(one.source)}">{escape(one.source)}</span>', "short"),
            escape(one.evidence),
        ]
        for one in solution.decisions
    ]
    return table("Decisions and their evidence", ["Decision", "Value", "Source", "Evidence"], rows)


def innovations(solution: Solution) -> str:
    """How each channel's innovations agree with their stated size.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    str
        HTML; "" without innovations.
    """
    if not solution.innovations:
        return ""
    head: list[Cell] = [
        "Channel",
        *numeric("Count", "Mean NIS / dof", "Median NIS", "In 95&nbsp;%", "Inflated", "Rejected"),
    ]
    rows: list[list[Cell]] = []
    for name, one in solution.innovations.items():
        s = channel_statistics(one)
        figures = (number(s["mean_nis"]), number(s["median_nis"]), percent(s["within_95"]))
        counts = [f"{s[key]:,}".replace(",", "\u202f") for key in ("count", "inflated", "rejected")]
        title = channel(name, one.z.shape[1])[0].label
        rows.append([escape(title), *numeric(counts[0], *figures, *counts[1:])])
    return table("Innovation statistics", head, rows) + (
        "<p>An honest filter has a mean and a median of 1 and 95&nbsp;% inside. Inflated observations were "
        "used with a larger noise, rejected ones not at all.</p>"
    )


def states(solution: Solution) -> str:
    """Biases and other states at the end of the run.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    str
        HTML; "" without further states.
    """
    if not solution.states or not len(solution.trajectory):
        return ""
    rows: list[list[Cell]] = []
    for name, values in solution.states.items():
        shown = state(name, values.shape[1])
        sds = solution.states_sd.get(name)
        for k, axis in enumerate(shown.axes):
            sd = None if sds is None else float(sds[-1, k] / shown.scale)
            text = measured(float(values[-1, k] / shown.scale), sd, shown.unit)
            rows.append([escape(shown.label), escape(axis), (escape(text), "n")])
    return table("States at the end", ["State", "Axis", ("Value", "n")], rows)


def notes(solution: Solution, recording: Recording) -> str:
    """What was mended or noticed in the recording.

    Parameters
    ----------
    solution : Solution
    recording : Recording

    Returns
    -------
    str
        HTML: a list, or one line where nothing was.
    """
    found = solution.notes or recording.notes
    if not found:
        return "<p>Nothing had to be mended in this recording.</p>"
    items = (
        f"<li><b>{escape(note.where)}</b> {escape(note.what)}"
        + (f' <span class="quiet">({note.count:,}&times;)</span>' if note.count else "")
        + "</li>"
        for note in found
    )
    return f"<ul class=notes>{''.join(items)}</ul>"
