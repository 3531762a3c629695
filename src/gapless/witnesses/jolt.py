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


PEAK, LENGTH, STEADILY, FILLED, RING = 0, 1, 2, 3, 4
"""Where in the memory of `lean` there are: the lean a tick ago [rad], how long a force is in steady driving
[m/s^2], ticks that told it, ticks since the last change of attitude, and their forces."""


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
def lean(m: Array, c_nb: Array, force: Array, tilt: float) -> tuple[bool, float]:
    """Take in a tick: whether the mean force leans as it does in a box that was turned, and how far.

    Parameters
    ----------
    m : ndarray, shape (RING + 3 * WINDOW,)
        Changed in place.
    c_nb : ndarray, shape (3, 3)
    force : ndarray, shape (3,)
        Mean specific force in the box [m/s^2].
    tilt : float
        How far the filter may be wrong about the vertical [rad].

    Returns
    -------
    turned : bool
    angle : float
        [rad]
    """
    slot = RING + 3 * (int(m[FILLED]) % WINDOW)
    m[FILLED] += 1.0
    for i in range(3):
        m[slot + i] = c_nb[i, 0] * force[0] + c_nb[i, 1] * force[1] + c_nb[i, 2] * force[2]
    if m[FILLED] < WINDOW:
        return False, 0.0
    mean = np.zeros(3)
    for k in range(WINDOW):
        for i in range(3):
            mean[i] += m[RING + 3 * k + i] / WINDOW
    length = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    if not np.isfinite(length + tilt):
        return False, 0.0
    angle = np.arccos(min(1.0, max(-1.0, -mean[2] / max(length, 1e-9))))
    growing = angle > m[PEAK]
    m[PEAK] = angle
    if angle < STEADY:
        m[STEADILY] += 1.0
        m[LENGTH] += max(SLOWLY, 1.0 / m[STEADILY]) * (length - m[LENGTH])
    leans = angle >= ANGLE + 3.0 * tilt
    if not leans or growing or m[STEADILY] < KNOWN:  # all of the window must have come after it
        return False, angle
    return length - m[LENGTH] <= LONGER * m[LENGTH] * (1.0 / max(np.cos(angle), 0.2) - 1.0), angle


@dataclass
class Jolts:
    """The last second's forces, and how long a force is in steady driving.

    Parameters
    ----------
    memory : ndarray, shape (RING + 3 * WINDOW,)
        As `lean` keeps it.
    """

    memory: Array = field(default_factory=lambda: np.zeros(RING + 3 * WINDOW))

    def feel(self, force: Array, c_nb: Array, tilt: float, tick: float) -> Jolt | None:
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

        Returns
        -------
        Jolt or None
        """
        turned, angle = lean(self.memory, c_nb, force, tilt)
        if not turned:
            return None
        felt = c_nb.T @ self.memory[RING:].reshape(WINDOW, 3).mean(axis=0)
        self.forget()
        turn = between(felt, -c_nb[2])
        return Jolt(turn, WINDOW * tick, felt - turn @ felt, angle)

    @property
    def lean(self) -> float:
        """How far the mean force leans from the vertical [rad]; pi while there is too little of it."""
        return float(self.memory[PEAK]) if self.memory[FILLED] >= WINDOW else np.pi

    def forget(self) -> None:
        """The attitude changed: forces of before lean by another one."""
        self.memory[FILLED] = self.memory[PEAK] = 0.0

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
