"""Each bad input: one line that says what, where and what next."""

import numpy as np
import pytest

from gapless import io
from gapless.errors import RecordingError


def refusal(folder):
    with pytest.raises(RecordingError) as error:
        io.read(folder)
    line = str(error.value)
    assert "\n" not in line
    assert len(line) < 600
    assert ";" in line or ": " in line
    return line


def scaled(sensor, names, factor):
    def change(drive):
        for name in names:
            drive[sensor][name] = drive[sensor][name] * factor

    return change


def held(sensor, names):
    def change(drive):
        for name in names:
            drive[sensor][name] = np.full_like(drive[sensor][name], drive[sensor][name].mean())

    return change


def hills(drive):
    """Up and down by five metres, and a velocity that calls up what is down."""
    phase = 0.2 * drive["gnss"]["time"]
    drive["gnss"]["height"] = 500.0 + 5.0 * np.sin(phase)
    drive["gnss"]["v_down"] = 0.2 * 5.0 * np.cos(phase)


def exchanged(sensor, pairs):
    def change(drive):
        for a, b in pairs:
            drive[sensor][a], drive[sensor][b] = drive[sensor][b], drive[sensor][a]

    return change


def put(sensor, name, k, value):
    def change(drive):
        drive[sensor][name] = drive[sensor][name].copy()
        drive[sensor][name][k] = value

    return change


def without(sensor, name=None):
    def change(drive):
        if name is None:
            del drive[sensor]
        else:
            del drive[sensor][name]

    return change


def shortened(sensor, n):
    def change(drive):
        drive[sensor] = {k: v[:n] for k, v in drive[sensor].items()}

    return change


def words(sensor, name, k, word):
    def change(drive):
        cells = drive[sensor][name].astype(object)
        cells[k] = word
        drive[sensor][name] = cells

    return change


