"""`gapless convert`: a log in any format that is read, a recording folder out."""

from __future__ import annotations

from pathlib import Path

import click

from gapless.cli.options import force_option, out_option
from gapless.cli.screen import say


@click.command(short_help="Turn a log into a recording folder.")
@click.argument("log", nargs=-1, required=True, type=click.Path(path_type=Path))
@out_option
@force_option
def convert(log: tuple[Path, ...], out: Path, force: bool) -> None:
    """Turn a LOG into a recording folder.

    LOG is the two text files of a KF-GINS log, or a recording folder; what can be
    mended is mended, and said. DIR receives imu.parquet, gnss.parquet and
    recording.toml, where axes, lever arm and sensor grade can be set. A recording
    that DIR holds already is kept, but for one of this very LOG.
    """
    from gapless.cli.output import check_recording, digest, write_together

    origin = digest("convert", [_stamp(file) for path in log for file in (path, *sorted(path.glob("*")))])
    check_recording(out, origin, force)

    from gapless.cli.describe import describe, notes
    from gapless.io import read
    from gapless.io.writers.recording import check_free, recording_files

    found = read(*log)
    files = recording_files(found, origin)
    check_free(out, files)
    write_together(out, files)
    say(*describe(found), *notes(found), "", f"wrote {out}")


def _stamp(path: Path) -> tuple[str, int, int]:
    """Tells a file from another, and from itself at another time; a folder by its name alone."""
    try:
        found = path.stat()
    except OSError:  # the reader will say it
        return str(path), 0, 0
    whole = path.is_file()
    return str(path.resolve()), found.st_size * whole, found.st_mtime_ns * whole
