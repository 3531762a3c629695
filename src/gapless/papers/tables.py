"""The papers' tables beside ours, as tables for terminal and page."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from gapless.evaluation.resampling import FEWEST, Interval
from gapless.laboratory.tables import Table
from gapless.papers.compare import NOT_RUN, VERDICTS, Ranking, Ratio, beside, mean, rankings, ratios
from gapless.papers.experiment import Reproduction, Results
from gapless.papers.liu2019 import CHANNELS, SNR
from gapless.papers.model import Window
from gapless.papers.published import Column, Published
from gapless.papers.studies import Signals

DASH: Final = "-"
_NOT_CAUSAL: Final = "*"
_STANDARD: Final = (
    Column("vE", "velocity_east_rmse"),
    Column("vN", "velocity_north_rmse"),
    Column("pE", "position_east_rmse"),
    Column("pN", "position_north_rmse"),
    Column("horizontal", "horizontal_rmse"),
    Column("largest", "horizontal_max"),
    Column("heading", "attitude_heading_rmse"),
)
"""What is shown of every method in every window, printed in the paper or not."""
_CHANGED: Final = _STANDARD[-3:]
"""What is told of another assumption."""


def tables(done: Reproduction) -> list[Table]:
    """All tables of a reproduction.

    Parameters
    ----------
    done : Reproduction

    Returns
    -------
    list of Table
    """
    found = [table for results in done.results for table in tables_of(results)]
    found += [_signals(s) for s in done.studies.values() if isinstance(s, Signals)]
    if done.undone:
        rows = tuple((name, reason) for name, reason in done.undone.items())
        found.append(Table("Not shown", ("method", "says"), rows))
    simulated = [r for r in done.results if r.experiment.drive is not None]
    main = [r for r in simulated if not r.experiment.aside]
    asides = [r for r in simulated if r.experiment.aside]
    return [*found, _aside(asides, main)] if asides and main else found


def tables_of(results: Results) -> list[Table]:
    """Tables of one experiment: each of the paper's beside ours, all that was measured, claims, orders.

    Parameters
    ----------
    results : Results

    Returns
    -------
    list of Table
    """
    name = results.experiment.name
    told = [_beside(results, table) for table in results.experiment.tables]
    found, orders = ratios(results), rankings(results)
    parts = [*told, *_measured(results)]
    if found:
        parts.append(_claims(name, found))
    if orders:
        parts.append(_orders(name, orders))
    if results.missing or results.failed:
        parts.append(_absent(results))
    return parts


def _beside(results: Results, table: Published) -> Table:
    """A published table, ours in the next column, row by row."""
    head = ["outages", "method"]
    for column in table.columns:
        head += [f"{column.title} paper", f"{column.title} ours"]
    rows = []
    for line in table.lines:
        samples = results.of(line.method, line.where)
        cells = [line.where, line.method]
        for column, theirs in zip(table.columns, line.values, strict=True):
            ours = span(mean(samples, column.key)) if samples else NOT_RUN
            cells += [number(theirs), ours]
        rows.append(tuple(cells))
    return Table(
        f"{results.experiment.name}: {table.label}, {table.title}",
        tuple(head),
        tuple(rows),
        f"{_units(table.columns)}. Ours: mean over {_drives(results)}{_in_brackets(results)}",
    )


def _measured(results: Results) -> Iterator[Table]:
    """Every method that ran, in every window."""
    rows = []
    for window in _windows(results):
        for method in results.experiment.methods:
            samples = results.of(method.name, window.name)
            if samples:
                cells = (span(mean(samples, column.key)) for column in _STANDARD)
                star = _NOT_CAUSAL if method.smoothed else ""
                rows.append((window.name, method.name + star, str(len(samples)), *cells))
    if not rows:
        return
    head = ("outages", "method", "n", *(column.title for column in _STANDARD))
    star = " * looks back from the end: not causal, a bound." if any("*" in row[1] for row in rows) else ""
    yield Table(
        f"{results.experiment.name}: all that was run",
        head,
        tuple(rows),
        f"{results.experiment.about} {_units(_STANDARD)}; RMSE, and the largest horizontal error. "
        f"Mean over n windows"
        f"{_in_brackets(results)}{star}",
    )


def _windows(results: Results) -> tuple[Window, ...]:
    return results.experiment.windows


def _claims(name: str, found: Sequence[Ratio]) -> Table:
    run = [one for one in found if one.verdict != NOT_RUN]
    rows = tuple(
        (
            one.claim.text, one.claim.where, f"{one.claim.better} : {one.claim.worse}",
            one.claim.key.replace("_", " "), str(one.count), number(one.claim.ratio), span(one.ours),
            number(one.size), one.verdict,
        )
        for one in run
    )  # fmt: skip
    head = ("claim", "outages", "method", "label", "n", "paper", "ours", "ours/paper", "as in the paper")
    words = "; ".join(f"{word}: {what}" for word, what in VERDICTS.items() if word != NOT_RUN)
    left = len(found) - len(run)
    more = f" {left} more are of methods that were not run." if left else ""
    note = (
        "Ratio of two methods' errors in the same windows: as published, and the geometric mean of ours with "
        f"its 95 % interval. Order as in the paper: {words}.{more}"
    )
    return Table(f"{name}: ratios and verdicts", head, rows, note)


def _orders(name: str, found: Iterable[Ranking]) -> Table:
    rows = tuple(
        (
            one.table, one.where, one.column, " < ".join(one.theirs), " < ".join(one.ours),
            "yes" if one.same else "NO",
        )
        for one in found
    )  # fmt: skip
    head = ("claim", "outages", "label", "order", "says", "same")
    note = (
        "From the smallest error to the largest; order: the paper's, says: ours, by the mean, of those run."
    )
    return Table(f"{name}: order of the methods", head, rows, note)


def _aside(asides: Sequence[Results], main: Sequence[Results]) -> Table:
    """What another assumption changes: the same seeds, error over that of the experiment it varies."""
    rows = []
    for results in asides:
        varied = _varied(results, main)
        for window in results.experiment.windows:
            for method in results.experiment.methods:
                found = [beside(results, varied, method.name, window.name, column.key) for column in _CHANGED]
                if found[0][0]:
                    cells = (span(ratio) for _, ratio in found)
                    rows.append((window.name, method.name, results.experiment.name, str(found[0][0]), *cells))
    head = ("outages", "method", "label", "n", *(column.title for column in _CHANGED))
    note = (
        "Error under the other assumption over that of the experiment that it varies, same seeds: "
        "geometric mean with its 95 % interval; 1 where it changes nothing."
    )
    return Table("What another assumption changes", head, tuple(rows), note)


def _signals(study: Signals) -> Table:
    """Table 2 of liu2019 beside ours."""
    head = ["method"]
    for channel in CHANNELS:
        head += [f"{channel} paper", f"{channel} ours"]
    rows = []
    for name, ours in study.ratios.items():
        theirs = SNR.get(name, (math.nan,) * len(CHANNELS))
        cells = [cell for pair in zip(theirs, ours, strict=True) for cell in map(number, pair)]
        rows.append((name, *cells))
    note = (
        "SNR [dB], ours 10 lg of the power of the true signal over that of what is not it, means left in, so "
        "the weight on the vertical channel counts as signal; the paper does not define its own. Whole "
        "record, which sees the future."
    )
    return Table("Table 2, signal-to-noise ratio", tuple(head), tuple(rows), note)


def _varied(aside: Results, main: Sequence[Results]) -> Results:
    """The experiment of which another one is a variation: that with the same names of windows."""
    names = {w.name for w in aside.experiment.windows}
    same = [r for r in main if {w.name for w in r.experiment.windows} == names]
    return same[0] if same else main[0]


def _absent(results: Results) -> Table:
    """Methods without a row, or with fewer windows than others, and why."""
    why: dict[str, list[str]] = {}
    for method, reason in (*results.missing.items(), *results.failed.items()):
        why.setdefault(reason, []).append(method)
    rows = (
        *((method, NOT_RUN) for method in results.missing),
        *((method, "not on every drive") for method in results.failed),
    )
    note = " ".join(f"{', '.join(methods)}: {reason}." for reason, methods in why.items())
    return Table(f"{results.experiment.name}: not run", ("method", "says"), rows, note)


def _units(columns: Iterable[Column]) -> str:
    units = dict.fromkeys(column.unit for column in columns)
    return "Units: " + ", ".join(units)


def _drives(results: Results) -> str:
    if results.experiment.drive is None:
        return f"the outages of {results.drives} recording{'s' * (results.drives > 1)}"
    return f"{results.drives} simulated drive{'s' * (results.drives > 1)}"


def _in_brackets(results: Results) -> str:
    """What stands in brackets, or why nothing does."""
    if results.experiment.drive is not None and results.drives < FEWEST:
        return f"; fewer than {FEWEST} drives give no interval."
    return "; in brackets its 95 % interval, where there are windows enough for one."


def number(value: float) -> str:
    """A number to three significant digits.

    Parameters
    ----------
    value : float

    Returns
    -------
    str
        "-" where it is unknown.
    """
    if math.isnan(value):
        return DASH
    if value == 0.0:
        return "0"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{digits}f}"


def span(value: Interval) -> str:
    """A figure with its interval, if it has one.

    Parameters
    ----------
    value : Interval

    Returns
    -------
    str
    """
    if math.isnan(value.lo):
        return number(value.value)
    return f"{number(value.value)} [{number(value.lo)}, {number(value.hi)}]"
