"""Folders on this machine, or wherever fsspec reaches: `s3://bucket/study`, `memory://study`."""

from __future__ import annotations

import re
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, NamedTuple, Protocol

from gapless.errors import ConfigError, MissingExtraError, RecordingError
from gapless.io import atomic

_LOCK: Final = ".lock"
_TORN: Final = ".part"
"""Ends the temporary name of a file that is being written, here and in `gapless.io.atomic`."""


class Place(Protocol):
    """One folder; names are those of files directly in it."""

    def names(self) -> list[str]:
        """Names of the files that are whole and not hidden, in order; none where there is no folder."""

    def folders(self) -> list[str]:
        """Names of the folders in it, in order."""

    def read(self, name: str) -> bytes:
        """Content of a file."""

    def write(self, name: str, data: bytes) -> None:
        """Put a file there, whole or not at all; one of that name is replaced."""

    def remove(self, name: str) -> None:
        """Throw a file away."""

    def clean(self) -> None:
        """Throw away what was being written when a writer was killed."""

    def reserve(self) -> Any:
        """Context in which nobody else may write here."""


class Local(NamedTuple):
    """A folder on this machine.

    Parameters
    ----------
    folder : Path
    """

    folder: Path

    def names(self) -> list[str]:
        """See `Place`."""
        return self._entries(files=True)

    def folders(self) -> list[str]:
        """See `Place`."""
        return self._entries(files=False)

    def _entries(self, files: bool) -> list[str]:
        if not self.folder.is_dir():
            return []
        return sorted(p.name for p in self.folder.iterdir() if p.is_file() == files and p.name[0] != ".")

    def read(self, name: str) -> bytes:
        """See `Place`."""
        return (self.folder / name).read_bytes()

    def write(self, name: str, data: bytes) -> None:
        """See `Place`."""
        with atomic(self.folder / name) as temporary:
            temporary.write_bytes(data)

    def remove(self, name: str) -> None:
        """See `Place`."""
        (self.folder / name).unlink()

    def clean(self) -> None:
        """See `Place`."""
        for path in self.folder.glob(f".*{_TORN}"):
            if _is_torn(path.name):
                path.unlink(missing_ok=True)

    @contextmanager
    def reserve(self) -> Iterator[None]:
        """See `Place`; a lock that ends with the process, however that ends (not on Windows).

        Yields
        ------
        None

        Raises
        ------
        ConfigError
            If another process has it.
        """
        try:
            import fcntl
        except ImportError:  # Windows; there it is for the user to start one sweep only
            yield
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        with (self.folder / _LOCK).open("a") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise ConfigError(
                    f"{self.folder}: another sweep is writing to it; wait for its end or choose another --out"
                ) from None
            yield


class Remote(NamedTuple):
    """A folder of an fsspec file system.

    Parameters
    ----------
    system : fsspec.AbstractFileSystem
    folder : str
        As the file system writes it, without scheme.
    """

    system: Any
    folder: str

    def names(self) -> list[str]:
        """See `Place`."""
        return self._entries("file")

    def folders(self) -> list[str]:
        """See `Place`."""
        return self._entries("directory")

    def _entries(self, kind: str, hidden: bool = False) -> list[str]:
        self.system.invalidate_cache()
        try:
            with self._reached():
                found = self.system.ls(self.folder, detail=True)
        except FileNotFoundError:
            return []
        paths = (one["name"].strip("/") for one in found if one["type"] == kind)
        names = (path.rpartition("/")[2] for path in paths if path != self.folder.strip("/"))
        return sorted(name for name in names if name.startswith(".") == hidden)

    def read(self, name: str) -> bytes:
        """See `Place`."""
        with self._reached():
            return bytes(self.system.cat_file(f"{self.folder}/{name}"))

    def write(self, name: str, data: bytes) -> None:
        """See `Place`."""
        temporary = f"{self.folder}/.{name}.{secrets.token_hex(4)}{_TORN}"
        with self._reached():
            self.system.makedirs(self.folder, exist_ok=True)
            self.system.pipe_file(temporary, data)
            self.system.mv(temporary, f"{self.folder}/{name}")

    def remove(self, name: str) -> None:
        """See `Place`."""
        with self._reached():
            self.system.rm_file(f"{self.folder}/{name}")

    def clean(self) -> None:
        """See `Place`."""
        for name in self._entries("file", hidden=True):
            if _is_torn(name):
                self.remove(name)

    @contextmanager
    def reserve(self) -> Iterator[None]:
        """See `Place`; object stores know no lock, so here it is for the user to start one sweep only.

        Yields
        ------
        None
        """
        yield

    @contextmanager
    def _reached(self) -> Iterator[None]:
        """Whatever a file system's own library raises (no credentials, say) is one kind of error here."""
        try:
            yield
        except OSError:
            raise
        except Exception as error:
            raise OSError(f"{self.folder}: {type(error).__name__}: {error}") from error


def _is_torn(name: str) -> bool:
    """Whether a name is that of a part, a report or the like that was being written."""
    return re.fullmatch(rf"\..+\.[0-9a-f]{{8}}{re.escape(_TORN)}", name) is not None


def place(path: str) -> Place:
    """The folder that a path or a URL names.

    Parameters
    ----------
    path : str
        With a scheme (`s3://...`) it goes through fsspec.

    Returns
    -------
    Place

    Raises
    ------
    GaplessError
        If fsspec, or what it needs for the scheme, is not installed, or there is no such scheme.
    """
    if "://" not in path:
        return Local(Path(path))
    try:
        import fsspec
    except ImportError as error:
        raise MissingExtraError("fsspec", "cloud") from error
    try:
        system, folder = fsspec.core.url_to_fs(path)
    except (ImportError, ValueError) as error:
        raise ConfigError(f"{path}: {error}") from None
    return Remote(system, folder.rstrip("/"))


def held(path: str) -> tuple[Place, list[str]]:
    """The files that a path or a URL of a folder or of one file stands for.

    Parameters
    ----------
    path : str

    Returns
    -------
    place : Place
    names : list of str
        In it.

    Raises
    ------
    GaplessError
        As `place`; also if there is nothing at the path.
    """
    inside = place(path)
    names = inside.names()
    if names:
        return inside, names
    parent, slash, name = path.rstrip("/").rpartition("/")
    beside = place(f"{parent}{slash}" or ".")
    if name not in beside.names():
        raise RecordingError(f"{path}: no such file or folder, or an empty one; check the path")
    return beside, [name]
