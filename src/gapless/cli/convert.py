"""`gapless convert`: a log in any format that is read, a recording folder out."""

from __future__ import annotations

from pathlib import Path

import click

from gapless.cli.options import out_option


@click.command(short_help="Turn a log into a recording folder.")
@click.argument("log", nargs=-1, required=True, type=click.Path(path_type=Path))
@out_option
def convert(log: tuple[Path, ...], out: Path) -> None:
    """Turn a LOG into a recording folder.

    LOG is the two text files of a KF-GINS log, or a recording folder; what can be
    mended is mended, and said. DIR receives imu.parquet, gnss.parquet and
    recording.toml, where axes, lever arm and sensor grade can be set.
    """
    from gapless.cli.output import check_folder

    check_folder(out)

    from gapless.cli.describe import describe, notes
    from gapless.io import read, write_recording

    found = read(*log)
    write_recording(found, out)
    click.echo("\n".join([*describe(found), *notes(found), "", f"wrote {out}"]))
