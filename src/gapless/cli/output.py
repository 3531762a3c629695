"""Files of one run, written together or not at all."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack, suppress
from pathlib import Path

from gapless.errors import ConfigError


def check_folder(folder: Path) -> None:
    """Refuse a place that cannot be a folder before any work is done for it.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    ConfigError
        If it, or a part of its path, is a file.
    """
    for part in (folder, *folder.parents):
        if part.exists():
            if not part.is_dir():
                raise ConfigError(f"{part}: is a file, not a folder; choose another --out")
            return


def write_together(
    folder: Path, files: Mapping[str, Callable[[Path], object]], own: Iterable[str] = ()
) -> list[str]:
    """Write files under temporary names, then rename them all.

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
        What was removed.
    """
    from gapless.io.writers.atomic import atomic

    there = folder.exists()
    try:
        with ExitStack() as stack:
            for name, write in files.items():
                write(stack.enter_context(atomic(folder / name)))
    except BaseException:
        if not there:
            with suppress(OSError):  # somebody else's file is in it by now
                folder.rmdir()
        raise
    stale = [name for name in own if name not in files and (folder / name).is_file()]
    for name in stale:
        (folder / name).unlink()
    return stale
