"""Which way the logged axes point: a signed permutation into forward-right-down."""

from __future__ import annotations

from itertools import permutations
from typing import Final

import numpy as np

from gapless.errors import RecordingError
from gapless.trip.recording import Array

FRD: Final = "forward-right-down"
"""The body axes used inside."""

_DIRECTIONS: Final = {
    "forward": (1, 0, 0),
    "back": (-1, 0, 0),
    "right": (0, 1, 0),
    "left": (0, -1, 0),
    "down": (0, 0, 1),
    "up": (0, 0, -1),
}


def axes_matrix(names: object, where: str = "imu_axes") -> Array:
    """Matrix that turns vectors along the logged axes into forward-right-down.

    Parameters
    ----------
    names : str
        Where the logged x, y and z point in the vehicle, such as "right-forward-up".
    where : str
        Who says so, for the error.

    Returns
    -------
    ndarray, shape (3, 3)
        A rotation of zeros and signed ones: v_frd = matrix @ v_logged.

    Raises
    ------
    RecordingError
        If a name is unknown, two axes lie along one line, or the triple is left-handed.
    """
    words = names.split("-") if isinstance(names, str) else []
    if len(words) != 3 or any(word not in _DIRECTIONS for word in words):
        raise RecordingError(
            f"{where}: imu_axes = {names!r} is not three of {', '.join(_DIRECTIONS)}; "
            'write where the logged x, y, z point, such as "right-forward-up"'
        )
    matrix = np.array([_DIRECTIONS[word] for word in words], float).T
    hand = round(float(np.linalg.det(matrix)))
    if hand == 0:
        raise RecordingError(
            f"{where}: imu_axes = {names!r} names two axes along one line; name three that are perpendicular"
        )
    if hand < 0:
        opposite = next(w for w, d in _DIRECTIONS.items() if np.array_equal(d, -matrix[:, 2]))
        raise RecordingError(
            f"{where}: imu_axes = {names!r} is left-handed; a right-handed one is "
            f'"{words[0]}-{words[1]}-{opposite}": check which axis is meant'
        )
    return matrix


def nearest_axes(matrix: Array) -> str:
    """What logged axes are called, each by the direction that it is nearest to.

    Parameters
    ----------
    matrix : ndarray, shape (3, 3)
        A rotation of vectors along the logged axes into forward-right-down.

    Returns
    -------
    str
        As `axes_matrix` takes it; of the 24 right-handed triples the one with the least angle to it.
    """
    triples = ("-".join(names) for names in permutations(_DIRECTIONS, 3))
    columns = {t: np.array([_DIRECTIONS[word] for word in t.split("-")], float).T for t in triples}
    fits = {t: float((m * matrix).sum()) for t, m in columns.items() if np.linalg.det(m) > 0.5}
    return max(fits, key=lambda t: fits[t])
