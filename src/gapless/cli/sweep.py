"""`gapless sweep`: thousands of runs, resumable."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from gapless.cli import interrupt
from gapless.cli.options import force_option
from gapless.cli.screen import say

if TYPE_CHECKING:
    from gapless.sweeps.conduct import Tally, Tell
    from gapless.sweeps.study import Plan

SHOWN: Final = 20
"""Runs that --dry-run names."""


@click.command(short_help="Do a study of many runs, and go on where it stopped.")
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--executor",
    default="processes",
    show_default=True,
    metavar="WHERE",
    help="processes, or dask://HOST:PORT for the scheduler of a cluster.",
)
@click.option(
    "--jobs", type=click.IntRange(min=1), metavar="N", help="Number of processes; one a core if not given."
)
@click.option("--out", metavar="DIR", help="Folder of the results, or a URL such as s3://bucket/results.")
@click.option("--retry", is_flag=True, help="Do failed runs again; refused ones stay as they are.")
@click.option("--dry-run", is_flag=True, help="Say what the runs are, and do none.")
@force_option
def sweep(
    study: Path,
    executor: str,
    jobs: int | None,
    out: str | None,
    retry: bool,
    dry_run: bool,
    force: bool,
) -> None:
    """Do all runs of a STUDY, a TOML file that docs/sweeps.md explains.

    DIR receives one Parquet row a run, with its outages, in study=NAME. Rows that
    are there already are not done again: the same command goes on after any end.
    """
    from gapless.errors import ConfigError
    from gapless.sweeps.study import plan_study

    plan = plan_study(study)
    if dry_run:
        say(*_plan_lines(plan))
        return
    if out is None:
        raise ConfigError("--out is missing; give a folder for the results, or --dry-run")

    import gc

    from gapless.sweeps.conduct import sweep as conduct

    gc.enable()  # `main` does without, for runs that end before it pays
    told: list[Tally] = []
    try:
        with interrupt.plainly():
            tally = conduct(plan, out, executor, jobs, retry, _teller(told), force)
    except KeyboardInterrupt:
        _interrupted(told, len(plan), out)
    say(*(line.replace("\u00a0", " ") for line in _result_lines(plan, tally, out)))


def _interrupted(told: list[Tally], total: int, out: str) -> None:
    stored = told[-1].there + told[-1].fresh if told else 0
    known = f"{stored} of {total} runs are stored in {out}" if told else f"what was done is stored in {out}"
    say("", f"gapless: interrupted; {known}; the same command goes on from there", err=True)
    click.get_current_context().exit(interrupt.INTERRUPTED)


def _teller(told: list[Tally]) -> Tell:
    """Keeps the last tally; shows it on stderr, twice a second to a person, once a minute to a log."""
    import time

    watched = sys.stderr.isatty()
    start, pause, shown = ("\r\x1b[K", 0.5, [0.0]) if watched else ("", 60.0, [time.monotonic()])

    def tell(tally: Tally) -> None:
        told[:] = [tally]
        if time.monotonic() - shown[0] > pause:
            shown[0] = time.monotonic()
            line = _progress(tally).replace("\u00a0", " ")
            if watched:
                click.echo(start + line, err=True, nl=False)
            else:
                say(line, err=True)

    return tell


def _progress(tally: Tally) -> str:
    from gapless.reports.numbers import duration

    troubles = "".join(f", {n} {word}" for word in ("refused", "failed") if (n := getattr(tally, word)))
    return (
        f"{tally.there + tally.fresh} of {tally.total} runs{troubles} · "
        f"{tally.throughput:.1f} drive-hours per minute · {duration(tally.left)} left"
    )


def _plan_lines(plan: Plan) -> Iterator[str]:
    from itertools import islice

    from gapless.sweeps.run import label
    from gapless.sweeps.sources import Simulated

    yield f"study {plan.name}: {len(plan)} runs"
    for run in islice(plan, SHOWN):
        source = run.source
        if isinstance(source, Simulated):
            what = f"{source.profile} {source.grade} {source.duration:g} s seed {run.seed}"
        else:
            what = " ".join(source.paths)
        recipe = " ".join(filter(None, (run.system.name, label(run.override))))
        yield f"  {run.key[:8]}  {what} · {' '.join(run.scenario) or 'open sky'} · {recipe}"
    if len(plan) > SHOWN:
        yield f"  and {len(plan) - SHOWN} more"


def _result_lines(plan: Plan, tally: Tally, out: str) -> Iterator[str]:
    from gapless.reports.numbers import duration, number, percent
    from gapless.sweeps.store import read
    from gapless.sweeps.summary import COLUMNS, summary

    if sys.stderr.isatty():
        click.echo("\r\x1b[K", err=True, nl=False)
    yield (
        f"{plan.name}: {tally.fresh} runs in {duration(tally.elapsed)}, "
        f"{tally.throughput:.1f} drive-hours per minute; {tally.there} were there"
    )
    lines = summary(read(out, studies=[plan.name], columns=COLUMNS), {run.key for run in plan})
    names = [" ".join(filter(None, (line.system, line.override))) for line in lines]
    width = max(map(len, [*names, "system"]))
    heads = ("runs", "refused", "failed", "outages", "median", "P95", "worst", "in 95 %")
    yield ""
    yield f"  {'system':<{width}}" + _cells(*heads)
    for name, line in zip(names, lines, strict=True):
        figures = [*(number(x, "m") for x in (line.median, line.p95, line.worst)), percent(line.coverage_95)]
        counts = map(str, (line.runs, line.refused, line.failed, line.outages))
        yield f"  {name:<{width}}" + _cells(*counts, *figures)
    yield "  Largest horizontal error of an outage: median, P95 and worst of a run; share"
    yield "  of truth inside the stated 95 % ellipses. Of each the median over runs."


def _cells(*texts: str) -> str:
    return "".join(f"{text:>{width}}" for text, width in zip(texts, (6, 8, 7, 8, 9, 9, 9, 9), strict=True))
