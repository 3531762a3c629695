"""Where compiled kernels are kept, and what is done where they cannot be."""

import os

import numpy as np
import pytest

from gapless import _numba


def twice(x):
    return 2.0 * x


@pytest.fixture
def places(tmp_path, monkeypatch):
    """The user's cache, and one under the temporary folder."""
    found = (tmp_path / "home" / "v", tmp_path / "temporary" / "v")
    monkeypatch.setattr(_numba, "_places", lambda: found)
    monkeypatch.setattr(_numba, "_said", set())
    return found


def files(place):
    return sorted(place.iterdir()) if place.is_dir() else []


def test_a_kernel_is_compiled_once_and_that_is_said(places, capfd):
    assert _numba.kernel(twice)(1.5) == 3.0
    assert capfd.readouterr().err == "gapless: compiling kernels, once per version (about ten seconds)\n"
    assert [path.suffix for path in files(places[0])] == [".nbc"]
    _numba._said.clear()
    assert _numba.kernel(twice)(1.5) == 3.0
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(
    "damage", [lambda data: b"", lambda data: data[:3000], lambda data: bytes(len(data))]
)
def test_a_damaged_one_is_removed_and_made_anew(places, capfd, damage):
    _numba.kernel(twice)(1.5)
    (path,) = files(places[0])
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    _numba._said.clear()
    capfd.readouterr()
    assert _numba.kernel(twice)(1.5) == 3.0
    said = capfd.readouterr().err
    assert said == f"gapless: removed damaged kernels in {places[0]}; compiling kernels again\n"
    assert len(path.read_bytes()) == len(whole)


def test_without_room_they_are_kept_elsewhere_or_in_memory(places, capfd, monkeypatch):
    places[0].parent.write_text("a file where a folder should be")
    assert _numba.kernel(twice)(1.5) == 3.0
    said = capfd.readouterr().err.splitlines()
    assert said[1].startswith(f"gapless: kernels cannot be kept in {places[0]} (")
    assert said[1].endswith(f"; they are in {places[1]}")
    assert len(files(places[1])) == 1

    def full(path, content):
        raise OSError(28, os.strerror(28), str(path))

    monkeypatch.setattr(_numba, "_write", full)
    _numba._said.clear()
    assert _numba.kernel(twice)(np.arange(3.0))[2] == 4.0  # another signature
    said = capfd.readouterr().err.splitlines()
    assert said[1] == (
        f"gapless: kernels cannot be kept in {places[0]} (No space left on device); "
        "they are compiled in memory, in each run"
    )
    assert len(said) == 2


def test_nobody_need_hear_it(places, monkeypatch):
    monkeypatch.setattr("sys.stderr", None)
    assert _numba.kernel(twice)(1.5) == 3.0


@pytest.mark.skipif(os.name == "nt", reason="folders have no owners there")
def test_the_temporary_folder_must_be_the_users_own(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path))
    own = tmp_path / f"gapless-{os.getuid()}"
    assert _numba._temporary() == own
    own.mkdir(mode=0o700)
    assert _numba._temporary() == own
    own.chmod(0o777)
    assert _numba._temporary() is None
    own.rmdir()
    own.symlink_to(tmp_path)
    assert _numba._temporary() is None
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("TMPDIR", raising=False)
    own.unlink()
    assert _numba._temporary() is None  # the user's work is there
