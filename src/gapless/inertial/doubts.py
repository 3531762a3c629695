"""What a belief is made to doubt where something in it turns out to be wrong."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless import attitude
from gapless.attitude import product
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief, inject
from gapless.inertial.layout import ROW
from gapless.trip.recording import Array
from gapless.units import DEG

GRAVITY: Final = 9.8
"""For what a tilt does [m/s^2]."""
SECONDS: Final = 5.0
"""In which a tilt shows in the velocity."""


def doubt(b: Belief, off: float, ceiling: Array) -> None:
    """Doubt what a bridge that misled the filter taught it: attitude and the biases of the sensors.

    Parameters
    ----------
    b : Belief
        Changed in place.
    off : float
        By how much the velocity turned out to be wrong [m/s]; a tilt does that in some seconds.
    ceiling : ndarray, shape (n,)
        Variance of each state when nothing is known of it; biases come back to a tenth of it.
    """
    p, blocks = b.p.reshape(ROW, ROW), b.layout.blocks
    tilt = min(off / (SECONDS * GRAVITY), 0.3)
    heading = min(off / max(float(np.hypot(*b.v_n[:2])), 5.0), 1.0)
    p[(6, 7, 8), (6, 7, 8)] += np.square([tilt, tilt, heading])
    for name in ("gyro_bias", "accel_bias"):
        index = np.arange(blocks[name].start, blocks[name].stop)
        p[index, index] += 0.1 * ceiling[index]


def turn(b: Belief, angle: float) -> None:
    """Turn the heading by what accelerations show; how far that is off, and why, is not known.

    Parameters
    ----------
    b : Belief
        Changed in place.
    angle : float
        Clockwise [rad].
    """
    half = 0.5 * angle
    b.x[6:10] = product((np.cos(half), 0.0, 0.0, np.sin(half)), tuple(b.x[6:10]))
    p = b.p.reshape(ROW, ROW)
    p[8, 8] += np.square(0.3 * angle) + np.square(10.0 * DEG)
    down = b.C_nb[2]
    p[(9, 10, 11), (9, 10, 11)] += np.square(down * min(abs(angle) / SECONDS, 3.0 * DEG))
    if "mounting" in b.layout:
        yaw = b.layout.blocks["mounting"].start + 1
        p[yaw, yaw] += angle * angle


def drift(b: Belief, rate: Array) -> None:
    """Doubt the gyros' zeros by what they say at rest, and the heading by what that made of it.

    Parameters
    ----------
    b : Belief
        Changed in place.
    rate : ndarray, shape (3,)
        [rad/s]
    """
    p = b.p.reshape(ROW, ROW)
    p[(9, 10, 11), (9, 10, 11)] += np.square(rate)
    p[8, 8] += np.square(SECONDS * float(np.linalg.norm(rate)))


def remount(b: Belief, slip: Array) -> float:
    """Doubt how the box sits in the car, for the car seems to slip.

    Or a gyro's zero has leapt, and the heading with it: then the slip grows, and a mounting that alone
    was in doubt would follow it.

    Parameters
    ----------
    b : Belief
        Changed in place.
    slip : ndarray, shape (2,)
        Innovation of the constraint: right, down [m/s].

    Returns
    -------
    float
        By how much the box would have to be turned [rad].
    """
    if "mounting" not in b.layout:
        return 0.0
    turn = slip / max(float(np.hypot(*b.v_n[:2])), 2.0)
    p, first = b.p.reshape(ROW, ROW), b.layout.blocks["mounting"].start
    p[first, first] += turn[1] ** 2
    p[first + 1, first + 1] += turn[0] ** 2
    p[8, 8] += turn[0] ** 2
    p[(9, 10, 11), (9, 10, 11)] += np.square(b.C_nb[2] * turn[0] / SECONDS)
    return float(np.hypot(*turn))


def tipped(b: Belief, off: float, since: float) -> None:
    """Doubt the vertical in the box, and all that came of it: a force that was none was integrated.

    Parameters
    ----------
    b : Belief
        Changed in place.
    off : float
        What it made of the velocity [m/s].
    since : float
        In so many seconds.
    """
    n, p, size = b.layout.n, b.P, off / since
    for axis, (tilted, by) in enumerate(((7, -1.0), (6, 1.0), (8, 0.0))):
        u = np.zeros(n)  # psi x f for an attitude that is off by psi
        u[axis], u[3 + axis], u[tilted] = 0.5 * since**2, since, by / GRAVITY
        p += np.outer(u, u) * np.square(size if by else 0.3 * size)
    if "mounting" in b.layout:
        pitch = b.layout.blocks["mounting"].start
        p[pitch, pitch] += np.square(size / GRAVITY)


def knocked(b: Belief, turn: Array, since: float, gained: Array, ceiling: Array) -> None:
    """Go on after the box was turned: in its former axes, in doubt of how well these are known.

    Parameters
    ----------
    b : Belief
        Changed in place.
    turn : ndarray, shape (3, 3)
        Takes what is felt now to the axes of before.
    since : float
        For so long it has been taken for what it was not [s].
    gained : ndarray, shape (3,)
        Force too much that was integrated meanwhile, in the axes of before [m/s^2].
    ceiling : ndarray, shape (n,)
        Variance of each state when nothing is known of it; biases come back to a quarter of it.
    """
    wrong = b.C_nb @ gained
    off, moved = wrong * since, 0.5 * wrong * since * since
    step = np.zeros(b.layout.n)
    step[:3], step[3:6] = -moved, -off
    inject(b.x, step)
    for at_ in (at.PREV_THETA, at.PREV_VEL):
        b.memory[at_ : at_ + 3] = turn @ b.memory[at_ : at_ + 3]
    p, blocks = b.p.reshape(ROW, ROW), b.layout.blocks
    p[(0, 1, 2), (0, 1, 2)] += np.square(0.3 * float(np.linalg.norm(moved)) + 0.3)
    p[(3, 4, 5), (3, 4, 5)] += np.square(0.2 * float(np.linalg.norm(off)) + 0.2)
    p[(6, 7, 8), (6, 7, 8)] += np.square(np.array([4.0, 4.0, 15.0]) * DEG)
    for name, share in (("gyro_bias", 0.25), ("accel_bias", 0.25), ("mounting", 0.1)):
        if name in blocks:
            index = np.arange(blocks[name].start, blocks[name].stop)
            p[index, index] += share * ceiling[index]


def reseated(b: Belief, turn: Array, ceiling: Array) -> None:
    """Go on in the former axes of a box whose attitude was known all the time, not so how it sits.

    Parameters
    ----------
    b : Belief
        Changed in place.
    turn : ndarray, shape (3, 3)
        Takes what is felt now to the axes of before.
    ceiling : ndarray, shape (n,)
        Variance of each state when nothing is known of it; what is in the box comes back to a share.
    """
    b.x[6:10] = attitude.from_matrix(b.C_nb @ turn.T)
    for at_ in (at.PREV_THETA, at.PREV_VEL):
        b.memory[at_ : at_ + 3] = turn @ b.memory[at_ : at_ + 3]
    p, blocks, turned = b.P, b.layout.blocks, np.eye(b.layout.n)
    for name in ("gyro_bias", "accel_bias"):  # these turn with the box
        turned[blocks[name], blocks[name]] = turn
        b.block(name)[:] = turn @ b.block(name)
    p[:] = turned @ p @ turned.T
    for name, share in (("gyro_bias", 0.05), ("accel_bias", 0.05), ("mounting", 0.3)):
        if name in blocks:
            index = np.arange(blocks[name].start, blocks[name].stop)
            p[index, index] += share * ceiling[index]
