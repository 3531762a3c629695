"""`gapless reproduce`: a paper's experiment again, its tables beside ours."""

from __future__ import annotations

from pathlib import Path
from shutil import get_terminal_size
from typing import TYPE_CHECKING

import click

from gapless.cli import interrupt
from gapless.cli.options import force_option, out_option
from gapless.cli.screen import say

if TYPE_CHECKING:
    from gapless.papers.experiment import Reproduction


@click.command(short_help="Run a paper's experiment again, its tables beside ours.")
@click.argument("paper", metavar="PAPER")
@click.argument("more", nargs=-1, type=click.Path(path_type=Path), metavar="[PATH]...")
@click.option(
    "--recordings", "first", multiple=True, type=click.Path(path_type=Path), metavar="PATH...",
    help="Real recordings, for the paper's road test: folders as for gapless fuse, one after the other.",
)  # fmt: skip
@click.option(
    "--seeds", type=click.IntRange(min=0), metavar="N",
    help="Simulated drives, instead of as many as the paper is given (100 for wang2018); 0 for none.",
)  # fmt: skip
@click.option("--jobs", type=click.IntRange(min=1), default=2, show_default=True, help="Processes.")
@out_option
@force_option
def reproduce(
    paper: str,
    more: tuple[Path, ...],
    first: tuple[Path, ...],
    seeds: int | None,
    jobs: int,
    out: Path,
    force: bool,
) -> None:
    """Run the experiments of a PAPER again and put its tables beside ours.

    PAPER is wang2018, liu2019, georges2015, aslinezhad2020 or tan2015. DIR receives
    README.md and report.html, which say what differs and why, the tables, every
    number (CSV, JSON) and the figures; those of an earlier run are replaced. Files
    that gapless did not write are in the way, but with --force. An interrupted
    command goes on where it stopped: until its end, DIR/unfinished keeps what is
    done.
    """
    from gapless.cli.output import check_folder, write_together
    from gapless.papers.folder import FILES, figures_in

    check_folder(out, (*FILES, *figures_in(out)), force)

    from gapless.cli.progress import progress
    from gapless.laboratory.render import as_text
    from gapless.laboratory.study import stored
    from gapless.papers.experiment import reproduce as run
    from gapless.papers.folder import writers
    from gapless.papers.kept import FOLDER, forget
    from gapless.papers.library import paper as known
    from gapless.papers.page import summary
    from gapless.papers.tables import tables

    found, sources = known(paper), stored((*first, *more))
    _look(first + more)
    kept = out / FOLDER
    try:
        with progress("running", 100.0) as tell, interrupt.plainly():
            done = run(found, seeds, sources, processes=jobs, progress=tell, kept=kept)
    except KeyboardInterrupt:
        if not kept.is_dir():
            raise
        _interrupted(kept)
    drawn = _drawn(done)
    arguments = {"paper": paper, "recordings": [str(p) for p in (*first, *more)], "seeds": seeds}
    files = writers(done, arguments, drawn)
    stale = write_together(out, files, own=(*FILES, *figures_in(out)))
    forget(kept)
    say(*as_text(tables(done), get_terminal_size((140, 24)).columns).split("\n"))
    say(*summary(done).split("\n"), *(f"wrote {out / name}" for name in files), *stale)


def _interrupted(kept: Path) -> None:
    """Say what is left, and that it is no debris."""
    told = f"what is done is kept in {kept}; the same command goes on from there"
    say("", f"gapless: interrupted; {told}", err=True)
    click.get_current_context().exit(interrupt.INTERRUPTED)


def _look(paths: tuple[Path, ...]) -> None:
    """Refuse what is not there before hours of work are done."""
    from gapless.errors import RecordingError

    for path in paths:
        if not path.exists():
            raise RecordingError(f"{path}: no such file or folder; check the path")


def _drawn(done: Reproduction) -> dict[str, bytes]:
    """Figures, or one line that says why there are none."""
    from gapless.errors import MissingExtraError
    from gapless.papers.figures import figures

    try:
        return figures(done)
    except MissingExtraError as error:
        say(f"no figures: {error}", err=True)
        return {}
