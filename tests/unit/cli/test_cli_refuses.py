"""What a user can mend is one line on stderr and exit code 2, with nothing written."""

import errno
import os
import signal
import subprocess
import sys

import pytest
from command_line import COMPILING

from gapless.io.writers import WRITERS, Writer

REFUSED = {
    "no such recording": (["nowhere"], "nowhere: no such file or folder"),
    "outage of no form": (["{drive}", "--outage", "240-300"], "outage '240-300'"),
    "outage after the end": (["{drive}", "--outage", "1000:1060"], "lasts 160 s"),
    "outages that overlap": (["{drive}", "--outage", "50:80", "--outage", "70:90"], "overlap"),
    "unknown constraint": (["{drive}", "--without", "wheels"], "choose from zero_velocity, nonholonomic"),
    "unknown system": (["{drive}", "--system", "magic"], "choose from aslinezhad2020"),
    "no such config": (["{drive}", "--config", "none.toml"], "none.toml"),
    "clock of nothing": (["{drive}", "--clock", "sun=1"], "choose from position, velocity, odometer"),
    "clock without a number": (["{drive}", "--clock", "position"], "write it like position=-0.15"),
    "clock far off": (["{drive}", "--clock", "position=20"], "clock offset of position, 20 s"),
    "rate beyond the ticks": (["{drive}", "--rate", "400"], "--rate 400"),
    "rate that is no number": (["{drive}", "--rate", "nan"], "--rate nan"),
    "outages without end": (["{drive}", "--outages", "every=1e-9,length=1e-10,first=1"], "less than 1 s"),
    "mounting of no state": (["{drive}", "--system", "ins", "--vehicle"], "no mounting angles"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_one_line_and_nothing_written(shell, drive, tmp_path, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    words, cure = REFUSED[case]
    said = shell("fuse", *(w.format(drive=drive) for w in words), "--out", "out", code=2)
    assert said.stdout == ""
    assert said.stderr.startswith("gapless: ")
    assert said.stderr.count("\n") == 1
    assert cure in said.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("verb", ["fuse", "convert", "simulate"])
def test_a_file_in_the_way_is_found_before_the_work(shell, drive, tmp_path, verb):
    (tmp_path / "out").write_text("mine")
    words = [] if verb == "simulate" else [drive]
    said = shell(verb, *words, "--out", tmp_path / "out" / "deeper", code=2).stderr
    # click checks the last part of the path, we the parts before it
    assert said == f"gapless: {tmp_path / 'out'}: is a file, not a folder; choose another --out\n"
    assert (tmp_path / "out").read_text() == "mine"


def fails_late(error):
    """A CSV writer that fails when half is written."""

    def write(solution, path):
        path.write_text("time,lat")
        raise error

    return Writer("fails", write)


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "disk"), 2, "disk: No space left on device"),
        (KeyboardInterrupt(), 130, "interrupted; no file was changed"),
    ],
)
def test_files_of_a_run_are_replaced_together_or_not_at_all(
    shell, drive, tmp_path, monkeypatch, error, code, line
):
    monkeypatch.setitem(WRITERS, "csv", fails_late(error))
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "solution.parquet").write_text("old")
    for name in ("old", "new"):
        said = shell("fuse", drive, "--csv", "--force", "--out", tmp_path / name, code=code)
        assert said.stderr == f"gapless: {line}\n"
    assert [p.name for p in tmp_path.rglob("*")] == ["old", "solution.parquet"]
    assert (tmp_path / "old" / "solution.parquet").read_text() == "old"


def hears_interrupts():
    """Tests that are run in the background are deaf to them, and so would be what they start."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_ctrl_c_in_a_real_process(drive, tmp_path):
    script = (
        "import sys, time, gapless.runs.fuse as systems\n"
        "from gapless.cli import main\n"
        "def slow(*_): print('ready', flush=True); time.sleep(60)\n"
        "systems.fuse = slow\n"
        "main()"
    )
    words = [sys.executable, "-c", script, "fuse", str(drive), "--out", str(tmp_path / "out")]
    pipe = subprocess.PIPE
    with subprocess.Popen(words, stdout=pipe, stderr=pipe, text=True, preexec_fn=hears_interrupts) as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=30)
    assert process.returncode == 130
    assert said.removeprefix(COMPILING) == "gapless: interrupted; no file was changed\n"
    assert not (tmp_path / "out").exists()


def test_our_own_mistakes_are_not_hidden(shell, drive, tmp_path, monkeypatch):
    monkeypatch.setitem(WRITERS, "csv", fails_late(ZeroDivisionError("a bug")))
    with pytest.raises(ZeroDivisionError):
        shell("fuse", drive, "--csv", "--out", tmp_path)
    assert list(tmp_path.iterdir()) == []
