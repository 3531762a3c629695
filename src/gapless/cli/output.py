"""Files of one run, written together or not at all, and never over what is somebody else's."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from gapless.cli import interrupt
from gapless.errors import ConfigError


def check_folder(folder: Path, names: Iterable[str] = (), force: bool = False) -> None:
    """Refuse a place that cannot be written to before any work is done for it.

    Parameters
    ----------
    folder : Path
    names : iterable of str
        Files that may be written into it.
    force : bool
        Let them replace files that gapless did not write.

    Raises
    ------
    ConfigError
        If it, or a part of its path, is a file, or a file that is not ours is in it under one of the names.
    """
    for part in (folder, *folder.parents):
        if part.exists():
            if not part.is_dir():
                raise ConfigError(f"{part}: is a file, not a folder; choose another --out")
            if not os.access(part, os.W_OK):
                raise ConfigError(f"{part}: cannot be written to; choose another --out")
            break
    if folder.is_dir():
        from gapless.io.marks import check_ours

        check_ours((folder / name for name in names), force)


def check_recording(folder: Path, origin: str, force: bool) -> None:
    """Refuse a folder with a recording of another origin: a log is not measured twice.

    Parameters
    ----------
    folder : Path
    origin : str
        Of what will be written: see `gapless.io.marks.in_toml`.
    force : bool
        Replace it.

    Raises
    ------
    GaplessError
    """
    from gapless.io.marks import origin_in
    from gapless.io.writers.recording import SENSORS, SETTINGS, check_free

    files = [*(f"{sensor}.parquet" for sensor in SENSORS), SETTINGS]
    check_free(folder, files)
    check_folder(folder, files, force)
    there = next((folder / name for name in files if (folder / name).exists()), None)
    if there is not None and not force and origin_in(folder / SETTINGS) != origin:
        raise ConfigError(
            f"{there}: belongs to a recording that this command did not make; "
            "choose another --out, or replace it with --force"
        )


def digest(*told: object) -> str:
    """What something was made of, in sixteen hexadecimal digits.

    Parameters
    ----------
    *told : object
        Whose `repr` says all.

    Returns
    -------
    str
    """
    from hashlib import sha256

    return sha256(repr(told).encode("utf-8", "surrogateescape")).hexdigest()[:16]


def write_together(
    folder: Path, files: Mapping[str, Callable[[Path], object]], own: Iterable[str] = ()
) -> list[str]:
    """Write files under temporary names, then rename them all; from then on Ctrl-C comes too late.

    Parameters
    ----------
    folder : Path
        Made if it is not there, and removed again if nothing comes of it.
    files : mapping of str to callable
        By name: writes the file at a path that it is given.
    own : iterable of str
        Names of which those that are not written now are removed at the end: they belong to other results.

    Returns
    -------
    list of str
        What became of those, a clause each: one that gapless did not write stays.
    """
    from gapless.io.marks import is_ours
    from gapless.io.writers.atomic import together

    with together((folder / name for name in files), then=interrupt.too_late) as lent:
        for write, temporary in zip(files.values(), lent, strict=True):
            write(temporary)
        interrupt.check()
    told = []
    for path in (folder / name for name in own if name not in files and (folder / name).is_file()):
        if is_ours(path):
            path.unlink()
            told.append(f"removed {path}, of an earlier run")
        else:
            told.append(f"left {path}, which gapless did not write")
    return told
