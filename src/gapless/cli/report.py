"""`gapless report`: the page again, from the results alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gapless.cli.options import force_option
from gapless.cli.screen import say

if TYPE_CHECKING:
    from gapless.reports.background import Feature


@click.command(short_help="Make the page again, from the results alone.")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option(
    "--background",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="GeoJSON of lines and polygons, drawn faintly beneath the tracks.",
)
@click.option(
    "--figures",
    type=click.Choice(["png", "pdf"]),
    help="Write figures for a paper into DIR/figures too (a bench only; needs matplotlib).",
)
@force_option
def report(folder: Path, background: Path | None, figures: str | None, force: bool) -> None:
    """Make DIR/report.html again from what gapless bench wrote into DIR.

    A folder of gapless fuse will do as well, if it has no page: the page shows
    what solution.parquet and summary.json hold. Files that gapless did not write
    are in the way, but with --force.
    """
    from gapless.errors import ConfigError
    from gapless.reports.again import LEFT_OUT, is_run, write_again
    from gapless.reports.background import read_background
    from gapless.reports.bench.folder import is_bench

    ground = [] if background is None else read_background(background)
    if is_bench(folder):
        written = _of_bench(folder, ground, figures, force)
    elif not is_run(folder):
        raise ConfigError(
            f"{folder}: no results in it; give the --out folder of gapless bench or gapless fuse"
        )
    elif figures is not None:
        raise ConfigError(f"{folder}: --figures draws a bench; this is one run of gapless fuse")
    else:
        written = [write_again(folder, ground, force)]
        say(f"without {LEFT_OUT}: only gapless fuse has them")
    say(*(f"wrote {path}" for path in written))


def _of_bench(folder: Path, ground: list[Feature], figures: str | None, force: bool) -> list[Path]:
    from gapless.reports.bench import write_bench_report

    if figures is None:
        return [write_bench_report(folder, ground, force)]
    from gapless.reports.bench.figures import check_figures, write_figures

    check_figures(folder, figures, force)
    return [write_bench_report(folder, ground, force), *write_figures(folder, figures, force)]
