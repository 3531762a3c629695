"""Whole sweeps that are killed, interrupted and robbed of a worker: the rows are the same."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from studies import ENVIRONMENT, rows, stored, study, uninterrupted

import gapless as gp
from gapless.errors import ConfigError

RUNS = 16
"""The first part is stored with the first run that ends: long enough to be killed in the middle of."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The study, and what it finds where nothing happens."""
    folder = tmp_path_factory.mktemp("whole")
    path = study(folder, seeds=RUNS // 2)
    tally = uninterrupted(path, folder / "out")
    assert (tally.total, tally.there, tally.fresh) == (RUNS, 0, RUNS)
    assert tally.done == RUNS
    return path, rows(folder / "out")


def started(path, out):
    """`gapless sweep` in a process group of its own, with something stored and something to do."""
    command = [sys.executable, "-m", "gapless", "sweep", path, "--jobs", "2", "--out", out]
    process = subprocess.Popen(
        command,
        env=ENVIRONMENT,
        start_new_session=True,
        stderr=subprocess.PIPE,
        text=True,
        # tests that are run in the background are deaf to interrupts, and so would be what they start
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not list(out.glob("study=*/part-*.parquet")):
        assert process.poll() is None
        time.sleep(0.02)
    return process


def children(pid):
    return [int(c) for c in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def gone(pid):
    """Whether a process has ended; one that nobody waits for stays as a zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return True


def resumed(whole, out):
    """Go on, and compare with what an uninterrupted study found."""
    path, expected = whole
    before = len(stored(out))
    assert 0 < before < RUNS
    tally = gp.sweep(path, out, jobs=2)
    assert (tally.there, tally.fresh) == (before, RUNS - before)
    assert len(stored(out)) == len(set(stored(out))) == RUNS
    assert rows(out) == expected


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks for child processes in /proc")
def test_killed_and_resumed(whole, tmp_path):
    process = started(whole[0], tmp_path)
    workers = children(process.pid)
    assert len(workers) >= 2
    process.kill()
    process.communicate()
    deadline = time.monotonic() + 30.0  # they end at once, on a machine that is not stuck
    while not all(map(gone, workers)):
        assert time.monotonic() < deadline, "workers outlive their parent"
        time.sleep(0.02)
    resumed(whole, tmp_path)


def test_interrupted_and_resumed(whole, tmp_path):
    process = started(whole[0], tmp_path)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: parent and workers alike
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    (line,) = (one for one in told.strip().splitlines() if "compiling kernels" not in one)
    found = re.fullmatch(
        r"gapless: interrupted; (\d+) of 16 runs are stored in .*; the same .* from there", line
    )
    assert found, told
    assert int(found[1]) == len(stored(tmp_path))
    resumed(whole, tmp_path)


class Cluster:
    """A dask scheduler and two workers on loopback, each a process."""

    def __init__(self, folder):
        self.file = folder / "scheduler.json"
        self.processes = [self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-show")]
        while not self.file.exists() or not self.file.read_text():
            assert self.processes[0].poll() is None
            time.sleep(0.05)
        for _ in range(2):
            limits = ("--nthreads", "1", "--no-nanny", "--local-directory", folder)
            self.processes.append(self._start("worker", "--host", "127.0.0.1", *limits))

    def _start(self, kind, *words):
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--scheduler-file", self.file]
        return subprocess.Popen(
            [*command, "--no-dashboard", *words], env=ENVIRONMENT, stderr=subprocess.DEVNULL
        )

    def address(self):
        from distributed import Client

        with Client(scheduler_file=str(self.file), set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
            return client.scheduler_info()["address"].removeprefix("tcp://")

    def end(self):
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path_factory):
    pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    made = Cluster(tmp_path_factory.mktemp("cluster"))
    yield made
    made.end()


def test_a_cluster_that_loses_a_worker(whole, cluster, tmp_path):
    path, expected = whole
    address = cluster.address()

    def tell(tally):
        if tally.fresh == RUNS // 2:
            cluster.processes[-1].kill()

    tally = gp.sweep(path, tmp_path, f"dask://{address}", tell=tell)
    assert cluster.processes[-1].wait() == -signal.SIGKILL
    assert (tally.done, tally.failed) == (RUNS, 0)
    assert len(stored(tmp_path)) == len(set(stored(tmp_path))) == RUNS
    assert rows(tmp_path) == expected


def test_no_cluster_at_that_address(whole, tmp_path, monkeypatch):
    pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    monkeypatch.setattr("gapless.sweeps.workers.ANSWER", 0.5)
    with pytest.raises(ConfigError, match="no dask scheduler answers"):
        gp.sweep(whole[0], tmp_path, "dask://127.0.0.1:1")


def test_equal_runs_are_done_once(tmp_path):
    path = study(
        tmp_path, seeds=1, runs='[{ simulated = { seeds = [1], duration = 100 }, scenario = "65:90" }]'
    )
    tally = uninterrupted(path, tmp_path / "out")
    assert (tally.total, tally.there, tally.done) == (3, 1, 2)


def test_a_store_holds_what_other_studies_found(tmp_path):
    for name in ("first", "second"):
        uninterrupted(study(tmp_path, seeds=1, name=name), tmp_path / "out")
    assert sorted(set(gp.read_sweep(tmp_path / "out")["study"].to_pylist())) == ["first", "second"]
