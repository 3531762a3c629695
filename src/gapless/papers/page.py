"""What a reproduction says in words: README.md and report.html."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape

from gapless.laboratory.tables import Table
from gapless.papers.compare import NO, NOT_RUN, OPEN, YES, ratios
from gapless.papers.experiment import Reproduction
from gapless.papers.figures import caption
from gapless.reports.numbers import duration
from gapless.reports.page import Content, Tile, render, section
from gapless.reports.tables import Cell, table

_WORDS = {"outages", "method", "claim", "label", "order", "says"}
_NAMES = {"says": "ours", "label": "of", "claim": "stated in", "outages": "window"}
"""What a column of words is called on the page."""


def readme(done: Reproduction, told: str, figures: Sequence[str]) -> str:
    """The page in Markdown.

    Parameters
    ----------
    done : Reproduction
    told : str
        Tables in Markdown.
    figures : sequence of str
        Names of the figures.

    Returns
    -------
    str
    """
    paper = done.paper
    parts = [
        f"# {paper.name}: theirs and ours",
        f"{paper.citation}: *{paper.title}*.",
        paper.idea,
        f"**{summary(done)}**",
        "## What differs, and why",
        _list(paper.differs),
        "## What the paper leaves open, and what was taken",
        _list(paper.open),
        told.strip(),
        *(["## Figures"] if figures else []),
        *(f"![{caption(name)}](figures/{name}.png)\n\n{caption(name)}." for name in figures),
    ]
    return "\n\n".join(parts) + "\n"


def page(done: Reproduction, told: Sequence[Table], figures: Mapping[str, bytes]) -> str:
    """The page as HTML that loads nothing.

    Parameters
    ----------
    done : Reproduction
    told : sequence of Table
    figures : mapping of str to bytes
        PNG by name.

    Returns
    -------
    str
    """
    paper = done.paper
    body = "".join(
        (
            section("idea", "The idea", f"<p>{escape(paper.idea)}</p>"),
            section("differs", "What differs, and why", _bullets(paper.differs)),
            section("open", "What the paper leaves open, and what was taken", _bullets(paper.open)),
            *(section(f"table{k}", one.title, _table(one)) for k, one in enumerate(told)),
            section("figures", "Figures", "".join(_figure(name, of) for name, of in figures.items())),
        )
    )
    content = Content(
        name=paper.name,
        kind="reproduction",
        lead=f"{paper.citation}: {paper.title}. {summary(done)}",
        tiles=_tiles(done),
        body=body,
        data={},
        scripts=("paper/main.js",),
    )
    return render(content)


def summary(done: Reproduction) -> str:
    """How many of the published ratios have the order that we find.

    Parameters
    ----------
    done : Reproduction

    Returns
    -------
    str
        A sentence.
    """
    count = _counts(done)
    total = sum(count.values())
    if not total:
        return "No published ratio is among what was run."
    return (
        f"Of {total} published ratios of two methods, our drives show the paper's order in {count[YES]}, the "
        f"other order in {count[NO]}; {count[OPEN]} are open, {count[NOT_RUN]} were not run."
    )


def _counts(done: Reproduction) -> dict[str, int]:
    found = [one.verdict for results in done.results for one in ratios(results)]
    return {word: found.count(word) for word in (YES, NO, OPEN, NOT_RUN)}


def _tiles(done: Reproduction) -> list[Tile]:
    count = _counts(done)
    drives = sum(r.drives for r in done.results)
    methods = {s.method for r in done.results for s in r.samples}
    return [
        ("Order as published", str(count[YES]), f"of {sum(count.values())} ratios"),
        ("Other order", str(count[NO]), "shown by the 95 % interval"),
        ("Open", str(count[OPEN]), f"and {count[NOT_RUN]} not run"),
        ("Drives", str(drives), f"{len(methods)} methods"),
        ("Wall time", duration(done.seconds), ""),
    ]


def _list(texts: Iterable[str]) -> str:
    return "\n".join(f"- {text}" for text in texts)


def _bullets(texts: Iterable[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>"


def _table(one: Table) -> str:
    words = [name in _WORDS for name in one.head]

    def cell(text: str, left: bool) -> Cell:
        return escape(text) if left else (escape(text), "n")

    head = [cell(_NAMES.get(name, name), left) for name, left in zip(one.head, words, strict=True)]
    rows = [[cell(text, left) for text, left in zip(row, words, strict=True)] for row in one.rows]
    note = f'<p class="quiet">{escape(one.note)}</p>' if one.note else ""
    return table(one.title, head, rows) + note


def _figure(name: str, image: bytes) -> str:
    said = escape(caption(name))
    source = f"data:image/png;base64,{b64encode(image).decode()}"
    return (
        f'<figure><img src="{source}" alt="{said}" style="max-width:100%;background:#fff">'
        f"<figcaption>{said}</figcaption></figure>"
    )
