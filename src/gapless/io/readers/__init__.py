"""Formats that are read. To add one: a file with a `Reader`, and a line in `READERS`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from gapless.errors import RecordingError
from gapless.io.readers.base import Reader
from gapless.io.readers.folder import Folder
from gapless.io.readers.kfgins import KfGins
from gapless.trip.recording import Recording

READERS: Final[tuple[Reader, ...]] = (
    Folder(),
    KfGins(),
)
"""In the order in which they are asked; the first that recognises the files reads them."""


def read(*paths: str | os.PathLike[str]) -> Recording:
    """Read a recording in any format we know.

    Parameters
    ----------
    *paths : str or path
        A recording folder, or the files of one trip in any order.

    Returns
    -------
    Recording
        Its notes say what was mended.

    Raises
    ------
    RecordingError
        If a path does not exist, no format fits, or the data cannot be used as they are.
    """
    given = [Path(path) for path in paths]
    for path in given:
        if not path.exists():
            raise RecordingError(f"{path}: no such file or folder; check the path")
    for reader in READERS:
        if reader.sniff(given):
            return reader.read(given)
    known = "; ".join(f"{reader.name}: {reader.description}" for reader in READERS)
    named = " ".join(map(str, given)) or "no path"
    raise RecordingError(f"{named}: not a format that gapless reads; it reads {known}")
