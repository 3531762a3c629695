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


@kernel
def lean(ring: Array) -> tuple[float, float, Array]:
    """How far the mean force leans from the vertical, and how long it is.

    Parameters
    ----------
    ring : ndarray, shape (k, 3)
        Mean forces of ticks, north, east, down by the filter's attitude [m/s^2].

    Returns
    -------
    angle : float
        [rad]
    length : float
        [m/s^2]
    mean : ndarray, shape (3,)
    """
    mean = np.zeros(3)
    for i in range(ring.shape[0]):
        for j in range(3):
            mean[j] += ring[i, j] / ring.shape[0]
    length = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    return np.arccos(min(1.0, max(-1.0, -mean[2] / max(length, 1e-9)))), length, mean


@dataclass
class Jolts:
    """The last second's forces, and how long a force is in steady driving.

    Parameters
    ----------
    ring : ndarray, shape (k, 3)
        Replaced, never changed.
    peak : float
        The lean a tick ago [rad].
    length : float
        Of the force in steady driving [m/s^2].
    steady : int
        Ticks that told it.
    """

    ring: Array = field(default_factory=lambda: np.zeros((0, 3)))
    peak: float = 0.0
    length: float = 0.0
    steady: int = 0

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
        self.ring = np.concatenate([self.ring[-(WINDOW - 1) :], (c_nb @ force)[None, :]])
        if len(self.ring) < WINDOW:
            return None
        angle, length, mean = lean(self.ring)
        if not np.isfinite(length + tilt):
            return None
        growing, self.peak = angle > self.peak, angle
        if angle < STEADY:
            self.steady += 1
            self.length += max(SLOWLY, 1.0 / self.steady) * (length - self.length)
        leans = angle >= ANGLE + 3.0 * tilt
        if not leans or growing or self.steady < KNOWN:  # all of the window must have come after it
            return None
        if length - self.length > LONGER * self.length * (1.0 / max(float(np.cos(angle)), 0.2) - 1.0):
            return None
        self.forget()
        felt = c_nb.T @ mean
        turn = between(felt, -c_nb[2])
        return Jolt(turn, WINDOW * tick, felt - turn @ felt, angle)

    def forget(self) -> None:
        """The attitude changed: forces of before lean by another one."""
        self.ring, self.peak = self.ring[:0], 0.0

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.ring, self.peak, self.length, self.steady)


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
