"""Solutions out: each format read back by something that is not ours."""

import csv
import json
import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pyarrow.parquet as pq
import pytest

from gapless import io
from gapless.errors import ConfigError, MissingExtraError, RecordingError
from gapless.io.writers.gpx import write_gpx
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Solution
from gapless.units import DEG

NASTY = 'Trip <1> & "two" \x07 é 🚗'
KML = "{http://www.opengis.net/kml/2.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"


@pytest.fixture
def solution(circle):
    time = 1000.0 + 0.1 * np.arange(600)
    lla, v_n, heading = circle(time - 1000.0)
    euler = np.column_stack(
        [np.full(600, 0.01), np.full(600, -0.02), (heading + np.pi) % (2 * np.pi) - np.pi]
    )
    sd = np.tile([1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.01, 0.02, 0.03], (600, 1))
    source = np.repeat(["gnss", "constraints", "ins", "gnss"], [200, 100, 50, 250])
    path = Trajectory(time, lla, v_n, euler, sd, np.zeros(600), source)
    return Solution(NASTY, "default", path, {}, {}, {}, (), ((20.0, 35.0),), 1000.0)


COLUMNS = [
    *("time", "lat", "lon", "height", "v_north", "v_east", "v_down", "roll", "pitch", "heading"),
    *("sd_north", "sd_east", "sd_down", "sd_v_north", "sd_v_east", "sd_v_down"),
    *("sd_roll", "sd_pitch", "sd_heading", "cov_north_east", "source"),
]


def test_parquet(solution, tmp_path):
    io.write(solution, tmp_path / "deep" / "solution.parquet")
    table = pq.read_table(tmp_path / "deep" / "solution.parquet")
    assert table.column_names == COLUMNS
    assert str(table.schema.field("source").type).startswith("dictionary<values=string")
    assert table["source"].to_pylist() == solution.trajectory.source.tolist()
    column = {name: table[name].to_numpy() for name in COLUMNS[:-1]}
    # two roundings, rad to deg and back
    np.testing.assert_allclose(column["lat"] * DEG, solution.trajectory.lla[:, 0], rtol=4e-16)
    assert column["heading"].min() >= 0.0
    assert column["heading"].max() < 360.0
    turned = np.exp(1j * column["heading"] * DEG)
    np.testing.assert_allclose(turned, np.exp(1j * solution.trajectory.euler[:, 2]), atol=1e-14)
    np.testing.assert_allclose(column["sd_heading"], 0.03 / DEG, rtol=1e-15)
    np.testing.assert_array_equal(column["sd_v_east"], np.full(600, 0.2))


def test_heading_stays_below_360(solution):
    euler = solution.trajectory.euler.copy()
    euler[0, 2] = -1e-18  # its remainder by 360 rounds to 360
    nudged = replace(solution, trajectory=replace(solution.trajectory, euler=euler))
    assert io.solution_columns(nudged)["heading"][0] == 0.0


