"""`gapless bench`: systems against each other, on the same outages of the same recordings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from shutil import get_terminal_size
from typing import TYPE_CHECKING, Any

import click

from gapless.cli.options import force_option, out_option
from gapless.cli.screen import say

if TYPE_CHECKING:
    from gapless.laboratory.methods import Method
    from gapless.laboratory.study import Scenario, Source


@click.command(short_help="Score systems on withheld stretches of GNSS.")
@click.argument("recordings", nargs=-1, type=click.Path(path_type=Path), metavar="[RECORDING]...")
@click.option(
    "--systems",
    default="ins,constraints,auto",
    show_default=True,
    metavar="NAMES",
    help="Built-in recipes (ins, auto), smoothed or smoothed+wheels (not causal: a bound), or TOML files of "
    "your own; the others are compared with the first.",
)
@click.option(
    "--length", default="10,30,60,120", show_default=True, metavar="SECONDS", help="Lengths of the outages."
)
@click.option(
    "--every", type=float, default=180.0, show_default=True, metavar="SECONDS",
    help="From start to start; 240 at least for outages of 120 s and more.",
)  # fmt: skip
@click.option(
    "--shifts",
    default="0,60,120",
    show_default=True,
    metavar="SECONDS",
    help="Moves all outages; a run each.",
)
@click.option(
    "--first", type=float, default=240.0, show_default=True, metavar="SECONDS", help="Start of the first."
)
@click.option(
    "--plan", "plans", multiple=True, metavar="PLAN",
    help="Instead of length, every, shifts and first: 240:300, random=180,length=60,first=240, gaps=5, "
    "at=turn,every=180,length=60,first=240, each but gaps with ,effect=noisy:10 or the like. Repeatable.",
)  # fmt: skip
@click.option(
    "--protocol", type=click.Choice(["passes", "isolated", "both"]), default="passes", show_default=True,
    help="All outages of a plan in one run, or each alone.",
)  # fmt: skip
@click.option(
    "--simulated",
    metavar="PROFILE",
    help="Instead of recordings: carpark, highway, mixed, static, urban, wang2018.",
)
@click.option(
    "--grade", default="consumer", show_default=True, metavar="NAME", help="IMU of simulated drives."
)
@click.option("--runs", type=click.IntRange(min=1), default=20, show_default=True, help="Simulated drives.")
@click.option(
    "--duration",
    type=float,
    default=1800.0,
    show_default=True,
    metavar="SECONDS",
    help="Of a simulated drive.",
)
@click.option(
    "--seed", type=click.IntRange(min=0), default=1, show_default=True, metavar="N",
    help="Of simulated drives, of the samples that are checked and of the bootstrap.",
)  # fmt: skip
@click.option("--jobs", type=click.IntRange(min=1), default=2, show_default=True, help="Processes.")
@out_option
@force_option
def bench(
    recordings: tuple[Path, ...],
    systems: str,
    length: str,
    every: float,
    shifts: str,
    first: float,
    plans: tuple[str, ...],
    protocol: str,
    simulated: str | None,
    grade: str,
    runs: int,
    duration: float,
    seed: int,
    jobs: int,
    out: Path,
    force: bool,
) -> None:
    """Score systems on withheld stretches of GNSS, all on the same ones.

    Each RECORDING is a folder as for `gapless fuse`. DIR receives report.html,
    the tables (text, Markdown, LaTeX, JSON) and every outage, error and run as
    Parquet; those of an earlier bench are replaced, once the new ones are complete.
    Files that gapless did not write are in the way, but with --force.
    """
    from gapless.cli.output import check_folder, write_together
    from gapless.laboratory.folder import FILES

    arguments = {k: v for k, v in click.get_current_context().params.items() if k != "force"}
    check_folder(out, (*FILES, "report.html"), force)
    sources = _sources(recordings, simulated, grade, runs, duration, seed)
    methods = _methods(systems)
    scenarios = _scenarios(plans, length, every, shifts, first)
    protocols = ("passes", "isolated") if protocol == "both" else (protocol,)

    from gapless.cli.progress import progress
    from gapless.laboratory.bench import bench as run
    from gapless.laboratory.bench import plan_jobs
    from gapless.laboratory.folder import writers
    from gapless.laboratory.render import as_text
    from gapless.laboratory.tables import tables
    from gapless.reports.bench import write_bench_report
    from gapless.reports.summary import summarise

    count = len(plan_jobs(sources, methods, scenarios, protocols, summarise, seed))
    with progress("running", count) as tell:
        results = run(
            sources, methods, scenarios, protocols, summarise, seed=seed, processes=jobs, progress=tell
        )
    files = writers(results, {name: _told(value) for name, value in arguments.items()})
    write_together(out, files)
    page = write_bench_report(out, force=force)
    say(*as_text(tables(results), get_terminal_size((140, 24)).columns).split("\n"))
    say(f"{len(results.outages)} outages scored in {results.seconds:.0f} s")
    say(*(f"wrote {path}" for path in (*(out / name for name in files), page)))


def _told(value: Any) -> Any:
    """An argument for JSON."""
    from gapless.io.log import readable

    if isinstance(value, tuple):
        return [_told(one) for one in value]
    return readable(str(value)) if isinstance(value, Path) else value


def _sources(
    recordings: Sequence[Path], simulated: str | None, grade: str, runs: int, duration: float, seed: int
) -> Sequence[Source]:
    from gapless.errors import ConfigError
    from gapless.laboratory.study import Simulated, stored

    if (simulated is None) == (not recordings):
        raise ConfigError("give recordings, or --simulated with the name of a profile, and not both")
    if simulated is None:
        return stored(recordings)

    from gapless.sensors import grade as known_grade
    from gapless.simulate.profiles import profile

    profile(simulated), known_grade(grade)
    if not 0.0 < duration < float("inf"):
        raise ConfigError(f"--duration {duration:g}: give a positive number of seconds")
    return tuple(Simulated(simulated, grade, duration, seed + k) for k in range(runs))


def _methods(systems: str) -> Sequence[Method]:
    return tuple(_method(name.strip()) for name in systems.split(","))


def _method(name: str) -> Method:
    from gapless.laboratory.recipes import Recipe, smoothed
    from gapless.systems.adjust import named

    first, _, behind = name.partition("+")
    if first == "smoothed":
        return smoothed(named(behind or "constraints"), name)
    return Recipe(named(name))


def _scenarios(
    plans: Sequence[str], length: str, every: float, shifts: str, first: float
) -> Sequence[Scenario]:
    from gapless.laboratory.study import ladder, scenario

    if plans:
        return tuple(scenario(text) for text in plans)
    return ladder(_numbers("--length", length), every, _numbers("--shifts", shifts), first)


def _numbers(option: str, text: str) -> list[float]:
    from gapless.errors import ConfigError

    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise ConfigError(f"{option} {text}: write numbers with commas, like 10,30,60") from None
