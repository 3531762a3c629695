"""What is measured in a window: errors by axis, their RMSE and the largest."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gapless.evaluation import Errors
from gapless.evaluation.statistics import rms
from gapless.trip.recording import Array
from gapless.units import DEG

NED: Final = ("north", "east", "down")
"""Axes of position and velocity."""
ANGLES: Final = ("roll", "pitch", "heading")
"""Axes of the attitude."""


def measure(errors: Errors) -> dict[str, float]:
    """RMSE and largest error of every quantity over given epochs.

    Parameters
    ----------
    errors : Errors

    Returns
    -------
    dict of str to float
        "position_east_rmse" [m] and so on, "velocity_north_max" [m/s], "attitude_heading_rmse" [deg],
        "horizontal_rmse" and "spatial_max" [m]. The mean offset of the height is left in. NaN where
        nothing is known; "epochs" counts those with a known horizontal error.
    """
    found = {"epochs": float(np.isfinite(errors.horizontal).sum())}
    series: dict[str, Array] = {
        "horizontal": errors.horizontal,
        "spatial": np.linalg.norm(errors.position, axis=1),
        **{f"position_{axis}": errors.position[:, k] for k, axis in enumerate(NED)},
        **{f"velocity_{axis}": errors.velocity[:, k] for k, axis in enumerate(NED)},
        **{f"attitude_{axis}": errors.attitude[:, k] / DEG for k, axis in enumerate(ANGLES)},
    }
    for name, values in series.items():
        found[f"{name}_rmse"], found[f"{name}_max"] = rms(values), _largest(values)
    return found


def _largest(values: Array) -> float:
    x = np.abs(values[np.isfinite(values)])
    return float(x.max()) if len(x) else math.nan
