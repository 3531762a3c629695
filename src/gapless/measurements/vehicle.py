"""What every car obeys, and what its wheels say: no slip sideways or upwards, wheel speed.

The car's forward axis sits in the box at pitch theta and yaw psi (the mounting angles, states
where that block is on); the point that does not slip sideways lies `axle` metres forward of the box.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gapless import earth
from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows
from gapless.inertial.propagate import PREV_DT, PREV_THETA, PREV_VEL
from gapless.trip.recording import Array

LEAST = 0.05
"""What is left of the lateral standard deviation at a crawl [m/s]."""
CRAWL = 0.5
"""An odometer's offset is there once wheels roll: half of it in v^2 at this reading [m/s], none at rest."""
MOUNTING, AXLE, SCALE, OFFSET = 4, 5, 6, 7
"""Where `Layout.offsets` keeps the four blocks."""


@inline
def axes(theta: float, psi: float) -> Array:
    """Rows: the car's forward, right and down axes in the box.

    Parameters
    ----------
    theta, psi : float
        Mounting pitch and yaw [rad].

    Returns
    -------
    ndarray, shape (3, 3)
    """
    ct, st, cp, sp = np.cos(theta), np.sin(theta), np.cos(psi), np.sin(psi)
    return np.array([[ct * cp, ct * sp, -st], [-sp, cp, 0.0], [st * cp, st * sp, ct]])


@inline
def _geometry(x: Any, offsets: Any, mounting: Any, axle: Any) -> Any:
    """C_nb, the car's axes in the box, velocity in the box, the axle's coordinate."""
    c = np.array(matrix_rows((x[6], x[7], x[8], x[9]))).reshape(3, 3)
    m, a = offsets[MOUNTING], offsets[AXLE]
    theta, psi = (x[m + 1], x[m + 2]) if m >= 0 else (mounting[0], mounting[1])
    arm = x[a + 1] if a >= 0 else axle
    v_b = np.empty(3)
    for i in range(3):
        v_b[i] = c[0, i] * x[3] + c[1, i] * x[4] + c[2, i] * x[5]
    return c, axes(theta, psi), v_b, theta, arm


@inline
def _component(x: Any, c: Any, e: Any, h: Any) -> None:
    """Row of H of e' C_bn v: C e on velocity, (C e) x v on attitude."""
    u0 = c[0, 0] * e[0] + c[0, 1] * e[1] + c[0, 2] * e[2]
    u1 = c[1, 0] * e[0] + c[1, 1] * e[1] + c[1, 2] * e[2]
    u2 = c[2, 0] * e[0] + c[2, 1] * e[1] + c[2, 2] * e[2]
    h[3], h[4], h[5] = u0, u1, u2
    h[6], h[7], h[8] = u1 * x[5] - u2 * x[4], u2 * x[3] - u0 * x[5], u0 * x[4] - u1 * x[3]


