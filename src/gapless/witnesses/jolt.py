"""A box that is knocked over: gravity points elsewhere in it, and no gyro told of the way.

A car that brakes or turns feels a force that leans *and* is longer; a box that was turned feels the same
force from another side. So the angle between the mean force of a second and the vertical as the filter
has it, beside how long the force is against that of steady driving, tells the two apart.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple, Self

import numpy as np

from gapless._numba import kernel
from gapless.attitude import matrix
from gapless.inertial.propagate import QUAT
from gapless.trip.recording import Array
from gapless.units import DEG

WINDOW: Final = 10
"""Ticks over which forces are averaged."""
ANGLE: Final = 18.0 * DEG
"""Less than this a bump beside a brake may feign [rad]."""
LONGER: Final = 0.4
"""Share of a brake's lengthening of the force that a box that was turned may show."""
STEADY: Final = 4.0 * DEG
"""While the force leans less, the car is taken for steady, and its length is learned [rad]."""
SLOWLY: Final = 0.01
"""Share of a tick in that."""
KNOWN: Final = 100
"""Ticks of steady driving after which a length is known."""


class Jolt(NamedTuple):
    """How a box was turned.

    Parameters
    ----------
    turn : ndarray, shape (3, 3)
        Takes what sensors feel now to the axes of the box as it sat before.
    since : float
        For so long it has sat otherwise [s].
    gained : ndarray, shape (3,)
        Force that was felt meanwhile less what it would have been, in the axes of before [m/s^2].
    angle : float
        [rad]
    """

    turn: Array
    since: float
    gained: Array
    angle: float


LONG: Final = 40
"""Ticks of the longer window, in which less is enough."""
LITTLE: Final = 11.0 * DEG
"""That: so much of a lean for four seconds, and a box was turned if the force is no longer [rad]."""
PEAK, CREST, LENGTH, SLOPE, STEADILY, FILLED, RING = 0, 1, 2, 3, 4, 5, 6
"""Where in the memory of `lean` there are: leans of both windows a tick ago [rad], how long a force is in
steady driving [m/s^2], the slope then, ticks that told it, ticks since the last change of attitude, and
their forces."""
STANDS: Final = np.zeros(3)


@kernel
def upright(p: Array, row: int, x: Array, rate: Array, force: Array) -> tuple[float, Array, Array]:
    """What of a force is not the car's turning: a corner leans on the box, no blow does.

    Parameters
    ----------
    p : ndarray, shape (row * row,)
        Covariance.
    row : int
    x : ndarray
        Nominal state.
    rate, force : ndarray, shape (3,)
        Mean of a tick [rad/s], [m/s^2].

    Returns
    -------
    tilt : float
        Standard deviation of the vertical [rad].
    c : ndarray, shape (3, 3)
        C_nb.
    force : ndarray, shape (3,)
        f - w x v in the box [m/s^2].
    """
    c, left, v = matrix(x[QUAT : QUAT + 4]), np.empty(3), np.zeros(3)
    for i in range(3):
        for j in range(3):
            v[i] += c[j, i] * x[3 + j]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        left[i] = force[i] - (rate[j] * v[k] - rate[k] * v[j])
    return np.sqrt(max(0.5 * (p[6 * row + 6] + p[7 * row + 7]), 0.0)), c, left


@kernel
def mean_of(m: Array, ticks: int) -> tuple[float, Array]:
    """Mean force of the last ticks, and how far it leans from the vertical.

    Parameters
    ----------
    m : ndarray, shape (RING + 3 * LONG,)
    ticks : int

    Returns
    -------
    angle : float
        [rad]
    mean : ndarray, shape (3,)
        North, east, down [m/s^2].
    """
    mean = np.zeros(3)
    for k in range(ticks):
        slot = RING + 3 * ((int(m[FILLED]) - 1 - k) % LONG)
        for i in range(3):
            mean[i] += m[slot + i] / ticks
    length = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    return np.arccos(min(1.0, max(-1.0, -mean[2] / max(length, 1e-9)))), mean


