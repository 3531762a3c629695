"""Files that are there whole or not at all, alone or together."""

from __future__ import annotations

import os
import secrets
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def atomic(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Lend a temporary name in the same folder; rename it to `path` if the block ends well.

    Whatever ends the block otherwise, an interrupt included, the temporary file is removed and a
    file that was at `path` stays as it was.

    Parameters
    ----------
    path : str or path
        Its folder is made if it is not there, and removed again if nothing comes of it.

    Yields
    ------
    Path
        To be written to and closed within the block.
    """
    with together([path]) as (temporary,):
        yield temporary


@contextmanager
def together(
    paths: Iterable[str | os.PathLike[str]], then: Callable[[], None] | None = None
) -> Iterator[list[Path]]:
    """As `atomic`, for several files: all of them are renamed, or none.

    Parameters
    ----------
    paths : iterable of path
    then : callable, optional
        Called when all are renamed, before a Ctrl-C of that moment is heard.

    Yields
    ------
    list of Path
        Temporary names, each in the folder of its file.
    """
    wanted = [Path(path) for path in paths]
    lent = [path.with_name(f".{path.name}.{secrets.token_hex(4)}.part") for path in wanted]
    made: list[Path] = []
    try:
        for path in wanted:
            _make(path.parent, made)
        yield lent
        with undisturbed():
            for temporary, path in zip(lent, wanted, strict=True):
                os.replace(temporary, path)
            made.clear()
            if then is not None:
                then()
    finally:
        with undisturbed():
            for temporary in lent:
                with suppress(FileNotFoundError):
                    temporary.unlink()
            for folder in reversed(made):
                with suppress(OSError):  # somebody else's file is in it by now
                    folder.rmdir()


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let no Ctrl-C come between: one that comes is heard at the end of the block."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: heard.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if heard:
            signal.raise_signal(signal.SIGINT)


def _make(folder: Path, made: list[Path]) -> None:
    """Make a folder and those above it, and tell which were not there."""
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    made.extend(reversed(missing))
