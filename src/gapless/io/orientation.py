"""Do the logged axes point where they are said to, and in their unit? Gravity, accelerations and turns tell.

The mean of the specific force points up. What GNSS says of the car's accelerations, forward and to the
right, is what the accelerometers feel in the plane below; the angle between the two is the box's. Turns of
the course are felt about the vertical alone. An axis that is taken for another one is 90 degrees off, or 180;
boxes that sit askew are not meant, the filter finds their angles.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.io.axes import nearest_axes
from gapless.io.log import Log
from gapless.trip.motion import Sums
from gapless.trip.recording import Array, Gnss, Imu
from gapless.trip.steering import Steered, rightward, steered
from gapless.units import DEG

_SPAN: Final = 4.0
"""Seconds over which accelerations are compared: long against the offset of a clock."""
_ENOUGH: Final = 60
"""Epochs, a second apart, below which nothing is concluded."""
_COHERENT: Final = 0.6
"""What is felt and what GNSS says must agree as well as this at some angle, or nothing is concluded."""
_TURNING: Final = 0.8
"""The same for rates of turn."""
_LEAST: Final = 0.6
"""What gyros feel, in units of what the course turns; more than its inverse is wrong too."""
_FAR: Final = 60.0 * DEG
"""An axis so far off is another one: half the way between two is 45 degrees."""


class Felt(NamedTuple):
    """Motion as two sensors tell it, row by row.

    Parameters
    ----------
    force : ndarray, shape (n, 3)
        Mean specific force [m/s^2], box axes.
    rate : ndarray, shape (n, 3)
        Mean angular rate [rad/s], box axes.
    acceleration : ndarray, shape (n, 2)
        Forward and to the right, by GNSS [m/s^2].
    turn : ndarray, shape (n,)
        Rate of the course, by GNSS [rad/s].
    """

    force: Array
    rate: Array
    acceleration: Array
    turn: Array


def check_orientation(log: Log, imu: Imu, gnss: Gnss, axes: Array | None) -> None:
    """Refuse a log whose axes point elsewhere than is said, or whose gyros turn about another axis.

    Parameters
    ----------
    log : Log
        Of the IMU, for the error.
    imu : Imu
        Its samples, along the axes that are said to be forward, right and down.
    gnss : Gnss
    axes : ndarray, shape (3, 3), optional
        Logged axes to forward-right-down, as is said; the same if not given.

    Raises
    ------
    RecordingError
        If gravity, accelerations or turns say otherwise, and clearly.
    """
    told = felt(imu, gnss)
    if len(told.turn) < _ENOUGH:
        return
    vehicle, coherence = vehicle_axes(told)
    turning = turning_axis(told)
    if turning.correlation > _TURNING:
        _check_gyros(log, turning, vehicle[2], imu.rate)
    if coherence > _COHERENT and _angle(0.5 * (float(np.trace(vehicle)) - 1.0)) > _FAR:
        given = "dtheta_x" in log
        said = np.eye(3) if axes is None or given else axes
        found = nearest_axes(vehicle @ said)
        cure = "turn them to forward-right-down" if given else f'say so with imu_axes = "{found}"'
        log.refuse(
            f"x, y and z do not point {nearest_axes(said)}: by gravity and accelerations they point {found}",
            cure,
        )


def _check_gyros(log: Log, turning: Turning, down: Array, samples: float) -> None:
    """Whether turns are felt about the vertical, and are as large as those of the course."""
    apart = _angle(float(turning.axis @ down))
    if apart > _FAR:
        log.refuse(
            f"turns are felt {apart / DEG:.0f} degrees off the vertical that the accelerometers feel",
            "columns of gyros or accelerometers are exchanged, or have the wrong sign: check both",
        )
    if not _LEAST < turning.factor < 1.0 / _LEAST:
        cure = "check the unit, rad/s"
        if abs(turning.factor * samples - 1.0) < 0.2:
            cure = f"they look like increments: multiply the gyro columns by {samples:.0f}"
        log.refuse(f"the gyros turn {turning.factor:.3g} times as far as the course of the fixes", cure)


def _angle(cosine: float) -> float:
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def felt(imu: Imu, gnss: Gnss) -> Felt:
    """Motion around each second in which the car drove.

    Parameters
    ----------
    imu : Imu
    gnss : Gnss

    Returns
    -------
    Felt
    """
    drove = steered(gnss, 0.5 * _SPAN)
    inside = (drove.time - _SPAN > imu.time[0]) & (drove.time + _SPAN < imu.time[-1])
    drove = Steered(*(column[inside] for column in drove))
    forward, faster = drove.now / np.hypot(*drove.now.T)[:, None], (drove.after - drove.before) / _SPAN
    return Felt(
        Sums.of(imu, imu.dvel).around(drove.time, 0.5 * _SPAN) / _SPAN,
        Sums.of(imu, imu.dtheta).around(drove.time, 0.5 * _SPAN) / _SPAN,
        np.column_stack([(forward * faster).sum(axis=1), rightward(forward, faster)]),
        drove.turned / _SPAN,
    )


def vehicle_axes(told: Felt) -> tuple[Array, float]:
    """The car's axes in the box, and how well what is felt agrees with GNSS there.

    Parameters
    ----------
    told : Felt

    Returns
    -------
    axes : ndarray, shape (3, 3)
        A rotation: rows are forward, right and down along the box's axes.
    coherence : float
        1 where accelerations agree entirely.
    """
    down = -told.force.mean(axis=0)
    down = down / max(float(np.linalg.norm(down)), 1e-9)
    e1 = np.cross(np.eye(3)[int(np.argmin(np.abs(down)))], down)
    e1 /= np.linalg.norm(e1)
    e2 = np.cross(down, e1)
    seen = told.force @ e1 + 1j * (told.force @ e2)
    said = told.acceleration @ np.array([1.0, 1j])
    seen, said = seen - seen.mean(), said - said.mean()
    agreed = np.vdot(said, seen)
    size = float(np.linalg.norm(said) * np.linalg.norm(seen))
    psi = float(np.angle(agreed))
    forward = np.cos(psi) * e1 + np.sin(psi) * e2
    return np.array([forward, np.cross(down, forward), down]), float(abs(agreed)) / max(size, 1e-9)


class Turning(NamedTuple):
    """Turns as the gyros feel them.

    Parameters
    ----------
    axis : ndarray, shape (3,)
        The box's axis that turns to the right go about, of length one.
    correlation : float
        With the course's.
    factor : float
        What the gyros feel, in units of what the course turns.
    """

    axis: Array
    correlation: float
    factor: float


def turning_axis(told: Felt) -> Turning:
    """The axis that turns go about, and how well they agree with the course.

    Parameters
    ----------
    told : Felt

    Returns
    -------
    Turning
    """
    rate, turn = told.rate - told.rate.mean(axis=0), told.turn - told.turn.mean()
    axis = turn @ rate
    axis = axis / max(float(np.linalg.norm(axis)), 1e-12)
    about = rate @ axis
    agreed, size = float(about @ turn), float(np.linalg.norm(about))
    correlation = agreed / max(size * float(np.linalg.norm(turn)), 1e-12)
    return Turning(axis, correlation, size**2 / max(agreed, 1e-12))  # errors are the course's
