"""The store: whole parts or none, here and behind a URL."""

import subprocess
import sys

import fsspec
import pytest
from studies import ENVIRONMENT, rows, run, stored, study, uninterrupted

import gapless as gp
from gapless.errors import ConfigError, MissingExtraError
from gapless.sweeps.execute import blank, execute
from gapless.sweeps.places import Local, held, place
from gapless.sweeps.run import Run
from gapless.sweeps.sources import logged
from gapless.sweeps.store import Store, opened, read

DYING = """
import os, signal, sys
from studies import uninterrupted
from gapless.sweeps import store

study, out, when = sys.argv[1:]
store.PATIENCE = 0.0  # every row is a part
renamed, replace = 0, os.replace

def dying(*names):
    global renamed
    ours = str(names[1]).startswith(out)  # kernels that are compiled are renamed too
    renamed += ours
    if ours and renamed == 3 and when == "before":
        os.kill(os.getpid(), signal.SIGKILL)
    replace(*names)
    if ours and renamed == 3:
        os.kill(os.getpid(), signal.SIGKILL)

os.replace = dying
uninterrupted(study, out)
"""


@pytest.mark.parametrize(("when", "there"), [("before", 2), ("after", 3)])
def test_killed_beside_the_renaming(tmp_path, when, there):
    path, out = study(tmp_path, seeds=3), tmp_path / "out"
    killed = subprocess.run([sys.executable, "-c", DYING, path, out, when], env=ENVIRONMENT)
    assert killed.returncode == -9
    assert len(stored(out)) == there
    assert len(list(out.rglob(".*.part"))) == (when == "before")
    tally = uninterrupted(path, out)
    assert (tally.there, tally.fresh) == (there, 6 - there)
    assert len(stored(out)) == len(set(stored(out))) == 6
    assert not list(out.rglob(".*.part"))
    uninterrupted(path, tmp_path / "whole")
    assert rows(out) == rows(tmp_path / "whole")


@pytest.fixture(scope="module")
def results():
    """One with outages, one without any, one refused."""
    return [execute(run(1)), execute(run(1, scenario=())), execute(run(1, profile="static"))]


@pytest.mark.parametrize("url", ["", "memory://", "file://"])
def test_rows_come_back(tmp_path, results, url):
    folder = f"{url}{tmp_path}"
    for name, part in (("one", results[:2]), ("two", results[2:])):
        with opened(folder, name) as store:
            for row in part:
                store.add(row)
    table = read(folder)
    assert sorted(table["key"].to_pylist()) == sorted(row.key for row in results)
    assert {*zip(table["study"].to_pylist(), table["outcome"].to_pylist(), strict=True)} == {
        ("one", "done"), ("two", "refused")
    }  # fmt: skip
    (outage,) = read(folder, "outages").to_pylist()
    assert {key: outage[key] for key in results[0].each[0]} == results[0].each[0]
    assert (outage["key"], outage["study"]) == (results[0].key, "one")
    assert read(folder, studies=["two"], columns=["reason"]).to_pylist() == [
        {"study": "two", "key": results[2].key, "reason": results[2].reason}
    ]
    with opened(folder, "one") as store:
        assert store.keys() == {row.key for row in results[:2]}


def test_what_was_taken_is_stored_whatever_ends_the_block(tmp_path, results):
    def interrupted():
        with opened(str(tmp_path), "one") as store:
            store.add(results[0])
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert stored(tmp_path) == [results[0].key]


def test_flushing_again_gives_the_same_part(tmp_path, results):
    for _ in range(2):  # as if the first had been interrupted after its renaming
        store = Store(Local(tmp_path / "study=one"))
        store.add(results[0])
        store.flush()
    assert stored(tmp_path) == [results[0].key]


@pytest.mark.parametrize("url", ["", "memory://"])
def test_failed_rows_can_be_forgotten(tmp_path, results, url):
    folder = f"{url}{tmp_path}"
    for bad in (blank(run(7), "failed", "because"), blank(run(8), "failed", "because")):
        with opened(folder, "one") as store:
            store.add(bad)
            for row in results if bad.seed == 7 else []:
                store.add(row)
    assert len(read(folder)) == 5
    with opened(folder, "one") as store:
        store.forget_failed()
        assert store.keys() == {row.key for row in results}
    assert len(read(folder, "outages")) == 1