def test_writing_imports_no_pandas(tmp_path):
    code = (
        "import sys, numpy as np; from gapless.io.writers.table import arrow_table;"
        "import pyarrow.parquet as pq; table = arrow_table({'a': np.ones(3)}, np.array(['x', 'y', 'x']));"
        f"pq.write_table(table, {str(tmp_path / 'a.parquet')!r});"
        "sys.exit('pandas' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
    assert pq.read_table(tmp_path / "a.parquet")["source"].to_pylist() == ["x", "y", "x"]


def test_csv(solution, tmp_path):
    solution.trajectory.sd[5, 8] = np.nan
    io.write(solution, tmp_path / "s.csv")
    with (tmp_path / "s.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == COLUMNS
    assert [row["source"] for row in rows] == solution.trajectory.source.tolist()
    assert rows[5]["sd_heading"] == ""
    lat = np.array([float(row["lat"]) for row in rows]) * DEG
    np.testing.assert_allclose(lat, solution.trajectory.lla[:, 0], atol=0.5e-10 * DEG * 1.001)  # ten digits


def test_geojson(solution, tmp_path):
    io.write(solution, tmp_path / "s.geojson")
    collection = json.loads((tmp_path / "s.geojson").read_text("utf-8"))
    assert collection["name"] == NASTY
    features = collection["features"]
    assert [f["properties"]["source"] for f in features] == ["gnss", "constraints", "ins", "gnss"]
    assert [f["properties"]["outage"] for f in features] == [False, True, True, False]
    assert [len(f["geometry"]["coordinates"]) for f in features] == [200, 101, 51, 251]
    for before, after in pairwise(features):  # lines join
        assert before["geometry"]["coordinates"][-1] == after["geometry"]["coordinates"][0]
    lon, lat, height = features[0]["geometry"]["coordinates"][0]
    assert (lon, lat, height) == (11.0, 48.0, 500.0)  # RFC 7946: longitude first
    assert features[0]["properties"]["sd_horizontal_end"] == 2.0


def test_kml(solution, tmp_path):
    io.write(solution, tmp_path / "s.kml")
    document = ElementTree.parse(tmp_path / "s.kml").getroot()[0]
    assert document.findtext(f"{KML}name") == NASTY.replace("\x07", "")
    styles = {style.get("id") for style in document.iter(f"{KML}Style")}
    lines = document.findall(f"{KML}Placemark")
    assert [line.findtext(f"{KML}styleUrl") for line in lines] == ["#gnss", "#constraints", "#ins", "#gnss"]
    assert {"gnss", "constraints", "ins", "bridge"} <= styles
    assert lines[1].findtext(f"{KML}name") == "constraints 19.9 to 29.9 s"
    points = lines[0].findtext(f".//{KML}coordinates").split()
    assert len(points) == 200
    assert points[0] == "11.000000000,48.000000000,500.000"


def test_gpx(solution, tmp_path):
    io.write(solution, tmp_path / "s.gpx")
    root = ElementTree.parse(tmp_path / "s.gpx").getroot()
    points = root.findall(f".//{GPX}trkpt")
    assert len(points) == 600
    assert (points[0].get("lat"), points[0].findtext(f"{GPX}ele")) == ("48.000000000", "500.000")
    assert not root.findall(f".//{GPX}time")
    write_gpx(solution, tmp_path / "t.gpx", datetime(2024, 2, 29, 23, 43, 20, tzinfo=UTC))
    times = [t.text for t in ElementTree.parse(tmp_path / "t.gpx").getroot().iter(f"{GPX}time")]
    assert times[:2] == ["2024-03-01T00:00:00.000Z", "2024-03-01T00:00:00.100Z"]


@pytest.mark.parametrize("suffix", io.WRITERS)
def test_one_row_and_none(solution, tmp_path, suffix):
    for n in (1, 0):
        io.write(
            replace(solution, trajectory=solution.trajectory.take(slice(0, n))), tmp_path / f"s.{suffix}"
        )
        assert (tmp_path / f"s.{suffix}").stat().st_size > 0


def test_unknown_suffix(solution, tmp_path):
    with pytest.raises(ConfigError, match=r"s\.xls: no writer for it; name the file \.parquet, \.csv"):
        io.write(solution, tmp_path / "s.xls")


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_atomic(tmp_path, error):
    target = tmp_path / "out.txt"
    with io.atomic(target) as temporary:
        temporary.write_text("old")

    def fail():
        with io.atomic(target) as temporary:
            temporary.write_text("half")
            raise error

    with pytest.raises(error):
        fail()
    assert [path.name for path in tmp_path.iterdir()] == ["out.txt"]
    assert target.read_text() == "old"


@pytest.mark.parametrize("suffix", io.WRITERS)
def test_an_interrupted_writer_leaves_nothing(solution, tmp_path, suffix, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("gapless.io.writers.atomic.os.replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        io.write(solution, tmp_path / f"s.{suffix}")
    assert list(tmp_path.iterdir()) == []


def test_recording_comes_back(drive, write_drive, tmp_path):
    drive["imu"]["time"][6000:] += 5.0  # a gap, to be kept
    drive["gnss"]["v_north"][7] = np.nan
    toml = (
        'imu_axes = "back-right-up"\nantenna_lever_arm = [1, 2, 0.1]\ngrade = "x"\nreference_clock = "gnss"'
    )
    drive["imu"]["accel_z"] = -drive["imu"]["accel_z"]
    first = replace(io.read(write_drive(drive, settings=toml)), name='a "b" \\ \x7f\n é')
    io.write_recording(first, tmp_path / "again")
    second = io.read(tmp_path / "again")
    for name in ("time", "dt"):
        np.testing.assert_array_equal(getattr(second.imu, name), getattr(first.imu, name))
    for name in ("dtheta", "dvel"):  # one division and one product: two roundings
        np.testing.assert_allclose(getattr(second.imu, name), getattr(first.imu, name), rtol=2.3e-16)
    for name in ("time", "v_n", "sd_position", "sd_velocity", "fix"):
        np.testing.assert_array_equal(getattr(second.gnss, name), getattr(first.gnss, name))
    np.testing.assert_allclose(second.gnss.lla, first.gnss.lla, rtol=2.3e-16)
    np.testing.assert_array_equal(second.odometer.speed, first.odometer.speed)
    # 0.5 mrad of heading less than one turn: 2 pi rounds to 9e-16
    np.testing.assert_allclose(second.reference.euler, first.reference.euler, atol=2e-15)
    for name in ("name", "grade", "reference_clock"):
        assert getattr(second, name) == getattr(first, name)
    assert [note.what for note in second.notes] == [note.what for note in first.notes]
    np.testing.assert_array_equal(second.lever_arm, first.lever_arm)
    io.write_recording(second, tmp_path / "again")  # over itself


def test_recording_does_not_mix_with_another(drive, write_drive):
    folder = write_drive(drive)
    with pytest.raises(RecordingError, match=r"imu\.csv: in the way.*choose another folder"):
        io.write_recording(io.read(folder), folder)
    assert not (folder / "imu.parquet").exists()


def test_pandas(solution, monkeypatch):
    pytest.importorskip("pandas")
    frame = io.to_pandas(solution)
    assert list(frame.columns) == COLUMNS
    assert frame.source.value_counts()["constraints"] == 100
    np.testing.assert_array_equal(frame.lat, io.solution_columns(solution)["lat"])
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'gapless\[pandas\]'"):
        io.to_pandas(solution)


def test_frames_equal_files(drive, write_drive):
    pd = pytest.importorskip("pandas")
    frames = {sensor: pd.DataFrame(columns) for sensor, columns in drive.items()}
    a = io.recording_from_frames(**frames, imu_axes="left-back-up", antenna_lever_arm=[0, 1, 0], name="drive")
    toml = 'imu_axes = "left-back-up"\nantenna_lever_arm = [0, 1, 0]'
    b = io.read(write_drive(drive, settings=toml))
    np.testing.assert_array_equal(a.imu.dvel, b.imu.dvel)
    np.testing.assert_array_equal(a.gnss.lla, b.gnss.lla)
    np.testing.assert_array_equal(a.lever_arm, b.lever_arm)
    assert (a.name, a.reference_clock) == (b.name, b.reference_clock)
    frames["imu"]["gyro_x"] = "fast"
    with pytest.raises(RecordingError, match="imu: column gyro_x is not numeric"):
        io.recording_from_frames(**frames)


def test_no_file_is_left_open(solution, tmp_path):
    for suffix in io.WRITERS:
        io.write(solution, Path(tmp_path) / f"s.{suffix}")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(f"s.{suffix}" for suffix in io.WRITERS)
