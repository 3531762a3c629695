"""Where a log's time or place jumps: counts that end, clocks that leap, two devices' rows, poles."""

from functools import cache

import numpy as np
import pytest

from gapless import io
from gapless.errors import RecordingError
from gapless.io.writers.recording import _gnss, _imu
from gapless.io.writers.table import trajectory_columns
from gapless.simulate import WheelSensor, simulate

pd = pytest.importorskip("pandas")

SENSORS = ("imu", "gnss", "odometer", "reference")


@cache
def simulated(seed=5):
    return simulate("urban", "consumer", 300.0, seed, wheels=WheelSensor())


def logged(seed=5):
    """Columns by sensor, to be changed at will."""
    r = simulated(seed)
    wheels = {"time": r.odometer.time, "speed": r.odometer.speed}
    tables = (_imu(r), _gnss(r), wheels, trajectory_columns(r.reference))
    drive = {
        s: pd.DataFrame({k: v.copy() for k, v in t.items()}) for s, t in zip(SENSORS, tables, strict=True)
    }
    del drive["imu"]["dt"]
    return drive


def read(drive):
    return io.recording_from_frames(**{k: v.reset_index(drop=True) for k, v in drive.items()})


def refusal(drive):
    with pytest.raises(RecordingError) as error:
        read(drive)
    line = str(error.value)
    assert "\n" not in line
    assert "sort" not in line
    return line


def says(recording, words):
    return [note.count for note in recording.notes if words in note.what]


def leapt(drive, sensors, by, at=200.0):
    for sensor in sensors:
        time = drive[sensor]["time"]
        drive[sensor]["time"] = time + by * (time >= at)
    return drive


@pytest.mark.parametrize("count", [604800.0, 86400.0])
def test_a_count_that_ends_goes_on(count):
    drive = logged()
    for table in drive.values():
        table["time"] = (table["time"] + count - 100.0) % count
    r, plain = read(drive), read(logged())
    for sensor in SENSORS:
        # stamps of 6e5 s are rounded to 1e-10 s
        np.testing.assert_allclose(
            getattr(r, sensor).time - count + 100.0, getattr(plain, sensor).time, atol=1e-9
        )
    assert len(says(r, "began again at row")) == 4


@pytest.mark.parametrize("after", SENSORS)
def test_a_log_that_begins_after_the_week_ended_joins_the_others(after):
    drive = logged()
    for table in drive.values():
        table["time"] = (table["time"] + 604800.0 - 20.0) % 604800.0
    drive[after] = drive[after][drive[after]["time"] < 1000.0]
    r = read(drive)
    assert getattr(r, after).time[0] >= 604800.0
    assert len(says(r, "begins after the clock's count")) == 1


def test_rows_exchanged_at_the_end_of_the_week():
    drive = logged()
    drive["imu"]["time"] = (drive["imu"]["time"] + 604800.0 - 100.0) % 604800.0
    for sensor in SENSORS[1:]:
        drive[sensor]["time"] += 604800.0 - 100.0
    k = int(np.argmin(drive["imu"]["time"]))
    rows = np.arange(len(drive["imu"]))
    rows[[k - 1, k]] = rows[[k, k - 1]]
    drive["imu"] = drive["imu"].iloc[rows]
    r = read(drive)
    np.testing.assert_allclose(r.imu.time, simulated().imu.time + 604700.0, atol=1e-9)
    assert says(r, "put in order") == [2]


@pytest.mark.parametrize("sensors", [SENSORS, *((s,) for s in SENSORS)], ids="-".join)
@pytest.mark.parametrize("by", [-200.0, -5.0, 4.0, 60.0, 3600.0, 2e8])
def test_leaps_are_named_with_their_row(sensors, by):
    """The car drives at 200 s, and turns after it."""
    line = refusal(leapt(logged(), sensors, by))
    assert "part the log there" in line
    sensor = line.split(":")[0]
    assert sensor in sensors
    row = int(np.argmax(logged()[sensor]["time"] >= 200.0))
    assert line.startswith(f"{sensor}:{row}: ")
    assert ("leaps ahead" in line) == (by > 0.0)


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("length", [4.0, 60.0])
def test_true_silences_are_no_leaps(sensor, length):
    drive = logged()
    time = drive[sensor]["time"]
    drive[sensor] = drive[sensor][(time < 180.0) | (time > 180.0 + length)]
    read(drive)


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("apart", [0.0, 0.4])
def test_rows_of_two_drives_sorted_into_one(sensor, apart):
    """By so much of an interval; it is what sorting a log whose clock started anew makes."""
    drive, other = logged(), logged(9)[sensor]
    other["time"] += apart * np.median(np.diff(other["time"]))
    drive[sensor] = pd.concat([drive[sensor], other]).sort_values("time", kind="stable")
    assert "are in one file" in (line := refusal(drive)) or "are shuffled into one file" in line


