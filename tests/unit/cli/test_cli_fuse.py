import json

import numpy as np
import pyarrow.parquet as pq
import pytest
from command_line import Shell

COLUMNS = (
    *("time", "lat", "lon", "height", "v_north", "v_east", "v_down", "roll", "pitch", "heading"),
    *("sd_north", "sd_east", "sd_down", "sd_v_north", "sd_v_east", "sd_v_down"),
    *("sd_roll", "sd_pitch", "sd_heading", "cov_north_east", "source"),
)


@pytest.fixture(scope="module")
def run(drive, tmp_path_factory):
    """One run with everything written."""
    out = tmp_path_factory.mktemp("fuse") / "run"
    formats = ("--csv", "--kml", "--geojson", "--gpx")
    result = Shell()("fuse", drive, "--outage", "100:130", *formats, "--out", out)
    return out, result


def test_what_is_written(run):
    out, _ = run
    solutions = {f"solution.{suffix}" for suffix in ("parquet", "csv", "kml", "geojson", "gpx")}
    assert {path.name for path in out.iterdir()} == solutions | {"summary.json", "report.html"}
    assert (out / "report.html").read_text("utf-8").startswith("<!")


def test_solution_has_the_promised_columns(run):
    table = pq.read_table(run[0] / "solution.parquet")
    assert table.column_names == list(COLUMNS)
    time = table["time"].to_numpy()
    # rows come on IMU samples, 10 ms apart, so a step is 0.1 s to within one of them
    assert np.abs(np.diff(time) - 0.1).max() < 0.011
    assert time[-1] == pytest.approx(160.0, abs=0.1)
    outage = (time > 102.0) & (time < 130.0)  # a fix holds a row for less than two seconds
    assert set(table["source"].to_numpy()[outage]) <= {"constraints", "ins"}
    assert set(table["source"].to_numpy()[time > 132.0]) == {"gnss"}
    for name in COLUMNS[:-1]:
        assert np.isfinite(table[name].to_numpy()).all(), name


def test_first_row_is_at_the_end_of_alignment(run):
    summary = json.loads((run[0] / "summary.json").read_text("utf-8"))
    (aligned,) = (d["value"] for d in summary["decisions"] if d["name"] == "alignment")
    first = pq.read_table(run[0] / "solution.parquet")["time"][0].as_py() - summary["start"]
    # a tick of 0.1 s and the sample of 10 ms that it ends on; the decision is rounded to 10 ms
    assert 0.0 <= first - aligned < 0.12


def test_summary_tells_decisions_and_scores(run):
    summary = json.loads((run[0] / "summary.json").read_text("utf-8"))
    assert [(o["start"], o["end"]) for o in summary["outages"]] == [(100.0, 130.0)]
    assert summary["scores"]["truth"] == "reference"
    for decision in summary["decisions"]:
        assert decision["evidence"]
        assert decision["source"] in {"data", "recording", "user", "default"}


def test_screen_is_narrow_and_says_where_the_files_are(run):
    out, result = run
    lines = result.stdout.splitlines()
    assert max(len(line) for line in lines if not line.startswith("wrote ")) <= 80
    assert f"wrote {out / 'solution.parquet'}" in lines
    assert result.stderr == ""  # nobody watches, so no bar


def test_a_folder_that_is_there_keeps_what_is_not_ours(shell, drive, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "summary.json").write_text('{"gapless": "0.0.1"}')
    shell("fuse", drive, "--rate", 2, "--no-report", "--out", tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"mine.txt", "summary.json", "solution.parquet"}
    assert json.loads((tmp_path / "summary.json").read_text("utf-8"))["name"]
    time = pq.read_table(tmp_path / "solution.parquet")["time"].to_numpy()
    assert np.median(np.diff(time)) == pytest.approx(0.5, abs=0.02)


def test_without_leaves_a_constraint_out(shell, drive, tmp_path):
    words = ("--without", "nonholonomic", "--without", "zero_velocity")
    shell("fuse", drive, *words, "--no-report", "--out", tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text("utf-8"))
    assert summary["system"] == "auto without nonholonomic, zero_velocity"
    assert set(summary["innovations"]) == {"position", "velocity"}


def test_system_and_config_are_one_or_the_other(shell, drive, tmp_path):
    mine = tmp_path / "mine.toml"
    mine.write_text('name = "mine"\nsensors = ["position"]\n[clock]\nposition = -0.1\n')
    out = tmp_path / "out"
    shell("fuse", drive, "--config", mine, "--no-report", "--out", out)
    summary = json.loads((out / "summary.json").read_text("utf-8"))
    assert summary["system"] == "mine"
    assert "velocity" not in summary["innovations"]
    (late,) = (d for d in summary["decisions"] if d["name"] == "clock offset, position")
    assert (late["value"], late["source"]) == (-0.1, "user")
    said = shell("fuse", drive, "--config", mine, "--system", "ins", "--out", out, code=2).stderr
    assert said == "gapless: --system and --config both name a recipe; give one of them\n"


def test_vehicle_turns_the_box_into_the_car(shell, drive, tmp_path, run):
    shell("fuse", drive, "--outage", "100:130", "--vehicle", "--no-report", "--out", tmp_path)
    box, car = (pq.read_table(f / "solution.parquet") for f in (run[0], tmp_path))
    turned = np.array([car[n].to_numpy()[-1] - box[n].to_numpy()[-1] for n in ("pitch", "heading")])
    summary = json.loads((tmp_path / "summary.json").read_text("utf-8"))
    # small angles: the product of two of 4 degrees is 0.3
    assert np.abs(turned - summary["states"]["mounting"]["value"]).max() < 0.3
    assert any(d["name"] == "attitude" and d["value"] == "the car's" for d in summary["decisions"])
    assert car["lat"].equals(box["lat"])


def test_clock_is_told(shell, drive):
    said = shell("inspect", drive, "--clock", "velocity=0.05").stdout
    assert "clock offset, velocity: 0.05 s (user: given in the configuration)" in said


def test_smoothing_looks_back(drive, tmp_path):
    result = Shell()("fuse", drive, "--smooth", "--no-report", "--out", tmp_path / "smooth")
    assert "smoothing" in result.output
    assert json.loads((tmp_path / "smooth" / "summary.json").read_text("utf-8"))["system"].endswith(
        "smoothed"
    )


def test_smoothing_and_causality_exclude_each_other(drive, tmp_path):
    result = Shell()("fuse", drive, "--smooth", "--causal", "--out", tmp_path / "both", code=2)
    assert "give one of them" in result.output
    assert not (tmp_path / "both").exists()
