"""Whose files are whose: the mark in every format, and what is refused without it."""

import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import gapless as gp
from gapless import io
from gapless.errors import ConfigError
from gapless.io.marks import check_ours, in_toml, is_model, is_ours, origin_in
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Solution


@pytest.fixture(scope="module")
def solution():
    n = 5
    trajectory = Trajectory(
        np.arange(n) * 0.1, np.full((n, 3), 0.5), np.ones((n, 3)), np.zeros((n, 3)),
        np.ones((n, 9)), np.zeros(n), np.full(n, "gnss"),
    )  # fmt: skip
    return Solution("drive", "ins", trajectory, {}, {}, {}, (), (), 0.0)


@pytest.fixture(scope="module")
def recording():
    return gp.simulate_drive("static", duration=20.0)


@pytest.mark.parametrize("suffix", io.WRITERS)
def test_solutions_are_marked_and_nothing_else_is_replaced(solution, tmp_path, suffix):
    path = tmp_path / f"s.{suffix}"
    gp.write(solution, path)
    assert is_ours(path)
    gp.write(solution, path)  # over itself
    path.write_text("mine\n")
    assert not is_ours(path)
    with pytest.raises(ConfigError, match=r"gapless did not write it.*force=True"):
        gp.write(solution, path)
    assert path.read_text() == "mine\n"
    gp.write(solution, path, force=True)
    assert is_ours(path)


def test_a_table_of_the_users_is_not_ours(tmp_path):
    pq.write_table(pa.table({"time": [1.0]}), tmp_path / "imu.parquet")
    assert not is_ours(tmp_path / "imu.parquet")
    (tmp_path / "cut.parquet").write_bytes(b"PAR1")
    assert not is_ours(tmp_path / "cut.parquet")
    (tmp_path / "s.csv").write_text("time,lat,lon,height\n1,2,3,4\n")
    assert not is_ours(tmp_path / "s.csv")


def test_a_recording_replaces_its_own_files_and_no_log(recording, tmp_path):
    gp.write_recording(recording, tmp_path)
    gp.write_recording(recording, tmp_path)
    assert all(is_ours(path) for path in tmp_path.iterdir())
    log = pa.table({"time": [1.0]})
    pq.write_table(log, tmp_path / "imu.parquet")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(ConfigError, match=r"imu\.parquet: is there"):
        gp.write_recording(recording, tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    gp.write_recording(recording, tmp_path, force=True)
    assert len(gp.read(tmp_path).imu) == len(recording.imu)


def test_settings_that_were_edited_are_the_users(recording, tmp_path):
    gp.write_recording(recording, tmp_path)
    settings = tmp_path / "recording.toml"
    settings.write_text(settings.read_text().replace("antenna_lever_arm = [0.0", "antenna_lever_arm = [1.0"))
    with pytest.raises(ConfigError, match=r"recording\.toml: is there"):
        gp.write_recording(recording, tmp_path)


def test_a_page_is_marked_by_its_contents(tmp_path):
    from gapless.reports.page import Content, render

    page = tmp_path / "page.html"
    page.write_text(render(Content("n", "k", "lead", (), "", None, ())), "utf-8")
    assert is_ours(page)
    page.write_text("<html><body>Made by gapless 0.1.0, I think</body></html>")
    assert not is_ours(page)


def test_the_mark_in_toml_knows_its_text_and_origin(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(in_toml("a = 1\n", "0123abcd"))
    assert origin_in(path) == "0123abcd"
    path.write_text(in_toml("a = 1\n"))
    assert (is_ours(path), origin_in(path)) == (True, "")
    path.write_text(in_toml("a = 1\n") + "b = 2\n")
    assert (is_ours(path), origin_in(path)) == (False, None)
    assert origin_in(tmp_path / "none.toml") is None


def test_folders_and_links_are_in_the_way(tmp_path):
    (tmp_path / "report.html").mkdir()
    with pytest.raises(ConfigError, match="is a folder"):
        check_ours([tmp_path / "report.html"], force=True)
    (tmp_path / "summary.json").symlink_to(tmp_path / "nowhere")
    with pytest.raises(ConfigError, match=r"summary\.json: is there"):
        check_ours([tmp_path / "summary.json"])


def test_models_are_told_from_all_else(tmp_path):
    path = tmp_path / "wheels.json"
    path.write_text(json.dumps({"kind": "gapless wheels", "version": 3}))
    assert is_model(path)
    path.write_text(json.dumps({"gapless": "0.1.0"}))
    assert not is_model(path)
    pytest.importorskip("sklearn", reason="the extra learn is not installed")
    from gapless.learners.container import join

    path.write_bytes(join(json.dumps({"kind": "gapless learner"}, indent=1), []))
    assert is_model(path)
