"""A short drive on a circle, as columns of each sensor, and ways to put it into files."""

import os
from pathlib import Path

import numpy as np
import pytest

from gapless.earth import ned_to_lla
from gapless.units import DEG

ORIGIN = np.array([48.0 * DEG, 11.0 * DEG, 500.0])


def on_circle(time):
    """A place, velocity [m/s] and heading [rad] on a circle of 200 m at 10 m/s."""
    angle = time * 10.0 / 200.0
    ned = 200.0 * np.column_stack([np.sin(angle), 1.0 - np.cos(angle), np.zeros_like(angle)])
    v_n = 10.0 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
    return ned_to_lla(ned, ORIGIN), v_n, angle


@pytest.fixture
def circle():
    return on_circle


@pytest.fixture
def drive():
    """Columns by sensor, axes forward-right-down, 100 Hz and 5 Hz, 100 s."""
    rng = np.random.default_rng(7)
    t = 1000.0 + np.arange(1, 10001) / 100.0
    gyro = rng.normal([0.0, 0.0, 0.05], 1e-3, (len(t), 3))
    accel = rng.normal([0.0, 0.5, -9.8], 0.02, (len(t), 3))
    imu = {"time": t}
    imu |= dict(zip(("gyro_x", "gyro_y", "gyro_z"), gyro.T, strict=True))
    imu |= dict(zip(("accel_x", "accel_y", "accel_z"), accel.T, strict=True))
    g = np.arange(1000.2, 1100.0, 0.2)
    lla, v_n, heading = on_circle(g - 1000.0)
    place = {"time": g, "lat": lla[:, 0] / DEG, "lon": lla[:, 1] / DEG, "height": lla[:, 2]}
    speed = dict(zip(("v_north", "v_east", "v_down"), v_n.T, strict=True))
    sd = {f"sd_{axis}": np.full(len(g), 1.5) for axis in ("north", "east", "down")}
    sd |= {f"sd_v_{axis}": np.full(len(g), 0.1) for axis in ("north", "east", "down")}
    attitude = {"roll": 0.0 * g, "pitch": 0.0 * g + 1.0, "heading": (heading / DEG) % 360.0}
    return {
        "imu": imu,
        "gnss": {**place, **speed, **sd, "fix": np.ones(len(g))},
        "odometer": {"time": t[::10], "speed": np.full(len(t[::10]), 10.0)},
        "reference": {**place, **speed, **attitude},
    }


@pytest.fixture
def write_drive(tmp_path):
    """Write such columns as a folder of CSV (round-trip digits) or Parquet files."""

    def write(drive, suffix=".csv", settings='imu_axes = "forward-right-down"\n'):
        import pyarrow as pa
        import pyarrow.parquet as pq

        folder = tmp_path / "drive"
        folder.mkdir(exist_ok=True)
        for sensor, columns in drive.items():
            path = folder / f"{sensor}{suffix}"
            if suffix == ".parquet":
                pq.write_table(pa.table(columns), path)
                continue
            lists = [np.asarray(column).tolist() for column in columns.values()]
            rows = [
                ",".join(x if isinstance(x, str) else repr(x) for x in row)
                for row in zip(*lists, strict=True)
            ]
            path.write_text("\n".join([",".join(columns), *rows]) + "\n")
        if settings is not None:
            (folder / "recording.toml").write_text(settings)
        return folder

    return write


@pytest.fixture
def recordings():
    """Folder of the real recordings; the test is skipped where they are absent."""
    root = Path(__file__).parents[3]
    folder = Path(os.environ.get("GAPLESS_RECORDINGS", root.parent / "shared" / "data"))
    if not (folder / "beijing-a" / "recording.toml").exists():
        pytest.skip(f"real recordings are not at {folder}; set GAPLESS_RECORDINGS to their folder")
    return folder


@pytest.fixture
def increments(drive):
    """The same drive as KF-GINS rows: IMU (n, 7) and GNSS (m, 13)."""
    imu, gnss = drive["imu"], drive["gnss"]
    rates = np.column_stack([imu[f"{kind}_{axis}"] for kind in ("gyro", "accel") for axis in "xyz"])
    names = [n for n in gnss if n.startswith("sd_")]
    velocity = ["v_north", "v_east", "v_down"]
    order = ["time", "lat", "lon", "height", *names[:3], *velocity, *names[3:]]
    return np.column_stack([imu["time"], 0.01 * rates]), np.column_stack([gnss[n] for n in order])
