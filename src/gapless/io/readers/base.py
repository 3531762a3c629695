"""What a reader is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from gapless.trip.recording import Recording


class Reader(Protocol):
    """One format that recordings come in: a file of this package, and a line in its registry."""

    name: str
    """Short name, for messages."""

    description: str
    """One line: what files, how many, what is in them."""

    def sniff(self, paths: Sequence[Path]) -> bool:
        """Whether these files look like this format, from their names and first lines.

        Parameters
        ----------
        paths : sequence of Path
            All exist.

        Returns
        -------
        bool
            Never raises on any content.
        """
        ...

    def read(self, paths: Sequence[Path]) -> Recording:
        """Read files that were sniffed.

        Parameters
        ----------
        paths : sequence of Path

        Returns
        -------
        Recording

        Raises
        ------
        RecordingError
            And nothing else, whatever the bytes.
        """
        ...
