"""Whatever the bytes, a reader raises RecordingError and nothing else, in one line."""

import os
import shutil

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gapless import io
from gapless.errors import RecordingError

FEW = settings(
    max_examples=int(
        os.environ.get("GAPLESS_FUZZ", 60)
    ),  # the whole file in some seconds; each example parses three small files
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    derandomize=True,
)
damages = st.tuples(
    st.floats(0.0, 1.0),
    st.floats(0.0, 1.0),
    st.binary(max_size=40) | st.text("0123456789.eE+-,\n nN", max_size=30),
)


def damaged(raw, damage):
    """Bytes with a stretch replaced: truncation, insertion, overwriting."""
    a, length, new = damage
    start = int(a * len(raw))
    stop = start + int(length**6 * (len(raw) - start))
    return raw[:start] + (new if isinstance(new, bytes) else new.encode()) + raw[stop:]


def read_or_refuse(*paths):
    try:
        r = io.read(*paths)
    except RecordingError as error:
        line = str(error)
    else:
        check_sound(r)
        return
    assert "\n" not in line


def check_sound(r):
    assert (r.imu.dt > 0.0).all()
    assert (np.diff(r.imu.time) > 0.0).all()
    assert (np.diff(r.gnss.time) > 0.0).all()
    assert np.isfinite(r.imu.dtheta).all()
    assert np.isfinite(r.imu.dvel).all()
    assert (r.gnss.sd_position[np.isfinite(r.gnss.lla)] > 0.0).all()


@pytest.fixture
def short(drive):
    n = {"imu": 300, "gnss": 30, "odometer": 30, "reference": 30}
    return {sensor: {k: v[: n[sensor]] for k, v in columns.items()} for sensor, columns in drive.items()}


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@pytest.mark.parametrize("sensor", ["imu", "gnss", "odometer", "reference"])
def test_damaged_folder(short, write_drive, suffix, sensor):
    folder = write_drive(short, suffix)
    read_or_refuse(folder)
    raw = (folder / f"{sensor}{suffix}").read_bytes()

    @FEW
    @given(damages)
    def check(damage):
        (folder / f"{sensor}{suffix}").write_bytes(damaged(raw, damage))
        read_or_refuse(folder)

    check()


def test_damaged_settings(short, write_drive):
    folder = write_drive(short)
    raw = b'name = "x"\nimu_axes = "forward-right-down"\nantenna_lever_arm = [0.0, 1.0, 2]\n'

    @FEW
    @given(damages)
    def check(damage):
        (folder / "recording.toml").write_bytes(damaged(raw, damage))
        read_or_refuse(folder)

    check()


@pytest.mark.parametrize("which", [0, 1])
def test_damaged_text(increments, tmp_path, which):
    paths = tmp_path / "imu.txt", tmp_path / "gnss.txt"
    for path, rows in zip(paths, increments, strict=True):
        np.savetxt(path, rows[:300], fmt="%.10f")
    raw = paths[which].read_bytes()

    @FEW
    @given(damages)
    def check(damage):
        paths[which].write_bytes(damaged(raw, damage))
        read_or_refuse(*paths)

    check()


@FEW
@given(
    st.lists(
        st.binary(max_size=200) | st.text("0123456789.-+e, \n\t#%", max_size=200), min_size=1, max_size=2
    )
)
def test_random_bytes(tmp_path, contents):
    folder = tmp_path / "random"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for k, content in enumerate(contents):
        (folder / f"{k}.txt").write_bytes(content if isinstance(content, bytes) else content.encode())
    read_or_refuse(*sorted(folder.iterdir()))
    for name in ("imu.csv", "gnss.csv"):
        shutil.copy(folder / "0.txt", folder / name)
    read_or_refuse(folder)
    (folder / "imu.csv").rename(folder / "imu.parquet")
    read_or_refuse(folder)


def test_odd_paths(tmp_path):
    read_or_refuse(tmp_path)
    read_or_refuse(tmp_path, tmp_path)
    (tmp_path / "imu.parquet").mkdir()
    (tmp_path / "gnss.parquet").mkdir()
    read_or_refuse(tmp_path)
    (tmp_path / "recording.toml").mkdir()
    read_or_refuse(tmp_path)
