"""Where the recording of a run comes from: a simulated drive, or files that a fingerprint holds fast."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory

from msgspec import Struct

from gapless.errors import RecordingError, SweepError
from gapless.io import read
from gapless.simulate import simulate
from gapless.sweeps.places import held
from gapless.trip.recording import Recording


class Simulated(Struct, frozen=True, tag="simulated", tag_field="kind"):
    """A simulated drive; the seed is the run's.

    Parameters
    ----------
    profile : str
        How it is driven.
    grade : str
        Of the IMU.
    duration : float
        At most this long [s].
    """

    profile: str
    grade: str
    duration: float

    def recording(self, seed: int) -> Recording:
        """Drive it.

        Parameters
        ----------
        seed : int

        Returns
        -------
        Recording
        """
        return simulate(self.profile, self.grade, self.duration, seed)


class Logged(Struct, frozen=True, tag="logged", tag_field="kind"):
    """A recording in files, here or behind a URL; `logged` makes one.

    Parameters
    ----------
    paths : tuple of str
        A folder, or the files of one trip. Where they lie does not count in a run's key.
    fingerprint : str
        SHA-256 of names and contents, in hexadecimal.
    """

    paths: tuple[str, ...]
    fingerprint: str

    def recording(self, seed: int) -> Recording:
        """Read it.

        Parameters
        ----------
        seed : int
            Of no use here.

        Returns
        -------
        Recording

        Raises
        ------
        RecordingError
            If it cannot be read.
        SweepError
            If it is not there, or not what it was when the run was planned: no result of this run.
        """
        try:
            now = fingerprint(self.paths)
        except RecordingError as error:
            raise SweepError(f"{error}; a worker must see what the study names") from None
        if now != self.fingerprint:
            raise SweepError(f"{self.paths[0]}: has changed since the study was planned; run it again")
        if not any("://" in path for path in self.paths):
            return read(*self.paths)
        with TemporaryDirectory(prefix="gapless-") as folder:
            try:
                return read(*(_fetch(path, Path(folder)) for path in self.paths))
            except RecordingError as error:  # a temporary name says nothing to the user
                raise RecordingError(str(error).replace(folder, self.paths[0].rpartition("/")[0])) from None


def logged(*paths: str) -> Logged:
    """A recording as its files are now.

    Parameters
    ----------
    *paths : str
        A folder, or the files of one trip; with a scheme (`s3://...`) they go through fsspec.

    Returns
    -------
    Logged

    Raises
    ------
    GaplessError
        If there is nothing at a path, or fsspec is needed and not installed.
    """
    return Logged(paths, fingerprint(paths))


def fingerprint(paths: Sequence[str]) -> str:
    """SHA-256 of the names and contents of a recording's files, wherever they lie.

    Parameters
    ----------
    paths : sequence of str

    Returns
    -------
    str
        Hexadecimal.
    """
    digest = hashlib.sha256()
    for path in paths:
        inside, names = held(path)
        digest.update(f"{_base(path)}\n{len(names)}\n".encode())
        for name in names:
            content = hashlib.sha256(inside.read(name)).hexdigest()
            digest.update(f"{name}\n{content}\n".encode())
    return digest.hexdigest()


@lru_cache(maxsize=2)
def recording(source: Simulated | Logged, seed: int) -> Recording:
    """The recording of a run; the last two of this process are kept, since systems share them.

    Parameters
    ----------
    source : Simulated or Logged
    seed : int

    Returns
    -------
    Recording
    """
    return source.recording(seed)


def _base(path: str) -> str:
    return path.rstrip("/").rpartition("/")[2]


def _fetch(path: str, folder: Path) -> Path:
    """Bring a path's files here; one that is here already is copied, so that errors read alike."""
    inside, names = held(path)
    home = folder / _base(path)
    if names == [_base(path)]:
        home.write_bytes(inside.read(names[0]))
        return home
    home.mkdir()
    for name in names:
        (home / name).write_bytes(inside.read(name))
    return home
