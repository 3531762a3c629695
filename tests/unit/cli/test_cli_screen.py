"""Text for any terminal, and interrupts at any moment."""

import os
import signal
import subprocess
import sys
from contextlib import suppress

import pytest
from command_line import COMPILING

from gapless.cli import interrupt, screen

WORDS = [sys.executable, "-m", "gapless"]


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "cp437", "ascii"])
def test_what_an_encoding_lacks_is_written_otherwise(encoding):
    text = "'\\u22121.5\\u00a0\\u00b0 \\u00b1 2 \\u2013 \\u5317'"
    script = f"from gapless.cli import screen; screen.prepare(); screen.say({text})"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, env=os.environ | {"PYTHONIOENCODING": encoding}
    )
    assert done.stderr == b""
    said = done.stdout.decode(encoding)
    assert said.startswith("-1.5")
    assert said.endswith("?\n")


def test_names_move_no_cursor_and_begin_no_line(capsys):
    screen.say("\x1b]0;owned\x07\x1b[2Jx\n\ngapless: all is well\r", "b\u202e\x9b1m\udcff")
    assert capsys.readouterr().out == "?]0;owned??[2Jx??gapless: all is well?\nb??1m?\n"


def test_the_name_of_a_recording_is_one_of_them(shell, drive, tmp_path):
    import shutil

    copy = shutil.copytree(drive, tmp_path / "copy")
    (copy / "recording.toml").write_text('name = "a\\u001b[2J\\nb"\n')
    said = shell("convert", copy, "--out", tmp_path / "out").stdout
    assert said.splitlines()[0].startswith("a?[2J?b · ")


@pytest.mark.parametrize("closed", [1, 2])
def test_a_closed_stream_ends_nothing(drive, tmp_path, closed):
    words = [*WORDS, "convert", drive, "--out", tmp_path / "out"]
    done = subprocess.run(words, capture_output=True, preexec_fn=lambda: os.close(closed))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "recording.toml").exists()
    assert b"Traceback" not in done.stdout + done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_full_and_broken_pipes_are_no_tracebacks(drive, tmp_path):
    words = [*WORDS, "convert", drive, "--out", tmp_path / "out"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    told = "gapless: standard output: No space left on device; the files are written\n"
    assert done.stderr.removeprefix(COMPILING) == told
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(words, stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert (done.returncode, done.stderr.removeprefix(COMPILING)) == (0, "")


@pytest.fixture
def process():
    """This process as `gapless` would have it, and back."""
    before, hook = signal.getsignal(signal.SIGINT), sys.unraisablehook
    signal.signal(signal.SIGINT, interrupt.leave_at_once)
    yield
    signal.signal(signal.SIGINT, before)
    sys.unraisablehook = hook
    interrupt._heard = interrupt._late = False


def interrupted_kernel():
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise SystemError("CPUDispatcher returned a result with an exception set") from None


def test_an_interrupt_in_a_kernel_is_one(process):
    with pytest.raises(KeyboardInterrupt), interrupt.listening():
        interrupted_kernel()


def test_a_swallowed_interrupt_is_raised_before_files_are_there(process, tmp_path):
    from gapless.cli.output import write_together

    def write(path):
        path.write_text("new")
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt), interrupt.listening():
        write_together(tmp_path / "out", {"a.txt": write})
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_after_that_comes_too_late(process, tmp_path):
    from gapless.cli.output import write_together

    with interrupt.listening():
        write_together(tmp_path, {"a.txt": lambda path: path.write_text("new")})
        signal.raise_signal(signal.SIGINT)
    signal.raise_signal(signal.SIGINT)
    assert (tmp_path / "a.txt").read_text() == "new"


def test_an_interrupt_while_loading(tmp_path):
    """The command line is not there yet, but a Ctrl-C is answered as later on."""
    script = (
        "import os, signal, sys, types; from gapless.__main__ import main\n"
        "class Slow:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'gapless.cli': os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Slow()); main()"
    )
    heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # noqa: E731
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, preexec_fn=heard)
    assert (done.returncode, done.stderr) == (130, f"gapless: {interrupt.UNCHANGED}\n")
