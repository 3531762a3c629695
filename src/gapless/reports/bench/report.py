"""The page of a bench folder, made from its files alone."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from gapless.io.marks import check_ours
from gapless.io.writers.atomic import atomic
from gapless.reports.background import Feature
from gapless.reports.bench import boards
from gapless.reports.bench.folder import Bench, pools_of, read_bench
from gapless.reports.bench.outages import CURVES, SCORES, curves, outage_cards
from gapless.reports.bench.tracks import tracks
from gapless.reports.numbers import distance, duration, known, plain
from gapless.reports.page import Content, Tile, fill, render

_KINDS = 5
"""Kinds of outages that the lead names one by one."""
_SCRIPTS = ("state", "dots", "leaderboard", "pairs", "ages", "track", "cards", "details", "main")


def write_bench_report(folder: Path, background: Sequence[Feature] = (), force: bool = False) -> Path:
    """Write `report.html` into a bench folder.

    Parameters
    ----------
    folder : Path
        Where `gapless bench` wrote its results.
    background : sequence of Feature
        From `gapless.reports.background.read_background`, drawn beneath the tracks.
    force : bool
        Replace a page that gapless did not write.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    ConfigError
        If a file is missing or is not what a bench writes, or the page there is not ours.
    """
    path = Path(folder) / "report.html"
    check_ours([path], force)
    text = bench_page(read_bench(Path(folder)), background)
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


def bench_page(bench: Bench, background: Sequence[Feature] = ()) -> str:
    """The page as text.

    Parameters
    ----------
    bench : Bench
    background : sequence of Feature

    Returns
    -------
    str
        HTML.
    """
    data = bench_payload(bench, background)
    names = bench.recordings
    content = Content(
        name=names[0] if len(names) == 1 else f"{len(names)} recordings",
        kind="bench",
        lead=_lead(bench, data),
        tiles=_tiles(bench, data),
        body=fill("bench/body.html", {"tables": escape(bench.tables)}),
        data=data,
        scripts=tuple(f"bench/{name}.js" for name in _SCRIPTS),
        styles=("bench/bench.css",),
    )
    return render(content)


def bench_payload(bench: Bench, background: Sequence[Feature] = ()) -> dict[str, Any]:
    """Data of the page's scripts.

    Parameters
    ----------
    bench : Bench
    background : sequence of Feature

    Returns
    -------
    dict
        JSON-able.
    """
    cards, places = outage_cards(bench)
    ages = curves(bench, cards, places)
    drawn = tracks(bench, cards, places, background)
    told, parts = boards.runs(bench)
    facts = bench.facts
    return {
        "recordings": plain(facts["recordings"]),
        "systems": facts["systems"],
        "protocols": facts["protocols"],
        "groups": pools_of(bench.outages),
        "board": boards.rows_of(bench, bench.leaderboard),
        "pairs": boards.rows_of(bench, bench.pairs),
        "scores": SCORES,
        "columns": CURVES,
        "outages": cards,
        "ages": ages,
        "tracks": drawn,
        "runs": told,
        "parts": parts,
        "apart": boards.apart(cards),
        "prefix": boards.prefix_checks(bench),
        "embedded": f"Errors against age hold at most {ages['most']} points of each outage and system; "
        "every epoch is in ages.parquet.",
    }


def _lead(bench: Bench, data: dict[str, Any]) -> str:
    kinds = data["groups"]
    pools = "; ".join(kinds) if len(kinds) <= _KINDS else f"{len(kinds)} kinds"
    systems = ", ".join(f"\u201c{name}\u201d" for name in bench.systems)
    return f"{systems} through the same GNSS outages ({pools}), scored against the truth that was withheld."


def _tiles(bench: Bench, data: dict[str, Any]) -> list[Tile]:
    facts, cards = bench.facts, data["outages"]
    hours = sum(known(one["duration"]) for one in facts["recordings"])
    moved = sum(known(one["distance"]) for one in facts["recordings"])
    apart = sum(bool(card["labels"]) for card in cards)
    checked = sum(one["said"].startswith("held") for one in data["prefix"])
    found: list[Tile] = [
        ("Recordings", str(len(bench.recordings)), f"{duration(hours)}, {distance(moved)}"),
        ("Systems", str(len(bench.systems)), ", ".join(bench.systems)),
        ("Outages", str(len(cards)), " and ".join(map(str, facts["protocols"]))),
        ("Set apart", str(apart), "labelled, counted, not in the figures"),
    ]
    if checked:
        found.append(("Prefix checks", str(checked), "held: no look into the future"))
    if facts.get("seconds") is not None:
        runs = f"{len(data['runs'])} runs" if data["runs"] else ""
        found.append(("Wall time", duration(float(facts["seconds"])), runs))
    return found
