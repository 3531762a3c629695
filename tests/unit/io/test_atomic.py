"""Files that are there together or not at all, and a Ctrl-C that comes between."""

import os
import signal

import pytest

from gapless.io.writers.atomic import together, undisturbed


def write(paths, last, **more):
    with together(paths, **more) as lent:
        for path in lent:
            path.write_text("new")
        last()


def test_all_or_none(tmp_path):
    (tmp_path / "a").write_text("old")
    with pytest.raises(ZeroDivisionError):
        write([tmp_path / "a", tmp_path / "deep" / "er" / "b"], lambda: 1 / 0)
    assert [path.name for path in tmp_path.rglob("*")] == ["a"]
    assert (tmp_path / "a").read_text() == "old"


def test_an_interrupt_while_files_are_renamed_is_heard_afterwards(tmp_path, monkeypatch):
    rename = os.replace

    def interrupted(a, b):
        signal.raise_signal(signal.SIGINT)
        rename(a, b)

    monkeypatch.setattr("gapless.io.writers.atomic.os.replace", interrupted)
    called = []
    with pytest.raises(KeyboardInterrupt):
        write([tmp_path / "a", tmp_path / "b"], lambda: None, then=lambda: called.append(1))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]
    assert called == [1]


def test_the_handler_of_before_is_there_again():
    before = signal.getsignal(signal.SIGINT)
    with undisturbed():
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


def test_somebody_elses_file_keeps_a_new_folder(tmp_path):
    def theirs():
        (tmp_path / "new" / "theirs").write_text("")
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write([tmp_path / "new" / "a"], theirs)
    assert (tmp_path / "new" / "theirs").exists()
