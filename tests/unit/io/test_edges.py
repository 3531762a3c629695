"""A few wild stamps at the edges of a log."""

import numpy as np
import pytest

import gapless as gp
from gapless.io.edges import FAR, FAR_IMU, of_the_trip, without_strays
from gapless.io.log import Log

WILD = (1.7e9, -1.7e9, 1e300, -1e300, 1e5)


def log(time):
    return Log("gnss.csv", {"time": np.asarray(time, float)}, first_row=2)


@pytest.mark.parametrize("wild", WILD)
@pytest.mark.parametrize("rows", [[0], [-1], [0, 1], [0, -1]])
def test_they_are_dropped_and_said(rows, wild):
    time = np.arange(100.0)
    time[rows] = wild
    notes = []
    kept = without_strays(log(time), FAR, notes)
    assert len(kept) == 100 - len(rows)
    assert np.ptp(kept["time"]) < 100.0
    assert kept.row(0) == f"gnss.csv:{2 + sum(k >= 0 for k in rows)}"
    assert sum(note.count for note in notes) == len(rows)
    assert all("far from all others" in note.what for note in notes)


@pytest.mark.parametrize(
    "time",
    [
        np.arange(100.0) * 1e9,  # nanoseconds
        np.r_[np.arange(50.0), 5000.0 + np.arange(50.0)],  # two drives
        np.r_[0.0, 800.0 + np.arange(99.0)],  # a receiver that was silent in a garage
        [0.0, 1e9],
        [np.nan, 1.0, 2.0, np.nan],
    ],
)
def test_all_else_stays(time):
    given, notes = log(time), []
    assert without_strays(given, FAR, notes) is given
    assert not notes


def test_an_imus_lone_sample_is_dropped_sooner():
    time = np.r_[0.0, 35.0 + 0.01 * np.arange(1000)]
    assert len(without_strays(log(time), FAR_IMU, [])) == 1000


def test_rows_without_a_stamp_are_left_to_others():
    time = np.r_[np.nan, 1e12, np.arange(50.0), np.nan]
    kept = without_strays(log(time), FAR, [])
    assert np.isnan(kept["time"][[0, -1]]).all()
    assert len(kept) == 52


def test_a_cold_receivers_fixes_are_not_of_the_trip():
    imu, notes = np.arange(0.0, 100.0, 0.01), []
    kept = of_the_trip(log(np.r_[-1.3e9 + np.arange(15.0), np.arange(85.0)]), imu, notes)
    assert len(kept) == 85
    assert notes[0].count == 15
    other_clock = log(1.7e9 + np.arange(100.0))
    assert of_the_trip(other_clock, imu, notes) is other_clock


@pytest.mark.parametrize("sensor", ["imu", "gnss", "odometer", "reference"])
def test_a_recording_lasts_no_longer_for_them(tmp_path, sensor):
    import pyarrow as pa
    import pyarrow.parquet as pq

    from gapless.simulate import WheelSensor

    drive = gp.simulate_drive("urban", duration=60.0, wheels=WheelSensor())
    gp.write_recording(drive, tmp_path)
    path = tmp_path / f"{sensor}.parquet"
    table = pq.read_table(path)
    columns = {name: table[name].to_numpy().copy() for name in table.column_names}
    columns["time"][[0, -1]] = -1.7e9, 1.7e9
    pq.write_table(pa.table(columns), path)
    found = gp.read(tmp_path)
    assert found.duration < 60.0
    for columns in (found.gnss, found.odometer, found.reference):
        assert np.ptp(columns.time) <= 60.0
    assert sum("far from all others" in note.what for note in found.notes) == 2