def test_two_devices_of_one_car():
    """The same motion, other errors of the sensor."""
    drive, other = logged(), logged()["imu"]
    noise = np.random.default_rng(3).normal(
        [[0.004] * 3 + [0.1] * 3], [[0.004] * 3 + [0.03] * 3], (len(other), 6)
    )
    other.iloc[:, 1:] += noise
    other["time"] += 0.003
    drive["imu"] = pd.concat([drive["imu"], other]).sort_values("time")
    assert "belong to two devices by turns" in refusal(drive)


def test_velocities_that_no_one_filled():
    drive = logged()
    drive["gnss"][["v_north", "v_east", "v_down"]] = 0.0
    r = read(drive)
    assert not r.gnss.has_velocity
    assert says(r, "zero in every row while the positions move") == [len(r.gnss)]


def test_velocities_unfilled_now_and_then():
    drive = logged()
    speed = np.hypot(drive["gnss"]["v_north"], drive["gnss"]["v_east"])
    rows = (np.arange(len(speed)) % 10 == 3) & (speed > 8.0)
    assert rows.sum() > 5
    drive["gnss"].loc[rows, ["v_north", "v_east", "v_down"]] = 0.0
    r = read(drive)
    assert np.isnan(r.gnss.v_n[rows]).all()
    assert np.isfinite(r.gnss.v_n[~rows]).all()


def test_a_receiver_that_stands_may_say_zero():
    drive = logged()
    rows = np.hypot(drive["gnss"]["v_north"], drive["gnss"]["v_east"]) < 0.3
    drive["gnss"].loc[rows, ["v_north", "v_east", "v_down"]] = 0.0
    assert np.isfinite(read(drive).gnss.v_n).all()


def test_null_island_and_negative_deviations():
    drive = logged()
    drive["gnss"].loc[3::5, ["lat", "lon", "height"]] = 0.0, 0.0, 18.3
    for column in [c for c in drive["gnss"] if c.startswith("sd_")]:
        drive["gnss"][column] = -1.0
    r = read(drive)
    assert len(r.gnss) == len(drive["gnss"])
    assert np.isnan(r.gnss.lla[3::5]).all()
    assert says(r, "latitude 0, longitude 0 taken as not given") == [len(r.gnss.time[3::5])]
    assert len(says(r, "missing, zero or absurd")) == 2


@pytest.mark.parametrize(("lat", "fine"), [(89.8, True), (-89.8, True), (89.95, False), (-90.0, False)])
def test_poles(lat, fine):
    place = simulate(
        "highway", "consumer", 60.0, 3, origin=(np.radians(np.clip(lat, -89.95, 89.95)), 0.5, 0.0)
    )
    drive = {"imu": pd.DataFrame(_imu(place)), "gnss": pd.DataFrame(_gnss(place))}
    if fine:
        read(drive)
    else:
        drive["gnss"]["lat"] = np.clip(drive["gnss"]["lat"] * 1.0001, -90.0, 90.0)
        assert "of a pole, where north and heading turn" in refusal(drive)


def test_longitudes_are_the_same_however_they_are_logged():
    place = simulate("highway", "consumer", 60.0, 3, origin=(-0.3, np.pi - 1e-5, 0.0), heading=0.5 * np.pi)
    drive = {"imu": pd.DataFrame(_imu(place)), "gnss": pd.DataFrame(_gnss(place))}
    assert np.ptp(drive["gnss"]["lon"]) > 359.0
    signed = read(drive)
    drive["gnss"]["lon"] %= 360.0
    # degrees between 180 and 360 are rounded to 3e-14
    np.testing.assert_allclose(read(drive).gnss.lla, signed.gnss.lla, rtol=0.0, atol=1e-15)
    assert (np.abs(signed.gnss.lla[:, 1]) <= np.pi).all()
