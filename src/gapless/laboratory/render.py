"""Tables as text, Markdown and LaTeX."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from gapless.laboratory.tables import Table


def as_text(found: Iterable[Table], width: int = 140) -> str:
    """Tables for a terminal.

    Parameters
    ----------
    found : iterable of Table
    width : int
        Columns of the terminal: a wider table goes on below, its first columns repeated.

    Returns
    -------
    str
    """
    import textwrap

    parts = []
    for table in found:
        blocks = [_lines(table, columns) for columns in _folded(table, width)]
        note = textwrap.wrap(table.note, min(width, 110))
        parts.append("\n".join([table.title, "\n\n".join(blocks), *note]))
    return "\n\n".join(parts) + "\n"


def _widths(table: Table) -> list[int]:
    return [max(len(line[i]) for line in (table.head, *table.rows)) for i in range(len(table.head))]


def _folded(table: Table, width: int) -> list[list[int]]:
    """Columns of each block: the names that a row begins with, then as many more as there is room for."""
    widths, words = _widths(table), _words(table)
    keys = list(range(words.index(False) if False in words else 1))
    blocks = [list(keys)]
    for column in range(len(keys), len(widths)):
        room = width - sum(widths[i] + 2 for i in blocks[-1])
        if widths[column] > room and len(blocks[-1]) > len(keys):
            blocks.append(list(keys))
        blocks[-1].append(column)
    return blocks


def _lines(table: Table, columns: Sequence[int]) -> str:
    widths, words = _widths(table), _words(table)
    pad: list[Callable[[str, int], str]] = [str.ljust if w else str.rjust for w in words]
    body = [
        "  ".join(pad[i](line[i], widths[i]) for i in columns).rstrip() for line in (table.head, *table.rows)
    ]
    body.insert(1, "-" * max(len(line) for line in body))
    return "\n".join(body)


def _words(table: Table) -> list[bool]:
    """Columns that hold words stand left."""
    left = {"outages", "system", "label", "says", "outcome", "recordings", "method", "claim", "order"}
    return [name in left for name in table.head]


def as_markdown(found: Iterable[Table]) -> str:
    """Tables in Markdown.

    Parameters
    ----------
    found : iterable of Table

    Returns
    -------
    str
    """
    parts = []
    for table in found:
        rule = ["---" if words else "---:" for words in _words(table)]
        lines = [" | ".join(_escaped(cell) for cell in line) for line in (table.head, *table.rows)]
        lines.insert(1, " | ".join(rule))
        body = "\n".join(f"| {line} |" for line in lines)
        parts.append(f"## {table.title}\n\n{body}\n" + (f"\n{_escaped(table.note)}\n" if table.note else ""))
    return "\n".join(parts)


def _escaped(cell: str) -> str:
    return cell.replace("|", "\\|").replace("*", "\\*").replace("<", "&lt;")


def as_latex(found: Iterable[Table]) -> str:
    """Tables in LaTeX, for the package booktabs.

    Parameters
    ----------
    found : iterable of Table

    Returns
    -------
    str
    """
    parts = []
    for table in found:
        columns = "".join("l" if words else "r" for words in _words(table))
        lines = [" & ".join(_tex(cell) for cell in line) + r" \\" for line in (table.head, *table.rows)]
        parts.append(
            "\n".join(
                [
                    r"\begin{table}",
                    rf"\caption{{{_tex(table.title)}. {_tex(table.note)}}}".replace(". }", ".}"),
                    rf"\begin{{tabular}}{{{columns}}}",
                    r"\toprule",
                    lines[0],
                    r"\midrule",
                    *lines[1:],
                    r"\bottomrule",
                    r"\end{tabular}",
                    r"\end{table}",
                ]
            )
        )
    return "\n\n".join(parts) + "\n"


_TEX: Final = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
    "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"$<$",
}  # fmt: skip


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in text)
