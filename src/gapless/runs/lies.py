"""How a channel lied while it was not believed, by what it said."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.trip.motion import offset_ned
from gapless.trip.recording import Array, Recording, Trajectory
from gapless.trip.solution import Innovations

DRIVES: Final = 1.0
"""A car that is faster drives [m/s]."""
STANDS: Final = 0.3
"""A sensor that says less as a rule while it does says that it stands [m/s]."""
SHARE: Final = 0.1
"""Who went less of the way stood [1]."""
FAR: Final = 20.0
"""Way on which that is clear [m]."""
AT_ONCE: Final = 0.5
"""Who was so much of the largest error away at first went there in one leap [1]."""


def how(
    channel: str,
    told: Innovations,
    rows: NDArray[np.bool_],
    recording: Recording,
    trajectory: Trajectory,
    offset: float,
) -> str:
    """A clause that names a lie.

    Parameters
    ----------
    channel : str
        "position", "velocity" or "odometer".
    told : Innovations
        Of it.
    rows : ndarray of bool, shape (k,)
        Those that were not believed.
    recording : Recording
        What was logged.
    trajectory : Trajectory
        How the car went.
    offset : float
        Of the channel's clock [s].

    Returns
    -------
    str
    """
    span = float(told.time[rows][0]), float(told.time[rows][-1])
    time, said = _logged(channel, recording, span[0] - offset, span[1] - offset)
    speed = np.interp(time + offset, trajectory.time, np.hypot(trajectory.v_n[:, 0], trajectory.v_n[:, 1]))
    drove = speed > DRIVES
    repeats = len(said) > 2 and float(np.mean((np.diff(said, axis=0) == 0.0).all(axis=1))) > 0.5
    if channel == "position":
        if drove.any() and not repeats and _stood(said, float(np.mean(speed)) * (span[1] - span[0])):
            return "it stood while the car drove"
    elif drove.any() and float(np.median(np.linalg.norm(said[drove, :2], axis=1))) < STANDS:
        return "it said zero while the car drove"
    if repeats:
        return "it repeated itself to the bit"
    return _aside(told.z[rows]) if channel == "position" else _apart(told.z[rows])


def _logged(channel: str, recording: Recording, begin: float, end: float) -> tuple[Array, Array]:
    """Stamps and readings of a channel in a span of its own clock."""
    if channel == "odometer":
        wheel = recording.odometer
        if wheel is None:
            return np.zeros(0), np.zeros((0, 1))
        inside = (wheel.time >= begin) & (wheel.time <= end)
        return wheel.time[inside], wheel.speed[inside].reshape(-1, 1)
    gnss = recording.gnss
    values = gnss.lla if channel == "position" else gnss.v_n
    inside = (gnss.time >= begin) & (gnss.time <= end) & np.isfinite(values).all(axis=1)
    return gnss.time[inside], values[inside]


def _stood(lla: Array, way: float) -> bool:
    """Whether positions stayed in place on a way that was long enough."""
    if len(lla) < 2 or way < FAR:
        return False
    off = offset_ned(lla, np.broadcast_to(lla[0], lla.shape))
    return float(np.hypot(off[:, 0], off[:, 1]).max()) < SHARE * way


def _aside(z: Array) -> str:
    """Where positions were that moved."""
    level = np.hypot(z[:, 0], z[:, 1])
    height = np.abs(z[:, 2]) if z.shape[1] > 2 else np.zeros(len(z))
    if np.median(height) > 2.0 * np.median(level):
        return f"its height was off by {np.median(height):.0f} m"
    if level[0] > AT_ONCE * level.max():
        return f"it lay {np.median(level):.0f} m aside"
    return f"it did not move as was felt, and strayed by up to {level.max():.0f} m"


def _apart(z: Array) -> str:
    """How far off speeds were that did not change as was felt."""
    off = np.linalg.norm(z[:, :2], axis=1)
    return f"it did not change as was felt, and was off by up to {off.max():.1f} m/s"