def test_torn_files_are_cleaned_behind_a_url_too(tmp_path):
    where = place(f"file://{tmp_path}")
    (tmp_path / ".part-1.parquet.12ab34cd.part").write_bytes(b"PAR1")
    (tmp_path / "part-2.parquet").write_bytes(b"whole")
    where.clean()
    assert [p.name for p in tmp_path.iterdir()] == ["part-2.parquet"]


def test_one_sweep_at_a_time(tmp_path):
    with (
        opened(str(tmp_path), "one"),
        pytest.raises(ConfigError, match="another sweep is writing"),
        opened(str(tmp_path), "one"),
    ):
        pass
    with opened(str(tmp_path), "one"):
        pass


def test_reading_what_is_not_there(tmp_path, results):
    with pytest.raises(ConfigError, match="no results of a sweep"):
        read(str(tmp_path))
    with opened(str(tmp_path), "one") as store:
        store.add(results[0])
    with pytest.raises(ConfigError, match="no study 'two'; it holds one"):
        read(str(tmp_path), studies=["two"])
    (tmp_path / "study=one" / "part-0.parquet").write_bytes(b"nonsense")
    with pytest.raises(ConfigError, match=r"part-0\.parquet: damaged"):
        read(str(tmp_path))


def test_columns_that_came_later_are_null_in_older_parts(tmp_path, results):
    import pyarrow.parquet as pq

    with opened(str(tmp_path), "one") as store:
        store.add(results[0])
    (part,) = tmp_path.glob("study=one/part-*")
    old = pq.ParquetFile(part).read().drop_columns(["coverage_open_95"])
    pq.write_table(old, part)
    with opened(str(tmp_path), "one") as store:
        store.add(blank(run(2), "failed", "because"))
    assert None in read(str(tmp_path))["coverage_open_95"].to_pylist()


@pytest.fixture
def drive(tmp_path):
    gp.write_recording(gp.simulate_drive("urban", "consumer", 100.0), tmp_path / "drive")
    return tmp_path / "drive"


@pytest.mark.parametrize("scheme", ["memory", "file"])
def test_recordings_behind_a_url(drive, scheme):
    url = f"{scheme}://{drive}"
    if scheme == "memory":
        fsspec.filesystem("memory").put(f"{drive}/", f"{drive}/", recursive=True)
    here, there = (Run(logged(path), ("65:90",), gp.load_system("constraints")) for path in (str(drive), url))
    assert there.key == here.key
    a, b = execute(here), execute(there)
    assert a.outcome == b.outcome == "done"
    assert repr(a.each) == repr(b.each)


def test_a_bad_log_behind_a_url_is_refused_by_its_url(tmp_path):
    (tmp_path / "drive").mkdir()
    (tmp_path / "drive" / "imu.csv").write_text("time,gyro_x\n0.0,nonsense\n")
    url = f"file://{tmp_path}/drive"
    row = execute(Run(logged(url), (), gp.load_system("ins")))
    assert row.outcome == "refused"
    assert row.reason.startswith(url + "/")


def test_a_single_file_stands_for_itself(tmp_path):
    (tmp_path / "imu.txt").write_text("1")
    (tmp_path / "other.txt").write_text("2")
    for path in (f"{tmp_path}/imu.txt", f"file://{tmp_path}/imu.txt"):
        inside, names = held(path)
        assert (names, inside.read("imu.txt")) == (["imu.txt"], b"1")


def test_without_fsspec_one_line_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'gapless\[cloud\]'"):
        place("s3://bucket/results")
    place(str(tmp_path))


def test_a_library_that_the_scheme_needs(monkeypatch):
    monkeypatch.setitem(sys.modules, "s3fs", None)
    with pytest.raises(ConfigError, match=r"s3://bucket/results: Install s3fs"):
        place("s3://bucket/results")


def test_what_a_file_system_raises_is_an_error_of_the_system(monkeypatch, tmp_path):
    class NoCredentialsError(Exception):
        pass

    def ls(*_, **__):
        raise NoCredentialsError("Unable to locate credentials")

    where = place(f"memory://{tmp_path}")
    monkeypatch.setattr(type(where.system), "ls", ls)
    with pytest.raises(OSError, match="NoCredentialsError: Unable to locate"):
        where.names()


def test_a_scheme_that_nobody_knows():
    with pytest.raises(ConfigError, match=r"nowhere://x: .*nowhere"):
        place("nowhere://x")
