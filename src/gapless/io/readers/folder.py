"""Our own recording folder: `recording.toml` and one Parquet or CSV file a sensor."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from gapless.errors import RecordingError
from gapless.io.assemble import assemble
from gapless.io.axes import FRD, axes_matrix
from gapless.io.inertial_log import IMU_COLUMNS
from gapless.io.log import readable
from gapless.io.other_logs import ODOMETER_COLUMNS, REFERENCE_COLUMNS
from gapless.io.satellite_log import GNSS_COLUMNS
from gapless.io.tables import load
from gapless.trip.recording import Array, Recording

SETTINGS: Final = "recording.toml"
KEYS: Final = {
    "name": "text",
    "imu_axes": 'where the logged x, y, z point, such as "right-forward-up"',
    "antenna_lever_arm": "[forward, right, down] from the IMU, m",
    "grade": "name of a sensor grade",
    "reference_clock": '"imu" or "gnss"',
}
"""What `recording.toml` may say; all optional."""
SENSORS: Final = {
    "imu": IMU_COLUMNS,
    "gnss": GNSS_COLUMNS,
    "odometer": ODOMETER_COLUMNS,
    "reference": REFERENCE_COLUMNS,
}
SUFFIXES: Final = (".parquet", ".csv")


class Folder:
    """The recording folder.

    `imu_axes` is "forward-right-down" and the lever arm zero where `recording.toml` is silent. The
    reference's clock is "gnss" if it holds positions only, as a receiver logs them, else "imu".
    """

    name = "recording folder"
    description = (
        "imu and gnss, if there are odometer and reference, each .parquet or .csv, and recording.toml"
    )

    def sniff(self, paths: Sequence[Path]) -> bool:
        """Whether it is one folder with `recording.toml` or an IMU file.

        Parameters
        ----------
        paths : sequence of Path

        Returns
        -------
        bool
        """
        if len(paths) != 1 or not paths[0].is_dir():
            return False
        return any((paths[0] / name).exists() for name in (SETTINGS, *(f"imu{s}" for s in SUFFIXES)))

    def read(self, paths: Sequence[Path]) -> Recording:
        """Read the folder.

        Parameters
        ----------
        paths : sequence of Path
            One folder.

        Returns
        -------
        Recording

        Raises
        ------
        RecordingError
            If a file, column, key or value is missing or wrong.
        """
        (folder,) = paths
        settings = _settings(folder / SETTINGS)
        logs = {sensor: load(path, SENSORS[sensor]) for sensor, path in _files(folder).items()}
        for sensor in ("imu", "gnss"):
            if sensor not in logs:
                raise RecordingError(f"{folder}: no {sensor}.parquet or {sensor}.csv; add the {sensor} log")
        return assemble(
            settings.get("name", readable(folder.resolve().name)),
            logs["imu"],
            logs["gnss"],
            odometer=logs.get("odometer"),
            reference=logs.get("reference"),
            axes=axes_matrix(settings.get("imu_axes", FRD), str(folder / SETTINGS)),
            lever_arm=settings.get("antenna_lever_arm"),
            grade=settings.get("grade"),
            reference_clock=settings.get("reference_clock"),
        )


def _files(folder: Path) -> dict[str, Path]:
    """The file of each sensor that the folder has."""
    files = {}
    for sensor in SENSORS:
        there = [path for path in (folder / f"{sensor}{suffix}" for suffix in SUFFIXES) if path.exists()]
        if len(there) > 1:
            raise RecordingError(f"{there[0]}: {there[1].name} is there too; keep one of the two")
        if there:
            files[sensor] = there[0]
    return files


def _settings(path: Path) -> dict[str, Any]:
    """`recording.toml`, every value of its type."""
    if not path.exists():
        return {}
    try:
        settings = tomllib.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise RecordingError(
            f"{path}: not TOML ({str(error).splitlines()[0][:160]}); mend that line"
        ) from error
    for key, value in settings.items():
        if key not in KEYS:
            raise RecordingError(f"{path}: unknown key {key!r}; the keys are {', '.join(KEYS)}")
        if key != "antenna_lever_arm" and not isinstance(value, str):
            raise RecordingError(f"{path}: {key} = {value!r} is not text; write {KEYS[key]}")
    if settings.get("reference_clock", "imu") not in ("imu", "gnss"):
        raise RecordingError(f"{path}: reference_clock is neither; write {KEYS['reference_clock']}")
    if "antenna_lever_arm" in settings:
        settings["antenna_lever_arm"] = _lever_arm(path, settings["antenna_lever_arm"])
    return settings


def _lever_arm(path: Path, value: object) -> Array:
    numbers = value if isinstance(value, list) else []
    good = [x for x in numbers if isinstance(x, int | float) and math.isfinite(x) and abs(x) < 100.0]
    if len(numbers) != 3 or len(good) != 3:
        raise RecordingError(f"{path}: antenna_lever_arm = {value!r}; write {KEYS['antenna_lever_arm']}")
    return np.array(good, float)
