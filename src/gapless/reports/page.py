"""One self-contained page for any kind of result: what stands on it, its data and its scripts."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files
from string import Template
from typing import Any, NamedTuple

from gapless.version import __version__

Tile = tuple[str, str, str]
"""A headline figure: title, value, note."""
_SHARED = ("core", "theme", "view", "rows", "plot", "gestures", "map")
_STYLES = ("vendor/uPlot.min.css", "shared/page.css", "shared/parts.css")


class Content(NamedTuple):
    """What one page shows.

    Parameters
    ----------
    name : str
        Title.
    kind : str
        Beside the word "gapless" above it.
    lead : str
        One sentence below it.
    tiles : sequence of (str, str, str)
        Headline figures.
    body : str
        HTML between header and footer.
    data : object
        For the scripts, JSON-able.
    scripts : tuple of str
        Assets that run after the shared ones, in order.
    styles : tuple of str
        Assets besides the shared ones.
    verdict : str
        What must be known before anything else is read; "" where there is nothing.
    """

    name: str
    kind: str
    lead: str
    tiles: Sequence[Tile]
    body: str
    data: Any
    scripts: tuple[str, ...]
    styles: tuple[str, ...] = ()
    verdict: str = ""


def render(content: Content) -> str:
    """The page as text.

    Parameters
    ----------
    content : Content

    Returns
    -------
    str
        HTML that loads nothing from anywhere.
    """
    scripts = (*(f"shared/{name}.js" for name in _SHARED), *content.scripts)
    return Template(asset("page.html")).substitute(
        name=escape(content.name),
        kind=escape(content.kind),
        lead=escape(content.lead),
        verdict=f'<p class="verdict">{escape(content.verdict)}</p>' if content.verdict else "",
        tiles=_tiles(content.tiles),
        body=content.body,
        style=_style(content.styles),
        vendor=f"/*! uPlot\n{asset('vendor/uPlot.LICENSE')}*/\n{asset('vendor/uPlot.iife.min.js')}",
        script="\n".join(map(asset, scripts)),
        data=embedded(content.data),
        version=escape(__version__),
    )


def fill(name: str, parts: Mapping[str, str]) -> str:
    """A template among the assets, with its parts in place.

    Parameters
    ----------
    name : str
    parts : mapping of str to str
        HTML.

    Returns
    -------
    str
    """
    return Template(asset(name)).substitute(parts)


def section(key: str, title: str, body: str) -> str:
    """A titled section.

    Parameters
    ----------
    key : str
        Its id.
    title : str
    body : str
        HTML.

    Returns
    -------
    str
        "" where the body is empty.
    """
    return f'<section id="{key}"><h2>{escape(title)}</h2>{body}</section>' if body else ""


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


def asset(name: str) -> str:
    """A file of the page.

    Parameters
    ----------
    name : str
        Path under `assets`.

    Returns
    -------
    str
    """
    return files("gapless.reports").joinpath("assets", *name.split("/")).read_text(encoding="utf-8")


def _style(more: Iterable[str]) -> str:
    """All style sheets; the dark colours stand both for a dark system and for the reader's choice."""
    dark = asset("shared/dark.css")
    themes = (
        f'@media (prefers-color-scheme: dark) {{ :root:not([data-theme="light"]) {{ {dark} }} }}',
        f':root[data-theme="dark"] {{ {dark} }}',
    )
    return "\n".join([*map(asset, _STYLES), *themes, *map(asset, more), asset("shared/print.css")])


def _tiles(tiles: Iterable[Tile]) -> str:
    return "".join(
        f"<div><dt>{escape(title)}</dt><dd><strong>{_small_units(value)}</strong>"
        f"<span>{escape(note)}</span></dd></div>"
        for title, value, note in tiles
    )


def _small_units(text: str) -> str:
    """Words and units of a headline figure, escaped and set smaller than its digits."""
    return re.sub(r"([^\W\d_][\w/]*|%)", r"<small>\1</small>", escape(text))
