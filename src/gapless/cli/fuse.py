"""`gapless fuse`: a recording in, a solution, its summary and its report out."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gapless.cli.options import force_option, job, job_options, out_option
from gapless.cli.screen import say

if TYPE_CHECKING:
    from gapless.cli.options import Job
    from gapless.evaluation import Scores
    from gapless.reports.background import Feature
    from gapless.trip.recording import Recording
    from gapless.trip.solution import Solution

FORMATS = {
    "csv": "every column, as text",
    "kml": "for Google Earth",
    "geojson": "for maps",
    "gpx": "the track",
}
"""What is written besides Parquet where it is asked for."""
OWN = (*(f"solution.{name}" for name in ("parquet", *FORMATS)), "summary.json", "report.html")
"""Names that are this verb's: a file of an earlier run under one of them would pass for this run's."""


def _formats(command: Callable[..., Any]) -> Callable[..., Any]:
    for name, what in reversed(FORMATS.items()):
        command = click.option(f"--{name}", name, is_flag=True, help=f"Write solution.{name} too: {what}.")(
            command
        )
    return command


@click.command(short_help="Fuse a recording into a trajectory.")
@job_options
@out_option
@click.option(
    "--rate",
    type=click.FloatRange(min=0.0, min_open=True),
    default=10.0,
    show_default=True,
    metavar="HZ",
    help="Rows of the solution per second.",
)
@click.option(
    "--smooth", is_flag=True, help="Let what came later correct what came before: for post-processing."
)
@click.option(
    "--save-model",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Keep what the bridge learned, for a recipe's learner.model, or what was heard of the car's wheels, "
    "for bridge.parameters.vehicle: arrays and JSON, nothing that runs.",
)
@click.option("--vehicle", is_flag=True, help="Write the attitude of the car instead of the box's.")
@_formats
@click.option("--no-report", is_flag=True, help="Do not write report.html.")
@click.option(
    "--background",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="GeoJSON of lines and polygons, drawn faintly beneath the track of report.html.",
)
@force_option
def fuse(
    out: Path,
    rate: float,
    smooth: bool,
    save_model: Path | None,
    vehicle: bool,
    no_report: bool,
    background: Path | None,
    force: bool,
    **rest: Any,
) -> None:
    """Fuse a RECORDING into a trajectory with honest uncertainties.

    RECORDING is a folder with imu and gnss logs, or the two text files of a
    KF-GINS log. DIR receives solution.parquet, summary.json and report.html;
    those of an earlier run are replaced, once all the new ones are complete, or
    removed where this run does not write them. Files that gapless did not write
    are in the way, but with --force.
    """
    from gapless.cli.output import check_folder, write_together

    chosen = [name for name in FORMATS if rest.pop(name)]
    names = [f"solution.{name}" for name in ("parquet", *chosen)]
    names += ["summary.json", *["report.html"] * (not no_report)]
    check_folder(out, names, force)
    if save_model is not None:
        _check_model(save_model, [out / name for name in names], force)
    ground = _background(background, no_report)
    work = job(**rest)
    solution, scores = _navigate(work, rate, smooth)
    files: dict[str, Callable[[Path], object]] = {}
    if save_model is not None:
        files[str(save_model.absolute())] = partial(_write_bytes, _model(solution, save_model))
    if vehicle:
        from gapless.runs.vehicle import vehicle_attitude

        solution = vehicle_attitude(solution)

    from gapless.reports.summary import summarise
    from gapless.reports.terminal import summary_lines

    summary = summarise(solution, scores)
    files |= _solution_files(solution, chosen) | {"summary.json": partial(_write_json, summary)}
    if not no_report:
        files["report.html"] = partial(_write_report, solution, work.recording, scores, ground)
    told = write_together(out, files, OWN)
    say(*summary_lines(summary), "", *(f"wrote {out / name}" for name in files), *told)


def _background(path: Path | None, no_report: bool) -> list[Feature]:
    from gapless.errors import ConfigError

    if path is None:
        return []
    if no_report:
        raise ConfigError("--background is for report.html; leave out --no-report")
    from gapless.reports.background import read_background

    return read_background(path)


def _navigate(work: Job, rate: float, smooth: bool) -> tuple[Solution, Scores | None]:
    """Solution, and scores where there is something to score it against."""
    from gapless.cli.progress import progress
    from gapless.errors import ConfigError
    from gapless.runs.fuse import fuse
    from gapless.runs.smooth import smooth as smoothed

    most = work.recording.imu.rate
    if not rate <= most * 1.01:
        raise ConfigError(f"--rate {rate:g}: the IMU has {most:.4g} samples a second; ask for no more")
    if smooth and work.causal:
        raise ConfigError("--smooth looks back and --causal never ahead; give one of them")
    with progress("fusing", work.recording.duration) as tell:
        if smooth:
            solution = smoothed(work.recording, work.system, work.outages, rate, tell)
        else:
            solution = fuse(work.recording, work.system, work.outages, rate, work.causal, tell)
    if work.recording.reference is None and not work.outages:
        return solution, None

    from gapless.evaluation import score

    return solution, score(solution, work.recording)


def _check_model(path: Path, others: Iterable[Path], force: bool) -> None:
    """Refuse a place for a model that is taken by anything else."""
    from gapless.errors import ConfigError
    from gapless.io.marks import check_ours, is_model

    if path.resolve() in [other.resolve() for other in others]:
        raise ConfigError(f"--save-model {path}: this run writes that file itself; give another name")
    check_ours([path], force, is_model)


def _model(solution: Solution, path: Path) -> bytes:
    from gapless.errors import ConfigError

    if not solution.learned:
        raise ConfigError(
            f"--save-model {path}: no bridge has learned; choose a --system that has one, and let an outage "
            "begin after half a minute of fixes (--outage START:END), or set bridge.train"
        )
    from gapless.bridges.comb import Memory
    from gapless.bridges.vehicle import written
    from gapless.learners.saved import dumps

    learned = solution.learned[0]
    return written(learned) if isinstance(learned, Memory) else dumps(learned)


def _write_bytes(content: bytes, path: Path) -> None:
    path.write_bytes(content)


def _solution_files(solution: Solution, chosen: Iterable[str]) -> dict[str, Callable[[Path], object]]:
    from gapless.io.writers import WRITERS

    return {f"solution.{name}": partial(WRITERS[name].write, solution) for name in ("parquet", *chosen)}


def _write_json(summary: dict[str, Any], path: Path) -> None:
    path.write_text(json.dumps(summary, indent=1, ensure_ascii=False, allow_nan=False) + "\n", "utf-8")


def _write_report(
    solution: Solution, recording: Recording, scores: Scores | None, ground: list[Feature], path: Path
) -> None:
    from gapless.reports.report import page

    path.write_text(page(solution, recording, scores, background=ground), "utf-8")
