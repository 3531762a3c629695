"""What the IMU felt over a window of time."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gapless._numba import kernel
from gapless.trip.events import ImuBlock
from gapless.trip.recording import Array


class Felt(NamedTuple):
    """Samples of a window.

    Parameters
    ----------
    rows : ndarray, shape (k, 7)
        Middle of each sample's interval [s], mean rate [rad/s], mean specific force [m/s^2].
    rate : float
        Samples a second: one by the median distance.
    gap : float
        Largest distance [s].
    """

    rows: Array
    rate: float
    gap: float


def felt(block: ImuBlock, begin: float, end: float) -> Felt | None:
    """Samples between two times.

    Parameters
    ----------
    block : ImuBlock
        It may reach beyond the window.
    begin, end : float
        [s]

    Returns
    -------
    Felt or None
        None where there are fewer than three.
    """
    rows = _rows(*block.within(begin, end))
    rows = rows[rows[:, 0].searchsorted(begin) :]
    return Felt(rows, *_distances(rows[:, 0])) if len(rows) >= 3 else None


@kernel
def _rows(time: Array, dt: Array, dtheta: Array, dvel: Array) -> Array:
    rows = np.empty((time.size, 7))
    for k in range(time.size):
        rows[k, 0] = time[k] - 0.5 * dt[k]
        for j in range(3):
            rows[k, 1 + j], rows[k, 4 + j] = dtheta[k, j] / dt[k], dvel[k, j] / dt[k]
    return rows


@kernel
def _distances(time: Array) -> tuple[Any, Any]:
    apart = time[1:] - time[:-1]
    return 1.0 / np.median(apart), apart.max()
