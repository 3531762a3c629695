"""`gapless report`, and what `fuse` does about pages of earlier runs."""

import html
import json
import shutil
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "reports"))

import fake_bench


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    folder = tmp_path_factory.mktemp("benches") / "bench"
    return fake_bench.make(folder, protocols=("passes",), lengths=(30,), shifts=(0,), duration=700.0)


@pytest.fixture(scope="module")
def run(drive, tmp_path_factory):
    """Files of `gapless fuse --no-report`."""
    from command_line import Shell

    out = tmp_path_factory.mktemp("runs") / "run"
    Shell()("fuse", drive, "--outage", "100:130", "--no-report", "--out", out)
    return out


def test_the_page_of_a_bench_is_made_again(shell, bench):
    done = shell("report", bench)
    assert done.stdout == f"wrote {bench / 'report.html'}\n"
    assert (bench / "report.html").read_text("utf-8").startswith("<!")


def test_figures_are_written_beside_it(shell, bench, tmp_path):
    pytest.importorskip("matplotlib", reason="the extra figures is not installed")
    copy = shutil.copytree(bench, tmp_path / "bench")
    listed = shell("report", copy, "--figures", "png").stdout.splitlines()
    assert f"wrote {copy / 'figures' / 'leaderboard-passes.png'}" in listed


def test_the_page_of_a_run_is_made_of_what_it_left(shell, run, tmp_path):
    copy = shutil.copytree(run, tmp_path / "run")
    done = shell("report", copy)
    assert "without errors, biases and innovations over time" in done.stdout
    page = html.unescape((copy / "report.html").read_text("utf-8"))
    summary = json.loads((copy / "summary.json").read_text("utf-8"))
    for decision in summary["decisions"]:
        assert decision["evidence"] in page
    assert "Errors in each outage" in page


def test_a_fuller_page_is_not_replaced_by_a_poorer_one(shell, run, tmp_path):
    copy = shutil.copytree(run, tmp_path / "run")
    (copy / "report.html").write_text("full", "utf-8")
    assert "remove it first" in shell("report", copy, code=2).stderr
    assert (copy / "report.html").read_text("utf-8") == "full"


def test_files_of_two_runs_are_refused(shell, run, tmp_path):
    copy = shutil.copytree(run, tmp_path / "run")
    summary = json.loads((copy / "summary.json").read_text("utf-8"))
    (copy / "summary.json").write_text(json.dumps(summary | {"rows": 3}), "utf-8")
    assert "not of one run" in shell("report", copy, code=2).stderr


@pytest.mark.parametrize("words", [(), ("--figures", "png")])
def test_what_cannot_be_done_is_said_in_one_line(shell, run, tmp_path, words):
    folder = run if words else tmp_path
    done = shell("report", folder, *words, code=2)
    assert len(done.stderr.splitlines()) == 1
    assert str(folder) in done.stderr


def test_a_bad_background_is_refused_before_any_work(shell, drive, bench, tmp_path):
    path = tmp_path / "ground.geojson"
    path.write_text("{", "utf-8")
    for words in (("report", bench), ("fuse", drive, "--out", tmp_path / "out")):
        done = shell(*words, "--background", path, code=2)
        assert f"{path}: not GeoJSON" in done.stderr
    assert not (tmp_path / "out").exists()
    done = shell("fuse", drive, "--out", tmp_path / "out", "--background", path, "--no-report", code=2)
    assert "leave out --no-report" in done.stderr


def test_files_of_an_earlier_run_do_not_stay_beside_those_of_this_one(shell, drive, tmp_path):
    shell("fuse", drive, "--rate", 1, "--kml", "--out", tmp_path)
    (tmp_path / "notes.txt").write_text("mine", "utf-8")
    done = shell("fuse", drive, "--rate", 1, "--no-report", "--out", tmp_path)
    for name in ("solution.kml", "report.html"):
        assert f"removed {tmp_path / name}, of an earlier run" in done.stdout
    assert {p.name for p in tmp_path.iterdir()} == {"solution.parquet", "summary.json", "notes.txt"}