GYRO, ACCEL = ("gyro_x", "gyro_y", "gyro_z"), ("accel_x", "accel_y", "accel_z")
SPEEDS = ("v_north", "v_east", "v_down")
CASES = {
    "no imu": (without("imu"), "drive: no imu.parquet or imu.csv; add the imu log"),
    "no gnss": (without("gnss"), "no gnss.parquet or gnss.csv"),
    "no column": (without("imu", "gyro_y"), "imu.csv: no column gyro_y (found time, gyro_x"),
    "no lat": (without("gnss", "lat"), "gnss.csv: no column lat"),
    "one speed missing": (without("gnss", "v_down"), "v_north, v_east without v_down; log all"),
    "one angle missing": (without("reference", "pitch"), "reference.csv: roll, heading without pitch"),
    "header only": (shortened("imu", 0), "imu.csv: no rows of data"),
    "one row": (shortened("imu", 1), "imu.csv: 1 row of data"),
    "one fix": (shortened("gnss", 1), "gnss.csv: 1 row of data"),
    "empty column": (put("imu", "accel_x", slice(None), np.nan), "column accel_x holds no number"),
    "half empty": (put("imu", "accel_x", slice(4000, 8000), np.nan), "imu.csv:4002: 4000 of 10000 rows lack"),
    "back": (
        lambda d: d["imu"]["time"].__isub__(0.19 * (np.arange(10000) >= 700)),
        "imu.csv:702: the clock starts anew or was set back here: time goes back by 0.18 s, from 1007.000000 "
        "to 1006.820000; part the log there, and the other logs at the same moment: rows 2 to 701, 702 to",
    ),
    "same stamps": (put("imu", "time", slice(None), 5.0), "all stamps are the same"),
    "text": (words("imu", "gyro_z", 41, "n/a?"), "imu.csv:43: gyro_z is 'n/a?', not a number"),
    "text gnss": (words("gnss", "lat", 3, "48°"), "gnss.csv:5: lat is"),
    "g": (scaled("imu", ACCEL, 1 / 9.80665), "looks like g; multiply the accelerations by 9.80665"),
    "increments": (scaled("imu", ACCEL, 0.01), "it looks like increments; multiply the accelerations by 100"),
    "dead gyros": (scaled("imu", GYRO, 0.0), "the gyros read the same in every row"),
    "dead accelerometers": (held("imu", ACCEL), "the accelerometers read the same in every row"),
    "up for down": (
        hills,
        "v_down points up (its correlation with falling heights is -1.00); change its sign",
    ),
    "milli-g": (scaled("imu", ACCEL, 1000 / 9.80665), "impossible values in 10000 rows"),
    "no gravity": (put("imu", "accel_z", slice(None), 0.0), "gravity included"),
    "deg/s": (lambda d: scaled("imu", GYRO, 57.3 * 4)(d), "look like deg/s; multiply the gyro"),
    "gyro for accel": (
        exchanged("imu", zip(GYRO, ACCEL, strict=True)),
        "exchange the gyro and accelerometer",
    ),
    "absurd": (put("imu", "gyro_x", slice(100, 200), 1e5), "imu.csv:102: impossible values in 100 rows"),
    "imu ms": (scaled("imu", ["time"], 1e3), "time looks like milliseconds; multiply it by 0.001"),
    "imu us": (scaled("imu", ["time"], 1e6), "time looks like microseconds"),
    "imu ns": (scaled("imu", ["time"], 1e9), "time looks like nanoseconds"),
    "imu days": (scaled("imu", ["time"], 1 / 86400), "check the unit of time"),
    "gnss ms": (scaled("gnss", ["time"], 1e3), "GNSS time looks like milliseconds"),
    "gnss ns": (scaled("gnss", ["time"], 1e9), "GNSS time looks like nanoseconds"),
    "other trip": (lambda d: d["gnss"]["time"].__iadd__(5000.0), "1000.010 to 1100.000 s"),
    "unix": (lambda d: d["gnss"]["time"].__iadd__(604800.0 * 2300), "start of the GPS week"),
    "lat for lon": (lambda d: exchanged("gnss", [("lat", "lon")])(d), "look exchanged: swap them"),
    "range": (
        lambda d: scaled("gnss", ["lon"], 10.4)(d) or exchanged("gnss", [("lat", "lon")])(d),
        "lat and lon look exchanged",
    ),
    "radians": (scaled("gnss", ["lat", "lon"], np.pi / 180), "may be in radians"),
    "height for lat": (exchanged("gnss", [("lat", "height")]), "no place on earth: lat 500"),
    "km/h": (scaled("gnss", SPEEDS, 3.6), "it looks like km/h"),
    "knots": (scaled("gnss", SPEEDS, 1.943844), "it looks like knots"),
    "speeds exchanged": (exchanged("gnss", [("v_north", "v_east")]), "look exchanged"),
    "sign": (scaled("gnss", ["v_north", "v_east"], -1.0), "check the signs"),
    "no fixes": (put("gnss", "fix", slice(None), 0), "0 of 499 rows hold a fix"),
    "shuffled fixes": (put("gnss", "time", slice(0, 200), 1050.0), "gnss.csv:"),
    "reference range": (scaled("reference", ["lat"], 100.0), "reference.csv:2: no place on earth"),
    "wheels in km/h": (
        scaled("odometer", ["speed"], 3.6),
        "times what the positions show; it looks like km/h: log m/s",
    ),
    "wheels in mph": (scaled("odometer", ["speed"], 2.237), "it looks like mph: log m/s"),
    "odometer": (scaled("odometer", ["speed"], 1000.0), "odometer.csv:2: a speed of 1e+04 m/s"),
    "odometer column": (without("odometer", "speed"), "odometer.csv: no column speed"),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_columns(drive, write_drive, case):
    change, expected = CASES[case]
    change(drive)
    assert expected in refusal(write_drive(drive))


def test_text_in_parquet(drive, write_drive):
    drive["imu"]["gyro_z"] = [str(x) for x in drive["imu"]["gyro_z"]]
    drive["imu"]["gyro_z"][6] = "high"
    assert "imu.parquet:7: gyro_z is 'high', not a number" in refusal(write_drive(drive, ".parquet"))


def test_timestamps_in_parquet(drive, write_drive):
    drive["imu"]["time"] = (drive["imu"]["time"] * 1e9).astype("datetime64[ns]")
    assert "column time holds timestamp[ns], not numbers" in refusal(write_drive(drive, ".parquet"))


@pytest.mark.parametrize("keep", [0, 3, 0.5, 0.999])
def test_truncated_parquet(drive, write_drive, keep):
    folder = write_drive(drive, ".parquet")
    raw = (folder / "imu.parquet").read_bytes()
    (folder / "imu.parquet").write_bytes(raw[: int(keep * len(raw)) if keep < 1 else keep])
    line = refusal(folder)
    assert "imu.parquet: cannot be read" in line
    assert "copy or export it again" in line


def test_truncated_csv(drive, write_drive):
    folder = write_drive(drive)
    raw = (folder / "imu.csv").read_bytes()
    half = raw[: raw.rindex(b",", 0, len(raw) // 2)]
    (folder / "imu.csv").write_bytes(half)
    row = half.count(b"\n") + 1
    line = refusal(folder)
    assert f"imu.csv:{row}: cannot be read" in line


def test_empty_csv(drive, write_drive):
    folder = write_drive(drive)
    (folder / "gnss.csv").write_bytes(b"")
    assert "gnss.csv: the file is empty" in refusal(folder)


def test_column_twice(drive, write_drive):
    folder = write_drive(drive)
    text = (folder / "imu.csv").read_text().replace("gyro_y", "gyro_x", 1)
    (folder / "imu.csv").write_text(text)
    assert "column gyro_x is there twice" in refusal(folder)


def test_both_suffixes(drive, write_drive):
    folder = write_drive(drive)
    (folder / "imu.parquet").write_bytes(b"")
    assert "imu.csv is there too; keep one" in refusal(folder)


def test_missing_path_and_unknown_format(tmp_path):
    assert "nowhere: no such file or folder; check the path" in refusal(tmp_path / "nowhere")
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(100))
    line = refusal(tmp_path / "picture.png")
    for reader in io.READERS:
        assert reader.description in line
    with pytest.raises(RecordingError, match="no path"):
        io.read()
    assert "not a format" in refusal(tmp_path)


@pytest.mark.parametrize("dt", [0.0, -0.01, np.nan, 0.5])
def test_impossible_intervals(drive, write_drive, dt):
    drive["imu"]["dt"] = np.full(10_000, 0.01)
    drive["imu"]["dt"][9] = dt
    assert "imu.csv:11: dt is" in refusal(write_drive(drive))
