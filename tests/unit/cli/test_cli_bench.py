"""`gapless bench`: the folder it leaves, and what it refuses."""

import json

import numpy as np
import pyarrow.parquet as pq
import pytest

KEYS = ["recording", "system", "protocol", "scenario"]
SIZES = [
    f"{q}_{what}"
    for q in ("horizontal", "vertical", "along", "cross", "velocity", "heading_deg")
    for what in ("max", "rmse", "end")
]
PLAN = ("--length", "10,15", "--every", 30, "--first", 90, "--shifts", "0,10")


@pytest.fixture(scope="module")
def bench(drive, tmp_path_factory):
    from command_line import Shell

    folder = tmp_path_factory.mktemp("bench") / "out"
    said = Shell()("bench", drive, *PLAN, "--protocol", "both", "--jobs", 1, "--out", folder).output
    return folder, said


def test_the_folder_is_the_contract(bench):
    folder, said = bench
    outages = pq.read_table(folder / "outages.parquet")
    want = {*KEYS, "length", "shift", "start", "end", "labels", "truth", "truth_epochs", "distance", *SIZES}
    want |= {"percent", "coverage_50", "coverage_95", "coverage_99", "nees", "inside_95_end"}
    assert want <= set(outages.column_names)
    ages = pq.read_table(folder / "ages.parquet").column_names
    parts = ["horizontal", "vertical", "along", "cross", "velocity", "heading_deg"]
    assert ages == [*KEYS, "start", "age", *parts, "bound", "nees"]
    tracks = pq.read_table(folder / "tracks.parquet")
    assert tracks.column_names == [
        *("recording", "kind", "protocol", "scenario", "start", "time", "lat", "lon"),
        *("semi_major", "semi_minor", "direction"),
    ]
    assert set(tracks["kind"].to_pylist()) == {"truth", "ins", "constraints", "auto"}
    runs = pq.read_table(folder / "runs.parquet").to_pylist()
    assert len(runs) == 3 * 2 * 4  # systems, protocols, scenarios
    assert json.loads(runs[0]["biases"])["gyro_bias"]["unit"]
    assert json.loads(runs[0]["innovations"])["position"]["count"] > 0
    assert json.loads(runs[0]["decisions"])[0]["name"]
    assert runs[0]["rmse_open"] > 0.0
    told = json.loads((folder / "bench.json").read_text())
    assert told["recordings"][0]["name"] == "drive"
    assert all(told["prefix"][name]["drive"].startswith("held in") for name in ("ins", "constraints", "auto"))
    assert told["arguments"]["length"] == "10,15"
    assert (folder / "tables.txt").read_text().rpartition("\ngapless ")[0].strip() in said
    assert not [p for p in folder.iterdir() if p.name.startswith(".")]
    assert "<html" in (folder / "report.html").read_text("utf-8")


def test_errors_by_age_are_those_of_the_scores(bench):
    folder, _ = bench
    outages = pq.read_table(folder / "outages.parquet").to_pylist()
    ages = pq.read_table(folder / "ages.parquet").to_pandas()
    for row in outages:
        part = ages[(ages[KEYS] == [row[k] for k in KEYS]).all(axis=1) & (ages["start"] == row["start"])]
        assert len(part) == row["truth_epochs"]
        assert part["horizontal"].max() == row["horizontal_max"]
        # The same numbers, summed in another order; 5.991 is the 95 % quantile of two degrees of freedom.
        assert part["nees"].mean() == pytest.approx(row["nees"], rel=1e-9)
        assert (part["nees"] <= 5.9915).mean() == row["coverage_95"]
        assert abs(part["heading_deg"].iloc[-1]) == pytest.approx(row["heading_deg_end"])


def test_tracks_of_systems_stay_in_their_outages(bench):
    folder, _ = bench
    tracks = pq.read_table(folder / "tracks.parquet").to_pandas()
    inside = tracks[tracks["kind"] != "truth"]
    age = inside["time"] - inside["start"]
    assert age.min() >= 0.0
    assert age.max() < 15.0
    assert (inside["semi_major"] >= inside["semi_minor"]).all()
    truth = tracks[tracks["kind"] == "truth"]
    assert np.diff(truth["time"]).min() > 0.45
    assert truth["semi_major"].isna().all()


def test_two_processes_give_the_rows_of_one(bench, shell, drive, tmp_path):
    folder, _ = bench
    shell("bench", drive, *PLAN, "--protocol", "both", "--jobs", 2, "--out", tmp_path / "two")
    for name in ("outages", "ages", "tracks", "leaderboard", "pairs"):
        a, b = (pq.read_table(f / f"{name}.parquet") for f in (folder, tmp_path / "two"))
        assert a.equals(b) or a.to_pandas().equals(b.to_pandas()), name


def test_simulated_drives(shell, tmp_path):
    words = ("--simulated", "urban", "--runs", 2, "--duration", 130, "--jobs", 1)
    words += ("--systems", "constraints,smoothed")
    said = shell("bench", *words, "--plan", "100:115", "--out", tmp_path / "out").output
    assert "passes" in said
    told = json.loads((tmp_path / "out" / "bench.json").read_text())
    assert [r["name"] for r in told["recordings"]] == ["urban-consumer-0001", "urban-consumer-0002"]
    assert all(r["truth"] == "reference" for r in told["recordings"])
    assert {s["name"]: s["causal"] for s in told["systems"]} == {"constraints": True, "smoothed": False}
    assert set(told["prefix"]["smoothed"].values()) == {"declared not causal; not checked"}
    assert "smoothed*" in said


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "give recordings, or --simulated"),
        (("DRIVE", "--simulated", "urban"), "and not both"),
        (("DRIVE", "--systems", "nothing"), "'nothing' is unknown"),
        (("DRIVE", "--systems", "ins,ins"), "two systems are called ins"),
        (("DRIVE", "--length", "10;20"), "write numbers with commas"),
        (("DRIVE", "--length", "300"), "outages overlap"),
        (("DRIVE", "--plan", "at=roof,every=9,length=3,first=1"), "at=turn|stop|speed"),
        (("DRIVE", "--plan", "5000:6000", "--jobs", 1), "no outage fits into any"),
        (("--simulated", "moon"), "moon"),
        (("--simulated", "urban", "--grade", "toy"), "toy"),
        (("--simulated", "urban", "--duration", -1), "positive"),
    ],
)
def test_slips_are_refused_in_a_line_and_nothing_is_left(shell, drive, tmp_path, words, says):
    words = [drive if word == "DRIVE" else word for word in words]
    result = shell("bench", *words, "--out", tmp_path / "out", code=2)
    assert says in result.output
    assert len(result.output.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_an_interrupt_leaves_nothing(shell, drive, tmp_path, monkeypatch):
    from gapless.laboratory import bench

    def interrupted(job):
        raise KeyboardInterrupt

    monkeypatch.setattr(bench, "execute", interrupted)
    shell("bench", drive, *PLAN, "--jobs", 1, "--out", tmp_path / "out", code=130)
    assert not (tmp_path / "out").exists()


def test_one_system_alone_has_a_page_too(shell, drive, tmp_path):
    told = shell(
        "bench", drive, "--systems", "ins", "--plan", "100:130", "--jobs", "1", "--out", tmp_path / "alone"
    )
    assert "Protocol passes" in told.output
    assert "ins" in (tmp_path / "alone" / "report.html").read_text("utf-8")
