"""A recording as a recording folder: the inverse of its reader."""

from __future__ import annotations

import json
import os
from pathlib import Path

from gapless.errors import RecordingError
from gapless.io.axes import FRD
from gapless.io.inertial_log import ACCEL, GYRO
from gapless.io.satellite_log import POSITION, SD_POSITION, SD_VELOCITY, VELOCITY
from gapless.io.writers.atomic import atomic
from gapless.io.writers.table import arrow_table, trajectory_columns
from gapless.trip.recording import Array, Recording
from gapless.units import DEG

_FILES = ("imu", "gnss", "odometer", "reference")


def write_recording(recording: Recording, folder: str | os.PathLike[str]) -> None:
    """Write Parquet files and `recording.toml`; reading them gives the recording back.

    Increments are stored as rates beside their interval `dt`, so they come back to one rounding
    (2e-16 relative); stamps, intervals and fixes of known precision come back exactly, angles in
    degrees to one rounding.

    Parameters
    ----------
    recording : Recording
    folder : str or path
        Made if it is not there; its files of the same names are replaced.

    Raises
    ------
    RecordingError
        If the folder holds another sensor's file that would then belong to this recording.
    """
    import pyarrow.parquet as pq

    folder = Path(folder)
    tables = {"imu": _imu(recording), "gnss": _gnss(recording)}
    if recording.odometer is not None:
        tables["odometer"] = {"time": recording.odometer.time, "speed": recording.odometer.speed}
    if recording.reference is not None:
        tables["reference"] = trajectory_columns(recording.reference)
    _check_free(folder, tables)
    for sensor, columns in tables.items():
        with atomic(folder / f"{sensor}.parquet") as temporary:
            pq.write_table(arrow_table(columns), temporary, compression="zstd", use_dictionary=False)
    with atomic(folder / "recording.toml") as temporary:
        temporary.write_text(_settings(recording), "utf-8")


def _check_free(folder: Path, tables: dict[str, dict[str, Array]]) -> None:
    for sensor in _FILES:
        for suffix in (".parquet", ".csv"):
            path = folder / f"{sensor}{suffix}"
            if path.exists() and not (suffix == ".parquet" and sensor in tables):
                raise RecordingError(
                    f"{path}: in the way, it would become part of the new recording; "
                    "remove it or choose another folder"
                )


def _imu(recording: Recording) -> dict[str, Array]:
    imu = recording.imu
    rates = dict(zip(GYRO, (imu.dtheta / imu.dt[:, None]).T, strict=True))
    forces = dict(zip(ACCEL, (imu.dvel / imu.dt[:, None]).T, strict=True))
    return {"time": imu.time, **rates, **forces, "dt": imu.dt}


def _gnss(recording: Recording) -> dict[str, Array]:
    gnss = recording.gnss
    columns = {"time": gnss.time}
    for names, values in (
        (POSITION, gnss.lla),
        (VELOCITY, gnss.v_n),
        (SD_POSITION, gnss.sd_position),
        (SD_VELOCITY, gnss.sd_velocity),
    ):
        columns.update(zip(names, values.T, strict=True))
    columns["lat"] = columns["lat"] / DEG
    columns["lon"] = columns["lon"] / DEG
    columns["fix"] = gnss.fix.astype(float)
    return columns


def _settings(recording: Recording) -> str:
    lines = [f"name = {_text(recording.name)}", f'imu_axes = "{FRD}"']
    if recording.lever_arm is not None:
        lines.append(f"antenna_lever_arm = {[float(x) for x in recording.lever_arm]}")
    lines.append(f'reference_clock = "{recording.reference_clock}"')
    if recording.grade is not None:
        lines.append(f"grade = {_text(recording.grade)}")
    return "\n".join(lines) + "\n"


def _text(value: str) -> str:
    """A TOML basic string: JSON's escapes are TOML's, but for DEL."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
