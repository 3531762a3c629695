"""Logs that cannot be used: one clear line, exit code 2, nothing written."""

import numpy as np
import pytest
from click.testing import CliRunner

import gapless as gp
from gapless.cli import gapless

IMU, GNSS = "imu.txt", "gnss.txt"


@pytest.fixture(scope="module")
def tables():
    drive = gp.simulate_drive("urban", duration=120.0)
    imu, gnss = drive.imu, drive.gnss
    lla = np.column_stack([np.degrees(gnss.lla[:, :2]), gnss.lla[:, 2]])
    return {
        IMU: np.column_stack([imu.time, imu.dtheta, imu.dvel]),
        GNSS: np.column_stack([gnss.time, lla, gnss.sd_position, gnss.v_n, gnss.sd_velocity]),
    }


def change(name, rows, columns, value):
    def spoil(tables):
        tables[name][rows, columns] = value(tables[name][rows, columns])

    return spoil


EVERY = slice(None)
SPOILT = {
    "nan in the IMU": (change(IMU, slice(2000, 8000), slice(1, 7), lambda x: x * np.nan), IMU),
    "IMU stamps that go back": (change(IMU, slice(4000, 4500), 0, lambda t: t[::-1].copy()), IMU),
    "IMU columns exchanged": (change(IMU, EVERY, slice(1, 7), lambda x: np.roll(x, 3, axis=1)), IMU),
    "gyros in degrees": (change(IMU, EVERY, slice(1, 4), np.degrees), IMU),
    "lat and lon exchanged": (change(GNSS, EVERY, slice(1, 3), lambda x: x[:, ::-1].copy()), GNSS),
    "latitude beyond the pole": (change(GNSS, EVERY, 1, lambda x: x + 90.0), GNSS),
    "GNSS of another day": (change(GNSS, EVERY, 0, lambda t: t + 86400.0), GNSS),
}


def write(tables, folder):
    for name, table in tables.items():
        np.savetxt(folder / name, table, "%.12f")


def refused(folder):
    """What `fuse` says of a pair of files that it must refuse."""
    words = ["fuse", str(folder / IMU), str(folder / GNSS), "--out", str(folder / "out")]
    done = CliRunner().invoke(gapless, words)
    assert done.exit_code == 2, (done.output, done.exception)
    assert done.stderr.startswith("gapless: ")
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
    assert sorted(path.name for path in folder.iterdir()) == [GNSS, IMU]
    return done.stderr


@pytest.mark.parametrize("case", SPOILT)
def test_spoilt_logs_are_refused_by_name(tables, tmp_path, case):
    spoil, culprit = SPOILT[case]
    copies = {name: table.copy() for name, table in tables.items()}
    spoil(copies)
    write(copies, tmp_path)
    assert culprit in refused(tmp_path)


def test_a_truncated_file(tables, tmp_path):
    write(tables, tmp_path)
    text = (tmp_path / IMU).read_bytes()
    (tmp_path / IMU).write_bytes(text[: len(text) // 2 + 17])
    assert IMU in refused(tmp_path)


def test_a_sound_pair_is_fused(tables, tmp_path):
    """The control: unspoilt, the same pair goes through."""
    write(tables, tmp_path)
    words = ["fuse", str(tmp_path / GNSS), str(tmp_path / IMU), "--no-report", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(gapless, words)
    assert done.exit_code == 0, done.output
    assert (tmp_path / "out" / "solution.parquet").exists()