@inline
def _dot(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def slip(
    x: Array,
    offsets: NDArray[np.int64],
    n: int,
    mounting: Array,
    axle: float,
    rate: Array,
    lateral: float,
    vertical: float,
    turn: float,
) -> tuple[float, Array, Array, Array]:
    """No slip at the axle: sideways and vertical velocity of the car are zero.

    Parameters
    ----------
    x, offsets, n
        Nominal state, `Layout.offsets`, number of error states.
    mounting : ndarray, shape (2,)
        Pitch and yaw [rad], used where they are not states.
    axle : float
        Forward coordinate of the point without slip [m], used where it is not a state.
    rate : ndarray, shape (3,)
        Corrected body rate [rad/s].
    lateral, vertical : float
        Standard deviations on a straight [m/s]; the lateral one shrinks below walking pace, where
        a car cannot slip by more than it moves.
    turn : float
        Further lateral standard deviation per lateral acceleration [s]; a third of it vertically.

    Returns
    -------
    forward : float
        Speed along the car's forward axis [m/s].
    z : ndarray, shape (2,)
        Right, down [m/s].
    H : ndarray, shape (2, n)
    R : ndarray, shape (2, 2)
        Sukkarieh, Nebot & Durrant-Whyte (1999), with the mounting angles of Rothman, Klein &
        Filin (2014).
    """
    c, e, v_b, theta, arm = _geometry(x, offsets, mounting, axle)
    forward = _dot(e[0], v_b)
    yaw_rate, pitch_rate = _dot(e[2], rate), _dot(e[1], rate)
    z, h, r = np.empty(2), np.zeros((2, n)), np.zeros((2, 2))
    z[0] = -(_dot(e[1], v_b) + arm * yaw_rate)
    z[1] = -(_dot(e[2], v_b) - arm * pitch_rate)
    _component(x, c, e[1], h[0])
    _component(x, c, e[2], h[1])
    for i in range(3):
        h[0, 9 + i] = -arm * e[2, i]
        h[1, 9 + i] = arm * e[1, i]
    m, a = offsets[MOUNTING], offsets[AXLE]
    if m >= 0:
        level = np.cos(theta) * forward + np.sin(theta) * _dot(e[2], v_b)
        side = np.sin(theta) * _dot(e[1], v_b)
        h[0, m] = arm * _dot(e[0], rate)
        h[0, m + 1] = -level + arm * np.sin(theta) * pitch_rate
        h[1, m] = forward
        h[1, m + 1] = side + arm * (np.cos(theta) * _dot(e[0], rate) + np.sin(theta) * yaw_rate)
    if a >= 0:
        h[0, a], h[1, a] = yaw_rate, -pitch_rate
    swing = turn * yaw_rate * forward
    r[0, 0] = lateral * lateral * abs(forward) / (abs(forward) + 1.0) + LEAST * LEAST + swing * swing
    r[1, 1] = vertical * vertical + swing * swing / 9.0
    return forward, z, h, r


@kernel
def odometer(
    x: Array,
    offsets: NDArray[np.int64],
    n: int,
    mounting: Array,
    memory: Array,
    jitter: float,
    side: float,
    speed: float,
    sd: float,
) -> tuple[Array, Array, Array]:
    """Wheel speed with a scale error and an offset: z = reading (1 + s) + o - forward speed.

    Counters that drop the rest of a pulse, and filters that average, read too little by the same at any
    speed; a scale alone takes that for a share, and is wrong wherever the speed is another.

    Parameters
    ----------
    x, offsets, n, mounting
        As for `slip`.
    memory : ndarray
        What the last sample left behind: specific force.
    jitter : float
        Standard deviation of the time stamp [s]: while the car accelerates, late is wrong.
    side : float
        Standard deviation of how far the wheel is aside of the box [m]: in a turn it is faster or slower.
    speed, sd : float
        Reading and its standard deviation [m/s].

    Returns
    -------
    z : ndarray, shape (1,)
    H : ndarray, shape (1, n)
    R : ndarray, shape (1, 1)
    """
    c, e, v_b, theta, _ = _geometry(x, offsets, mounting, 0.0)
    k, o, m = offsets[SCALE], offsets[OFFSET], offsets[MOUNTING]
    z, h, r = np.empty(1), np.zeros((1, n)), np.zeros((1, 1))
    rolls = speed * speed / (speed * speed + CRAWL * CRAWL)
    scale, offset = x[k + 1] if k >= 0 else 0.0, x[o + 1] if o >= 0 else 0.0
    z[0] = speed * (1.0 + scale) + rolls * offset - _dot(e[0], v_b)
    _component(x, c, e[0], h[0])
    if m >= 0:
        h[0, m] = -_dot(e[2], v_b)
        h[0, m + 1] = np.cos(theta) * _dot(e[1], v_b)
    if k >= 0:
        h[0, k] = -speed
    if o >= 0:
        h[0, o] = -rolls
    accel = yaw_rate = 0.0
    if memory[PREV_DT] > 0.0:
        g = earth.gravity(np.sin(x[0]), x[2])
        for i in range(3):
            accel += e[0, i] * (memory[PREV_VEL + i] / memory[PREV_DT] + g * c[2, i])
            yaw_rate += e[2, i] * memory[PREV_THETA + i] / memory[PREV_DT]
    r[0, 0] = sd * sd + (accel * jitter) ** 2 + (yaw_rate * side) ** 2
    return z, h, r
