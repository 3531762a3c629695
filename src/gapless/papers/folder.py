"""A reproduction as files: every number, the tables, and a page that explains them."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from gapless.io.marks import MARK
from gapless.laboratory.render import as_markdown, as_text
from gapless.papers.compare import mean, rankings, ratios
from gapless.papers.experiment import Reproduction, Results
from gapless.papers.figures import is_named
from gapless.papers.page import page, readme
from gapless.papers.tables import tables
from gapless.reports.numbers import plain
from gapless.version import __version__

Writers = dict[str, Callable[[Path], object]]
"""By file name: writes the file at a path."""
FILES = ("README.md", "report.html", "tables.txt", "samples.csv", "results.csv", "results.json")
"""Names of all files but the figures."""


def figures_in(folder: Path) -> list[str]:
    """Figures that are there, or could be taken for ours.

    Parameters
    ----------
    folder : Path
        Of a reproduction.

    Returns
    -------
    list of str
    """
    return [f"figures/{p.name}" for p in sorted((folder / "figures").glob("*.png")) if is_named(p.stem)]


def writers(done: Reproduction, arguments: Mapping[str, Any], figures: Mapping[str, bytes]) -> Writers:
    """What has to be written of a reproduction.

    Parameters
    ----------
    done : Reproduction
    arguments : mapping
        Of the command.
    figures : mapping of str to bytes
        PNG by name.

    Returns
    -------
    dict of str to callable
    """
    found = tables(done)
    rows = [row for results in done.results for row in means(results)]
    texts = {
        "README.md": f"<!-- {MARK} -->\n\n{readme(done, as_markdown(found), tuple(figures))}",
        "report.html": page(done, found, figures),
        "tables.txt": f"{as_text(found)}\n{MARK}\n",
        "results.json": json.dumps(plain(about(done, arguments, rows)), indent=1, ensure_ascii=False) + "\n",
    }
    drawn: Writers = {f"figures/{name}.png": partial(_bytes, image) for name, image in figures.items()}
    return {
        **{name: partial(_text, text) for name, text in texts.items()},
        "samples.csv": partial(_csv, [row for results in done.results for row in samples(results)]),
        "results.csv": partial(_csv, rows),
        **drawn,
    }


def samples(results: Results) -> list[dict[str, Any]]:
    """Rows of `samples.csv`: every method in every window of every drive.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of dict
    """
    heads = ("experiment", "drive", "method", "where", "start", "end")
    return [{**{h: getattr(s, h) for h in heads}, **s.values} for s in results.samples]


def means(results: Results) -> list[dict[str, Any]]:
    """Rows of `results.csv`: the mean of every measure with its interval, and what was published of it.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of dict
    """
    printed = {
        (line.where, line.method, column.key): (table.label, value)
        for table in results.experiment.tables
        for line in table.lines
        for column, value in zip(table.columns, line.values, strict=True)
    }
    rows = []
    for window in results.experiment.windows:
        for method in results.experiment.methods:
            found = results.of(method.name, window.name)
            for key in (k for k in (found[0].values if found else ()) if k != "epochs"):
                one = mean(found, key)
                label, paper = printed.get((window.name, method.name, key), ("", float("nan")))
                rows.append(
                    {
                        "experiment": results.experiment.name, "where": window.name, "method": method.name,
                        "measure": key, "n": len(found), "mean": one.value, "low": one.lo, "high": one.hi,
                        "table": label, "paper": paper,
                    }
                )  # fmt: skip
    return rows


def about(done: Reproduction, arguments: Mapping[str, Any], rows: list[dict[str, Any]]) -> dict[str, Any]:
    """What `results.json` says.

    Parameters
    ----------
    done : Reproduction
    arguments : mapping
    rows : list of dict
        From `means`.

    Returns
    -------
    dict
    """
    return {
        "gapless": __version__,
        "paper": done.paper.name,
        "citation": done.paper.citation,
        "arguments": dict(arguments),
        "seconds": done.seconds,
        "experiments": [
            {
                "name": r.experiment.name,
                "about": r.experiment.about,
                "drives": r.drives,
                "not_run": {**r.missing, **r.failed},
                "claims": [
                    {**vars(one.claim), "n": one.count, "ours": one.ours.value, "low": one.ours.lo,
                     "high": one.ours.hi, "ours_over_paper": one.size, "verdict": one.verdict}
                    for one in ratios(r)
                ],
                "orders": [{**vars(one), "same": one.same} for one in rankings(r)],
            }
            for r in done.results
        ],
        "means": rows,
    }  # fmt: skip


def _text(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")


def _bytes(content: bytes, path: Path) -> None:
    path.write_bytes(content)


def _csv(rows: list[dict[str, Any]], path: Path) -> None:
    """Numbers in full; an unknown one is an empty cell."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [], lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: "" if v != v else v for k, v in row.items()} for row in rows)
