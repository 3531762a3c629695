"""KF-GINS-style text: a file of IMU increments and a file of GNSS fixes, in either order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from gapless.errors import RecordingError
from gapless.io.assemble import assemble
from gapless.io.inertial_log import DTHETA, DVEL
from gapless.io.log import readable
from gapless.io.satellite_log import POSITION, SD_POSITION, SD_VELOCITY, VELOCITY
from gapless.io.text import first_data_line, load_numbers, read_head
from gapless.trip.recording import Array, Recording

IMU_LAYOUT: Final = ("time", *DTHETA, *DVEL)
GNSS_LAYOUTS: Final = (
    ("time", *POSITION, *SD_POSITION),
    ("time", *POSITION, *SD_POSITION, *VELOCITY, *SD_VELOCITY),
)
_ROWS: Final = 50
"""Rows looked at to tell which file is which."""


class KfGins:
    """Two text files; axes forward-right-down, time in seconds, no lever arm."""

    name = "KF-GINS text"
    description = (
        "two text files, IMU (time, dtheta xyz rad, dvel xyz m/s) and GNSS "
        "(time, lat, lon deg, h, 3 sd, optionally velocity NED and its 3 sd)"
    )

    def sniff(self, paths: Sequence[Path]) -> bool:
        """Whether it is two text files whose rows begin with seven numbers or more.

        Parameters
        ----------
        paths : sequence of Path

        Returns
        -------
        bool
        """
        return len(paths) == 2 and all(path.is_file() and _head(path).shape[1] >= 7 for path in paths)

    def read(self, paths: Sequence[Path]) -> Recording:
        """Read both; the one with the shorter interval between rows is the IMU's.

        Parameters
        ----------
        paths : sequence of Path
            Two files in either order.

        Returns
        -------
        Recording
            Named after the IMU file.

        Raises
        ------
        RecordingError
        """
        imu, gnss = sorted(paths, key=_interval)
        return assemble(readable(imu.stem), load_numbers(imu, [IMU_LAYOUT]), load_numbers(gnss, GNSS_LAYOUTS))


def _head(path: Path) -> Array:
    """The first rows of a text file, as far as they are numbers; no columns if none is."""
    try:
        raw = read_head(path)
    except OSError:
        return np.empty((0, 0))
    _, start, first = first_data_line(raw)
    rows: list[list[float]] = []
    for line in raw[start:].split(b"\n")[:_ROWS]:
        try:
            row = [float(word) for word in line.replace(b",", b" ").split()]
        except ValueError:
            break
        if row and len(row) != len(first):
            break
        if row:
            rows.append(row)
    return np.array(rows).reshape(len(rows), -1) if rows else np.empty((0, 0))


def _interval(path: Path) -> float:
    """Median interval [s] of a file's first rows: an IMU's is the shorter."""
    head = _head(path)
    if len(head) < 2:
        raise RecordingError(f"{path}: one row of data; give a log of two rows or more")
    return float(np.median(np.abs(np.diff(head[:, 0]))))
