"""A recording as a recording folder: the inverse of its reader."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any, Final

from gapless.errors import RecordingError
from gapless.io.axes import FRD
from gapless.io.inertial_log import ACCEL, GYRO
from gapless.io.marks import check_ours, in_toml, marked
from gapless.io.satellite_log import POSITION, SD_POSITION, SD_VELOCITY, VELOCITY
from gapless.io.writers.atomic import together
from gapless.io.writers.table import arrow_table, trajectory_columns
from gapless.trip.recording import Array, Recording
from gapless.units import DEG

SENSORS: Final = ("imu", "gnss", "odometer", "reference")
SETTINGS: Final = "recording.toml"


def write_recording(recording: Recording, folder: str | os.PathLike[str], force: bool = False) -> None:
    """Write Parquet files and `recording.toml`; reading them gives the recording back.

    Increments are stored as rates beside their interval `dt`, so they come back to one rounding
    (2e-16 relative); stamps, intervals and fixes of known precision come back exactly, angles in
    degrees to one rounding.

    Parameters
    ----------
    recording : Recording
    folder : str or path
        Made if it is not there; files of ours under the same names are replaced, all together.
    force : bool
        Replace them whoever wrote them, or edited `recording.toml` since.

    Raises
    ------
    ConfigError
        If one of them is not ours.
    RecordingError
        If the folder holds another sensor's file that would then belong to this recording.
    """
    folder = Path(folder)
    files = recording_files(recording)
    check_free(folder, files)
    check_ours((folder / name for name in files), force, cure="force=True")
    with together(folder / name for name in files) as lent:
        for write, temporary in zip(files.values(), lent, strict=True):
            write(temporary)


def recording_files(recording: Recording, origin: str = "") -> dict[str, Callable[[Path], object]]:
    """What has to be written of a recording.

    Parameters
    ----------
    recording : Recording
    origin : str
        What it was made of, as hexadecimal digits, for the mark of `recording.toml`.

    Returns
    -------
    dict of str to callable
        By file name; each writes its file at a path.
    """
    tables = {"imu": _imu(recording), "gnss": _gnss(recording)}
    if recording.odometer is not None:
        tables["odometer"] = {"time": recording.odometer.time, "speed": recording.odometer.speed}
    if recording.reference is not None:
        tables["reference"] = trajectory_columns(recording.reference)
    files: dict[str, Callable[[Path], object]] = {
        f"{sensor}.parquet": partial(_write_table, columns) for sensor, columns in tables.items()
    }
    return {**files, SETTINGS: partial(_write_text, in_toml(_settings(recording), origin))}


def _write_table(columns: dict[str, Any], path: Path) -> None:
    import pyarrow.parquet as pq

    pq.write_table(marked(arrow_table(columns)), path, compression="zstd", use_dictionary=False)


def _write_text(text: str, path: Path) -> None:
    path.write_bytes(text.encode())  # the mark counts bytes: no other line ends on Windows


def check_free(folder: Path, files: Iterable[str]) -> None:
    """Refuse a folder with the log of a sensor that the new recording has not, or has elsewhere.

    Parameters
    ----------
    folder : Path
    files : iterable of str
        Names that will be written.

    Raises
    ------
    RecordingError
    """
    for sensor in SENSORS:
        for suffix in (".parquet", ".csv"):
            path = folder / f"{sensor}{suffix}"
            if path.exists() and path.name not in files:
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
