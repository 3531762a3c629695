"""One log file as it stands: named columns of numbers, and the row each came from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from gapless.errors import RecordingError
from gapless.trip.recording import Array, Note


def readable(name: str) -> str:
    """A file's name as text: bytes that are not UTF-8 are shown as unknown characters.

    Parameters
    ----------
    name : str
        As the system gives it.

    Returns
    -------
    str
    """
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


@dataclass(frozen=True, eq=False)
class Log:
    """Columns of one log, in the units of its format, before anything is mended.

    Parameters
    ----------
    where : str
        File or frame, as the user would name it in an error.
    columns : dict of str to ndarray, shape (n,)
        Numbers; NaN where a cell is empty. Every column is as long as `time`.
    first_row : int
        What the user's editor calls the first row of data: 1, or 2 below a header.
    rows : ndarray of int, shape (n,), optional
        The same for each row, where comments or blank lines lie between them.
    """

    where: str
    columns: dict[str, Array]
    first_row: int = 1
    rows: NDArray[np.int64] | None = None

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()))) if self.columns else 0

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def row(self, k: int) -> str:
        """Place of a row, as "file:row".

        Parameters
        ----------
        k : int
            Index from 0.

        Returns
        -------
        str
        """
        return f"{self.where}:{self.number(k)}"

    def number(self, k: int) -> int:
        """What the user's editor calls a row.

        Parameters
        ----------
        k : int
            Index from 0.

        Returns
        -------
        int
        """
        return self.first_row + k if self.rows is None else int(self.rows[k])

    def stack(self, names: Sequence[str]) -> Array:
        """Columns side by side.

        Parameters
        ----------
        names : sequence of str

        Returns
        -------
        ndarray, shape (n, len(names))
            NaN columns for those that the log does not have.
        """
        out = np.full((len(self), len(names)), np.nan)
        for j, name in enumerate(names):
            if name in self.columns:
                out[:, j] = self.columns[name]
        return out

    def take(self, index: Any) -> Log:
        """Rows chosen by a mask or indices, each still knowing its place in the file.

        Parameters
        ----------
        index : ndarray

        Returns
        -------
        Log
        """
        rows = self.first_row + np.arange(len(self)) if self.rows is None else self.rows
        return Log(self.where, {k: v[index] for k, v in self.columns.items()}, self.first_row, rows[index])

    def require(self, names: Iterable[str]) -> None:
        """Refuse a log that lacks a column, has it empty, or has fewer than two rows.

        Parameters
        ----------
        names : iterable of str

        Raises
        ------
        RecordingError
        """
        names = list(names)
        missing = [name for name in names if name not in self.columns]
        if missing:
            found = ", ".join(self.columns) or "none of the known ones"
            self.refuse(
                f"no column {', '.join(missing)} (found {found})", f"name the columns {', '.join(names)}"
            )
        if len(self) < 2:
            self.refuse(
                f"{len(self) or 'no'} row{'s' * (len(self) != 1)} of data", "give a log of two rows or more"
            )
        for name in names:
            if not np.isfinite(self.columns[name]).any():
                self.refuse(f"column {name} holds no number", "log that sensor, or remove the file")

    def together(self, names: Sequence[str]) -> bool:
        """Whether the log has a group of columns that only make sense together.

        Parameters
        ----------
        names : sequence of str

        Returns
        -------
        bool
            False if it has none of them.

        Raises
        ------
        RecordingError
            If it has some, but not all.
        """
        missing = [name for name in names if name not in self.columns]
        if missing and len(missing) < len(names):
            there = ", ".join(name for name in names if name not in missing)
            self.refuse(f"{there} without {', '.join(missing)}", "log all of them, or none")
        return not missing

    def note(self, what: str, count: int = 0) -> Note:
        """Something mended or noticed in this log.

        Parameters
        ----------
        what : str
        count : int
            Rows it touched.

        Returns
        -------
        Note
            Under the file's name, without its folder.
        """
        return Note(readable(PurePath(self.where).name), what, count)

    def refuse(self, what: str, cure: str, k: int | None = None) -> NoReturn:
        """Raise the one line that a user reads: where, what, and what next.

        Parameters
        ----------
        what, cure : str
            Clauses without a full stop.
        k : int, optional
            Index of the row at fault.

        Raises
        ------
        RecordingError
        """
        raise RecordingError(f"{self.where if k is None else self.row(k)}: {what}; {cure}")
