"""When a box leans otherwise than before by more than any road, in a trajectory."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.trip.recording import Array, Trajectory
from gapless.units import DEG

ANGLE: Final = 15.0 * DEG
"""No road, no corner and no spring makes a car lean by so much for long [rad]."""
LASTING: Final = 10
"""Means over so many whole seconds before and after are compared."""
BETWEEN: Final = 2
"""And so many seconds are left out between them: the turn itself."""


def leans(trajectory: Trajectory) -> list[tuple[float, float]]:
    """Moments at which the direction of gravity in the box changed for long.

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    list of (float, float)
        Time [s], and angle [rad]; the largest change of each.
    """
    time = np.arange(trajectory.time[0], trajectory.time[-1], 1.0)
    rows = np.minimum(np.searchsorted(trajectory.time, time), len(trajectory) - 1)
    down = _down(trajectory.euler[rows])
    if len(down) < 2 * LASTING + BETWEEN + 1:
        return []
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(down, axis=0)])
    means = sums[LASTING:] - sums[:-LASTING]
    means = means / np.linalg.norm(means, axis=1)[:, None]
    ahead = LASTING + BETWEEN
    angle = np.arccos(np.clip(np.sum(means[:-ahead] * means[ahead:], axis=1), -1.0, 1.0))
    found, k = [], 0
    while k < len(angle):
        if angle[k] > ANGLE:
            peak = k + int(np.argmax(angle[k : k + ahead + LASTING]))
            found.append((float(time[peak + LASTING]) + 0.5 * BETWEEN, float(angle[peak])))
            k = peak + ahead + LASTING
        k += 1
    return found


def _down(euler: Array) -> Array:
    """Direction of gravity in the box."""
    roll, pitch = euler[:, 0], euler[:, 1]
    return np.column_stack([-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)])