@kernel
def lean(m: Array, c_nb: Array, force: Array, tilt: float, v_n: Array) -> tuple[int, float]:
    """Take in a tick: whether the mean force leans as it does in a box that was turned, and how far.

    Parameters
    ----------
    m : ndarray, shape (RING + 3 * LONG,)
        Changed in place.
    c_nb : ndarray, shape (3, 3)
    force : ndarray, shape (3,)
        Mean specific force in the box [m/s^2].
    tilt : float
        How far the filter may be wrong about the vertical [rad].
    v_n : ndarray, shape (3,)
        [m/s]

    Returns
    -------
    ticks : int
        For how many it has leant so; 0 where it does not.
    angle : float
        [rad]
    """
    slot = RING + 3 * (int(m[FILLED]) % LONG)
    m[FILLED] += 1.0
    for i in range(3):
        m[slot + i] = c_nb[i, 0] * force[0] + c_nb[i, 1] * force[1] + c_nb[i, 2] * force[2]
    if m[FILLED] < WINDOW:
        return 0, 0.0
    angle, mean = mean_of(m, WINDOW)
    length = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    if not np.isfinite(length + tilt):
        return 0, 0.0
    growing = angle > m[PEAK]
    m[PEAK] = angle
    along = np.hypot(v_n[0], v_n[1])
    if angle < STEADY:
        m[STEADILY] += 1.0
        m[LENGTH] += max(SLOWLY, 1.0 / m[STEADILY]) * (length - m[LENGTH])
        if along > 2.0:
            m[SLOPE] += 5.0 * SLOWLY * (v_n[2] / along - m[SLOPE])
    if m[STEADILY] < KNOWN:
        return 0, angle
    # all of a window must have come after it
    if angle >= ANGLE + 3.0 * tilt and not growing:
        longer = length - m[LENGTH]
        return (WINDOW if longer <= LONGER * m[LENGTH] * (1.0 / max(np.cos(angle), 0.2) - 1.0) else 0), angle
    if m[FILLED] < LONG:
        return 0, angle
    angle, mean = mean_of(m, LONG)
    growing = angle > m[CREST]
    m[CREST] = angle
    if angle < LITTLE + 3.0 * tilt or growing:
        return 0, angle
    faster = (mean[0] * v_n[0] + mean[1] * v_n[1]) / max(along, 1.0)  # down a hill, that is downwards too
    up = faster * m[SLOPE] - mean[2]
    return (LONG if up < m[LENGTH] * (1.0 - (1.0 - LONGER) * (1.0 - np.cos(angle))) else 0), angle


@dataclass
class Jolts:
    """The last second's forces, and how long a force is in steady driving.

    Parameters
    ----------
    memory : ndarray, shape (RING + 3 * LONG,)
        As `lean` keeps it.
    """

    memory: Array = field(default_factory=lambda: np.zeros(RING + 3 * LONG))

    def feel(self, force: Array, c_nb: Array, tilt: float, tick: float, v_n: Array = STANDS) -> Jolt | None:
        """Take in a tick.

        Parameters
        ----------
        force : ndarray, shape (3,)
            Mean specific force in the box [m/s^2].
        c_nb : ndarray, shape (3, 3)
            Attitude, as the filter has it.
        tilt : float
            How far it may be wrong about the vertical [rad].
        tick : float
            Its length [s].
        v_n : ndarray, shape (3,)
            Velocity [m/s].

        Returns
        -------
        Jolt or None
        """
        ticks, angle = lean(self.memory, c_nb, force, tilt, v_n)
        if not ticks:
            return None
        felt = c_nb.T @ mean_of(self.memory, ticks)[1]
        self.forget()
        turn = between(felt, -c_nb[2])
        return Jolt(turn, ticks * tick, felt - turn @ felt, angle)

    @property
    def lean(self) -> float:
        """How far the mean force leans from the vertical [rad]; pi while there is too little of it."""
        return float(self.memory[PEAK]) if self.memory[FILLED] >= WINDOW else np.pi

    def forget(self) -> None:
        """The attitude changed: forces of before lean by another one."""
        self.memory[FILLED] = self.memory[PEAK] = self.memory[CREST] = 0.0

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.memory.copy())


def between(a: Array, b: Array) -> Array:
    """The smallest rotation that takes one direction to another.

    Parameters
    ----------
    a, b : ndarray, shape (3,)

    Returns
    -------
    ndarray, shape (3, 3)
        Rodrigues' formula about a x b; half a turn about any level axis where they are opposite.
    """
    u, w = a / np.linalg.norm(a), b / np.linalg.norm(b)
    axis, c = np.cross(u, w), float(u @ w)
    if c < -0.999999:
        side = np.array([1.0, 0.0, 0.0]) if abs(u[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
        axis = np.cross(u, side)
        axis /= np.linalg.norm(axis)
        return np.asarray(2.0 * np.outer(axis, axis) - np.eye(3))
    k = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.asarray(np.eye(3) + k + k @ k / (1.0 + c))


def about(axis: Array, angle: float) -> Array:
    """The rotation about an axis.

    Parameters
    ----------
    axis : ndarray, shape (3,)
        Of unit length.
    angle : float
        [rad]

    Returns
    -------
    ndarray, shape (3, 3)
    """
    k = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k)
