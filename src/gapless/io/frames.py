"""pandas in and out, for those who want it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gapless.errors import MissingExtraError, RecordingError
from gapless.io.assemble import assemble
from gapless.io.axes import FRD, axes_matrix
from gapless.io.inertial_log import DTHETA, DVEL, IMU_COLUMNS
from gapless.io.log import Log
from gapless.io.other_logs import ODOMETER_COLUMNS, REFERENCE_COLUMNS
from gapless.io.satellite_log import GNSS_COLUMNS
from gapless.io.writers.table import SOURCES, solution_columns
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

if TYPE_CHECKING:
    import pandas as pd


def to_pandas(solution: Solution) -> pd.DataFrame:
    """A solution as a data frame: the columns of `solution.parquet`.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    pandas.DataFrame
        See `solution_columns` for names and units; `source` is categorical.

    Raises
    ------
    MissingExtraError
        If pandas is not installed.
    """
    pd = _pandas()
    columns: dict[str, Any] = dict(solution_columns(solution))
    columns["source"] = pd.Categorical(solution.trajectory.source, categories=list(SOURCES))
    return pd.DataFrame(columns)


def recording_from_frames(
    imu: pd.DataFrame,
    gnss: pd.DataFrame,
    *,
    odometer: pd.DataFrame | None = None,
    reference: pd.DataFrame | None = None,
    name: str = "recording",
    imu_axes: str = FRD,
    antenna_lever_arm: Sequence[float] | None = None,
    grade: str | None = None,
    reference_clock: str | None = None,
) -> Recording:
    """A recording from data frames with the columns of the recording folder.

    Parameters
    ----------
    imu : pandas.DataFrame
        `time` [s], `gyro_x..z` [rad/s], `accel_x..z` [m/s^2], optionally `dt` [s]; or increments
        `dtheta_x..z` [rad], `dvel_x..z` [m/s] in forward-right-down.
    gnss : pandas.DataFrame
        `time` [s], `lat`, `lon` [deg], `height` [m]; optionally `v_north..down` [m/s], `sd_...`, `fix`.
    odometer : pandas.DataFrame, optional
        `time` [s], `speed` [m/s].
    reference : pandas.DataFrame, optional
        `time`, `lat`, `lon`, `height`; optionally velocity and `roll`, `pitch`, `heading` [deg].
    name : str
    imu_axes : str
        Where the logged x, y, z point.
    antenna_lever_arm : sequence of 3 floats, optional
        Antenna from the IMU, FRD [m]; leave it out where it is not known.
    grade : str, optional
    reference_clock : str, optional
        "imu" or "gnss".

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        As the folder's reader.
    MissingExtraError
        If pandas is not installed.
    """
    _pandas()
    return assemble(
        name,
        _log("imu", imu, (*IMU_COLUMNS, *DTHETA, *DVEL)),
        _log("gnss", gnss, GNSS_COLUMNS),
        odometer=None if odometer is None else _log("odometer", odometer, ODOMETER_COLUMNS),
        reference=None if reference is None else _log("reference", reference, REFERENCE_COLUMNS),
        axes=axes_matrix(imu_axes),
        lever_arm=None if antenna_lever_arm is None else np.array(antenna_lever_arm, float),
        grade=grade,
        reference_clock=reference_clock,
    )


def _log(sensor: str, frame: pd.DataFrame, wanted: Collection[str]) -> Log:
    columns = {}
    for name in frame.columns:
        if name in wanted:
            try:
                columns[name] = frame[name].to_numpy(dtype=float, na_value=np.nan)
            except (TypeError, ValueError) as error:
                raise RecordingError(
                    f"{sensor}: column {name} is not numeric ({error}); convert it"
                ) from error
    return Log(sensor, columns, first_row=0)


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise MissingExtraError("pandas", "pandas") from error
    return pandas
