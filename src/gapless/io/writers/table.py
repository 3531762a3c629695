"""A solution as columns: names and units that users meet."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, Final

import numpy as np

from gapless.trip.recording import Array, Trajectory
from gapless.trip.solution import Solution
from gapless.units import DEG

SOURCES: Final = ("gnss", "bridge", "constraints", "ins", "reference")
"""What may hold a row, best first."""
SD_COLUMNS: Final = (
    *("sd_north", "sd_east", "sd_down", "sd_v_north", "sd_v_east", "sd_v_down"),
    *("sd_roll", "sd_pitch", "sd_heading"),
)


def trajectory_columns(trajectory: Trajectory) -> dict[str, Array]:
    """Time, position, velocity and attitude in the units of files.

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    dict of str to ndarray, shape (n,)
        `time` [s]; `lat`, `lon` [deg], `height` [m]; `v_north`, `v_east`, `v_down` [m/s]; `roll`,
        `pitch` [deg], `heading` [deg, 0 <= heading < 360].
    """
    lla, v_n, euler = trajectory.lla, trajectory.v_n, trajectory.euler
    heading = np.mod(euler[:, 2] / DEG, 360.0)
    heading[heading == 360.0] = 0.0  # the remainder of a tiny negative angle rounds up
    return {
        "time": trajectory.time,
        "lat": lla[:, 0] / DEG,
        "lon": lla[:, 1] / DEG,
        "height": lla[:, 2],
        "v_north": v_n[:, 0],
        "v_east": v_n[:, 1],
        "v_down": v_n[:, 2],
        "roll": euler[:, 0] / DEG,
        "pitch": euler[:, 1] / DEG,
        "heading": heading,
    }


def solution_columns(solution: Solution) -> dict[str, Array]:
    """The numeric columns of a solution file; `source` comes beside them.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    dict of str to ndarray, shape (n,)
        Those of `trajectory_columns`, then one standard deviation of each: `sd_north`, `sd_east`,
        `sd_down` [m], `sd_v_north`, `sd_v_east`, `sd_v_down` [m/s], `sd_roll`, `sd_pitch`,
        `sd_heading` [deg]; then `cov_north_east` [m^2], without which two deviations are no ellipse.
    """
    columns = trajectory_columns(solution.trajectory)
    scale = np.repeat([1.0, 1.0, 1.0 / DEG], 3)
    for name, column in zip(SD_COLUMNS, (solution.trajectory.sd * scale).T, strict=True):
        columns[name] = np.ascontiguousarray(column)
    columns["cov_north_east"] = np.ascontiguousarray(solution.trajectory.horizontal)
    return columns


def arrow_table(columns: dict[str, Array], source: Any = None) -> Any:
    """An Arrow table of float64 columns, and of `source` as a dictionary of strings.

    `pyarrow.array` of a NumPy array imports pandas where that is installed (0.2 s); buffers do not.

    Parameters
    ----------
    columns : dict of str to ndarray, shape (n,)
    source : ndarray of str, shape (n,), optional

    Returns
    -------
    pyarrow.Table
    """
    import pyarrow as pa

    arrays = [_arrow(pa.float64(), np.ascontiguousarray(column, float)) for column in columns.values()]
    names = list(columns)
    if source is not None:
        words, codes = np.unique(source, return_inverse=True)
        letters = np.frombuffer("".join(words).encode(), np.uint8)
        ends = np.cumsum([0, *(len(word.encode()) for word in words)]).astype(np.int32)
        text = pa.Array.from_buffers(
            pa.string(), len(words), [None, pa.py_buffer(ends), pa.py_buffer(letters)]
        )
        arrays.append(pa.DictionaryArray.from_arrays(_arrow(pa.int32(), codes.astype(np.int32)), text))
        names.append("source")
    return pa.Table.from_arrays(arrays, names=names)


def runs(solution: Solution) -> Iterator[tuple[str, slice]]:
    """Stretches of one source; each begins with the last row of the one before, so lines join.

    Parameters
    ----------
    solution : Solution

    Yields
    ------
    source : str
    rows : slice
    """
    source = solution.trajectory.source
    if not len(source):
        return
    starts = np.flatnonzero(source[1:] != source[:-1]) + 1
    bounds = [0, *starts.tolist(), len(source)]
    for a, b in pairwise(bounds):
        yield str(source[a]), slice(max(a - 1, 0), b)


def cut(points: Array) -> list[Array]:
    """A line in pieces, none of which crosses the meridian of 180 degrees.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Longitude, latitude [deg], height [m].

    Returns
    -------
    list of ndarray, shape (k, 3)
        Each of two points or more; where it was cut, one piece ends and the next begins on the meridian.
    """
    lon = points[:, 0]
    crossings = 1 + np.flatnonzero(np.abs(np.diff(lon)) > 180.0)
    pieces, begin, head = list[Array](), 0, np.empty((0, 3))
    for k in crossings.tolist():
        seam = float(np.copysign(180.0, lon[k - 1]))
        share = (seam - lon[k - 1]) / (lon[k] + 2.0 * seam - lon[k - 1])
        at = points[k - 1, 1:] + share * (points[k, 1:] - points[k - 1, 1:])
        pieces.append(np.vstack([head, points[begin:k], [seam, *at]]))
        begin, head = k, np.array([[-seam, *at]])
    pieces.append(np.vstack([head, points[begin:]]))
    return [piece if len(piece) > 1 else np.vstack([piece, piece]) for piece in pieces]


def _arrow(kind: Any, values: Any) -> Any:
    import pyarrow as pa

    return pa.Array.from_buffers(kind, len(values), [None, pa.py_buffer(values)])
