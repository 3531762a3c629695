"""Processes end when whoever started them does, however that happens."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from gapless.laboratory.pool import in_order

PARENT = """
import sys, time
from pathlib import Path
from gapless.laboratory.pool import in_order
sys.path.insert(0, {here!r})
from test_pool import stay

if __name__ == "__main__":
    list(in_order(stay, [{folder!r}] * 2, 2))
"""


def stay(folder):
    """Say who one is, and do not end by oneself."""
    with open(os.path.join(folder, f"{os.getpid()}.pid"), "w"):
        pass
    time.sleep(600.0)


def square(x):
    return x * x


def fail(x):
    raise ValueError(x)


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    with open(f"/proc/{pid}/stat") as stat:
        return stat.read().rsplit(")", 1)[1].split()[0] != "Z"  # ended, and nobody has asked yet


def until(true, seconds=60.0):
    """Wait for something to come true; starting processes takes seconds on a busy machine."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.parametrize("processes", [1, 2])
def test_outcomes_are_in_the_order_of_the_jobs(processes):
    told = []
    assert list(in_order(square, [3, 1, 2], processes, told.append)) == [9, 1, 4]
    assert told == [1.0, 2.0, 3.0]


def test_what_goes_wrong_in_one_ends_all():
    with pytest.raises(ValueError, match="7"):
        list(in_order(fail, [7], 2))


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs /proc to tell what still runs")
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_no_process_outlives_its_parent(tmp_path, how):
    script = tmp_path / "parent.py"
    script.write_text(PARENT.format(here=os.path.dirname(__file__), folder=str(tmp_path)))
    parent = subprocess.Popen([sys.executable, str(script)])
    until(lambda: len(list(tmp_path.glob("*.pid"))) == 2 or parent.poll() is not None)
    assert parent.poll() is None
    workers = [int(path.stem) for path in tmp_path.glob("*.pid")]
    parent.send_signal(how)
    parent.wait()
    until(lambda: not any(map(alive, workers)))
