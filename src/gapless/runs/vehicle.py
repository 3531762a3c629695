"""The attitude of the car instead of that of the box that is fixed to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gapless import attitude
from gapless.errors import ConfigError
from gapless.measurements.vehicle import axes
from gapless.trip.recording import Array
from gapless.trip.solution import Decision, Solution
from gapless.units import DEG


def vehicle_attitude(solution: Solution) -> Solution:
    """The same solution with the car's roll, pitch and heading.

    The box is turned back by its mounting pitch and yaw, as estimated at each row. How far it is
    rolled against the car cannot be seen in a car's motion and stays in the roll. The point is still
    the IMU.

    Parameters
    ----------
    solution : Solution
        With the states "mounting".

    Returns
    -------
    Solution
        Standard deviations of pitch and heading are those of box and mounting added as if they were
        independent, which is cautious: a heading that comes from the course errs against the
        mounting yaw, not with it.

    Raises
    ------
    ConfigError
        If the system estimated no mounting angles.
    """
    angles = solution.states.get("mounting")
    if angles is None:
        raise ConfigError(
            f"the system {solution.system!r} has no mounting angles to turn the box into the car with; "
            "keep nonholonomic among its constraints or mounting among its filter.states"
        )
    sd = solution.trajectory.sd.copy()
    sd[:, 7:9] = np.hypot(sd[:, 7:9], solution.states_sd["mounting"])
    turned = replace(solution.trajectory, euler=car_euler(solution.trajectory.euler, angles), sd=sd)
    return replace(solution, trajectory=turned, decisions=(*solution.decisions, _decision(angles)))


def car_euler(euler: Array, mounting: Array) -> Array:
    """Roll, pitch, heading of the car: C_nv = C_nb C_bv.

    Parameters
    ----------
    euler : ndarray, shape (n, 3)
        Roll, pitch, heading of the box [rad].
    mounting : ndarray, shape (n, 2)
        Pitch and yaw of the car's forward axis in the box [rad].

    Returns
    -------
    ndarray, shape (n, 3)
        [rad]
    """
    c_nb = attitude.to_matrix(attitude.from_euler(euler))
    c_vb = np.array([axes(float(pitch), float(yaw)) for pitch, yaw in mounting]).reshape(-1, 3, 3)
    return attitude.matrix_to_euler(c_nb @ np.swapaxes(c_vb, 1, 2))


def _decision(angles: Array) -> Decision:
    last = tuple(round(float(a) / DEG, 3) for a in angles[-1]) if len(angles) else (0.0, 0.0)
    return Decision(
        "attitude",
        "the car's",
        "",
        "user",
        f"the box turned back by its mounting pitch and yaw, {last[0]:g} and {last[1]:g} deg at the end",
    )
