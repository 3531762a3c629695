"""The recording folder: what is read, mended and said."""

import subprocess
import sys

import numpy as np
import pytest

from gapless import io
from gapless.errors import RecordingError
from gapless.units import DEG


def texts(recording):
    return " | ".join(f"{note.where}: {note.what} ({note.count})" for note in recording.notes)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_reads_every_sensor(drive, write_drive, suffix):
    r = io.read(write_drive(drive, suffix))
    imu = drive["imu"]
    np.testing.assert_array_equal(r.imu.time, imu["time"])
    # stamps of 1e3 s are resolved to 1e-13 s, 1e-11 of an interval of 10 ms
    np.testing.assert_allclose(r.imu.dt, 0.01, rtol=1e-10)
    np.testing.assert_allclose(r.imu.dvel[:, 2], imu["accel_z"] * 0.01, rtol=1e-10)
    np.testing.assert_allclose(r.gnss.lla[:, 0], drive["gnss"]["lat"] * DEG, rtol=1e-15)  # one rounding
    np.testing.assert_array_equal(r.gnss.v_n[:, 1], drive["gnss"]["v_east"])
    np.testing.assert_array_equal(r.odometer.speed, drive["odometer"]["speed"])
    # heading comes back in (-180, 180]: the same direction
    turned = np.exp(1j * r.reference.euler[:, 2])
    np.testing.assert_allclose(turned, np.exp(1j * drive["reference"]["heading"] * DEG), atol=1e-14)
    assert (r.name, r.reference_clock, r.notes) == ("drive", "imu", ())


def test_settings(drive, write_drive):
    toml = (
        'name = "trip 7"\nantenna_lever_arm = [1, -0.5, 0.25]\ngrade = "consumer"\nreference_clock = "gnss"\n'
    )
    r = io.read(write_drive(drive, settings=toml))
    assert (r.name, r.grade, r.reference_clock) == ("trip 7", "consumer", "gnss")
    np.testing.assert_array_equal(r.lever_arm, [1.0, -0.5, 0.25])


def test_reference_of_positions_only_is_on_the_receivers_clock(drive, write_drive):
    drive["reference"] = {
        k: v for k, v in drive["reference"].items() if k in ("time", "lat", "lon", "height")
    }
    r = io.read(write_drive(drive))
    assert r.reference_clock == "gnss"
    assert np.isnan(r.reference.v_n).all()
    assert np.isnan(r.reference.euler).all()


def test_axes_turn_gravity_down(drive, write_drive):
    imu = drive["imu"]
    # the same motion logged with x right, y forward, z up
    for kind in ("gyro", "accel"):
        x, y, z = (imu[f"{kind}_{axis}"] for axis in "xyz")
        imu[f"{kind}_x"], imu[f"{kind}_y"], imu[f"{kind}_z"] = y, x, -z
    r = io.read(write_drive(drive, settings='imu_axes = "right-forward-up"'))
    force = r.imu.dvel.mean(axis=0) / 0.01
    np.testing.assert_allclose(force, [0.0, 0.5, -9.8], atol=1e-3)  # mean of 10,000 draws of 0.02: 2e-4


@pytest.mark.parametrize(
    ("names", "says"),
    [
        ("right-forward-down", '"right-forward-up"'),
        ("forward-right", "is not three of"),
        ("fwd-right-down", "is not three of"),
        ("forward-back-up", "one line"),
        (None, "is not three of"),
    ],
)
def test_axes_refused(names, says):
    with pytest.raises(RecordingError, match="imu_axes") as error:
        io.axes_matrix(names)
    assert says in str(error.value)


def test_every_right_handed_triple_is_a_rotation():
    words = ("forward", "back", "right", "left", "up", "down")
    good = 0
    for triple in [f"{a}-{b}-{c}" for a in words for b in words for c in words]:
        try:
            matrix = io.axes_matrix(triple)
        except RecordingError:
            continue
        good += 1
        np.testing.assert_array_equal(matrix @ matrix.T, np.eye(3))
    assert good == 24  # the proper rotations of a cube


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        ('axes = "forward-right-down"', "unknown key 'axes'; the keys are name, imu_axes"),
        ("antenna_lever_arm = [1, 2]", "antenna_lever_arm = [1, 2]; write [forward, right, down]"),
        ('antenna_lever_arm = [1, 2, "x"]', "write [forward, right, down]"),
        ("name = 7", "name = 7 is not text"),
        ('reference_clock = "gps"', 'write "imu" or "gnss"'),
        ("name = ", "not TOML"),
        ("name = 'a\nb'", "not TOML"),
    ],
)
def test_settings_refused(drive, write_drive, toml, says):
    with pytest.raises(RecordingError) as error:
        io.read(write_drive(drive, settings=toml))
    assert "recording.toml: " in str(error.value)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_reading_parquet_imports_no_pandas(drive, write_drive):
    folder = write_drive(drive, ".parquet")
    code = f"import sys, gapless.io as io; io.read({str(folder)!r}); sys.exit('pandas' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


LENGTH = {"beijing-a": 867, "beijing-c": 829, "beijing-d": 774, "beijing-e1": 1019, "beijing-e2": 1005}
LENGTH |= {"colorado": 549, "kingston": 2100}


@pytest.mark.parametrize("name", LENGTH)
def test_real_recordings(recordings, name):
    r = io.read(recordings / name)
    assert r.name == name
    assert abs(r.duration - LENGTH[name]) < 1.0  # the lengths are stated to a second
    start = r.imu.time - r.imu.dt
    assert (np.diff(r.imu.time) > 0.0).all()
    assert (r.imu.dt > 0.0).all()
    # an interval may not begin before the last one ended, but for the rounding of stamps of 3e5 s
    assert (start[1:] - r.imu.time[:-1] > -1e-9).all()
    force = (r.imu.dvel / r.imu.dt[:, None]).mean(axis=0)
    assert -10.5 < force[2] < -8.5  # gravity is down, within the biases of consumer sensors
    assert r.reference_clock == ("gnss" if name == "beijing-a" else "imu")


def test_real_ticks_gaps_and_codes_are_said(recordings):
    assert "703 stamps repeat" in texts(io.read(recordings / "beijing-c"))
    assert "gaps, 34.9 s in all" in texts(io.read(recordings / "beijing-e1"))
    assert "no fix code" in texts(io.read(recordings / "kingston"))
