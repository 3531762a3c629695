"""What gapless did not write stays, whatever it is called; what it wrote is replaced."""

import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest


def own_log(drive, folder):
    """A recording that came from elsewhere: no mark in any file."""
    folder.mkdir()
    for path in drive.glob("*.parquet"):
        table = pq.read_table(path)
        pq.write_table(table.replace_schema_metadata(None), folder / path.name)
    (folder / "recording.toml").write_text('name = "mine"\n')
    return folder


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def refused(shell, *words):
    said = shell(*words, code=2).stderr
    assert said.count("\n") == 1
    assert "--force" in said
    return said


def test_logs_are_not_replaced_by_drives(shell, drive, tmp_path):
    folder = own_log(drive, tmp_path / "log")
    before = contents(folder)
    assert "imu.parquet: is there" in refused(shell, "simulate", "--duration", 20, "--out", folder)
    refused(shell, "convert", drive, "--out", folder)
    refused(shell, "convert", folder, "--out", folder)
    assert contents(folder) == before
    shell("simulate", "--duration", 20, "--force", "--out", folder)
    assert contents(folder) != before


def test_a_drive_is_replaced_by_the_same_only(shell, tmp_path):
    words = ("simulate", "--profile", "static", "--out", tmp_path, "--duration")
    shell(*words, 20)
    before = contents(tmp_path)
    shell(*words, 20)
    assert "a recording that this command did not make" in refused(shell, *words, 30)
    assert contents(tmp_path) == before
    settings = tmp_path / "recording.toml"
    settings.write_text(settings.read_text() + 'grade = "tactical"\n'.replace("grade", "# grade"))
    assert "recording.toml" in refused(shell, *words, 20)


def test_a_log_is_converted_again_unless_it_changed(shell, drive, tmp_path):
    log = own_log(drive, tmp_path / "log")
    for _ in range(2):
        shell("convert", log, "--out", tmp_path / "out")
    (log / "recording.toml").write_text('name = "another"\n')
    refused(shell, "convert", log, "--out", tmp_path / "out")
    (tmp_path / "out" / "imu.csv").write_text("mine")
    assert "in the way" in shell("convert", log, "--force", "--out", tmp_path / "out", code=2).stderr


@pytest.mark.parametrize("name", ["solution.parquet", "summary.json", "report.html", "solution.kml"])
def test_results_do_not_replace_the_users_files_and_it_is_said_at_once(
    shell, drive, tmp_path, monkeypatch, name
):
    monkeypatch.setattr("gapless.runs.fuse.fuse", lambda *_: pytest.fail("worked for nothing"))
    (tmp_path / name).write_text("mine")
    assert f"{tmp_path / name}: is there" in refused(shell, "fuse", drive, "--kml", "--out", tmp_path)
    assert (tmp_path / name).read_text() == "mine"


def test_what_would_be_removed_as_of_an_earlier_run_stays_if_it_is_not(shell, drive, tmp_path):
    (tmp_path / "solution.csv").write_text("mine")
    said = shell("fuse", drive, "--rate", 1, "--no-report", "--out", tmp_path).stdout
    assert f"left {tmp_path / 'solution.csv'}, which gapless did not write" in said
    assert (tmp_path / "solution.csv").read_text() == "mine"


def test_a_model_replaces_models_only(shell, drive, tmp_path, monkeypatch):
    monkeypatch.setattr("gapless.runs.fuse.fuse", lambda *_: pytest.fail("worked for nothing"))
    copy = shutil.copytree(drive, tmp_path / "copy")
    words = ("fuse", copy, "--out", tmp_path / "out", "--save-model")
    assert "imu.parquet: is there" in refused(shell, *words, copy / "imu.parquet")
    assert contents(copy) == contents(drive)
    assert (
        "this run writes that file itself" in shell(*words, tmp_path / "out" / "summary.json", code=2).stderr
    )


@pytest.mark.parametrize("name", ["outages.parquet", "tables.txt", "report.html"])
def test_a_bench_and_a_reproduction_ask_first(shell, drive, tmp_path, name):
    (tmp_path / name).write_text("mine")
    refused(shell, "bench", drive, "--out", tmp_path)
    if name != "outages.parquet":
        refused(shell, "reproduce", "tan2015", "--out", tmp_path)
    assert (tmp_path / name).read_text() == "mine"


def test_a_sweep_changes_its_own_parts_only(tmp_path):
    import gapless as gp
    from gapless.errors import ConfigError
    from gapless.sweeps.store import opened

    folder = tmp_path / "study=s"
    folder.mkdir()
    (folder / ".lock").write_text("mine")
    (folder / ".film.part").write_text("mine")
    table = pa.table({"key": ["a"], "outcome": ["failed"]})
    pq.write_table(table, folder / "part-mine.parquet")
    with opened(str(tmp_path), "s") as store, pytest.raises(ConfigError, match="--force"):
        store.forget_failed()
    assert {p.name for p in folder.iterdir()} == {".lock", ".film.part", "part-mine.parquet"}
    assert (folder / ".lock").read_text() == "mine"
    with opened(str(tmp_path), "s") as store:
        store.forget_failed(force=True)
    pq.write_table(pa.table({"x": [1]}), folder / "part-mine.parquet")
    with pytest.raises(ConfigError, match="holds no runs of a sweep"):
        gp.read_sweep(tmp_path)
