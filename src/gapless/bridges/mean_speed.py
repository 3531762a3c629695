"""How the mean speed over the last seconds hangs on the present errors.

A window's spectrum tells the speed of its middle. What was gained since is inertial, and as wrong as the tilt
and the biases are with which it was reckoned: half a degree is 0.17 m/s in two seconds. To take the mean for
the present speed calls that an error of the reading, and learns nothing of the tilt.
"""

from __future__ import annotations

import numpy as np

from gapless._numba import kernel
from gapless.attitude import matrix_rows
from gapless.inertial.belief import Belief
from gapless.inertial.trail import GRAVITY
from gapless.trip.recording import Array


def mean_speed(belief: Belief, window: float) -> Array:
    """Observation matrix of the mean length of the velocity over a window that ends now.

    v(t) = v - (integral of C (f - b) + g from t to now). With F(t) the part that force gained from t to now,
    errors dv, phi and db of velocity, attitude and accelerometer bias make
    dv(t) = dv + F(t) x phi + (now - t) C db, and the length of v(t) sees what is along it.

    Parameters
    ----------
    belief : Belief
        Its trail holds the window.
    window : float
        [s]

    Returns
    -------
    ndarray, shape (1, n)
    """
    x, h = belief.estimate(), np.zeros((1, belief.layout.n))
    times, gained = belief.trail.behind(window)
    bias = belief.layout.blocks["accel_bias"].start
    _fill(h[0], bias, x, times, gained, times[-1] - window)
    return h


@kernel
def _fill(h: Array, bias: int, x: Array, times: Array, gained: Array, begin: float) -> None:
    """Means over the times from `begin` on, put where the layout has them."""
    n = 0
    for i in range(times.size):
        n += times[i] >= begin
    c = matrix_rows((x[6], x[7], x[8], x[9]))
    unit, force = np.empty(3), np.empty(3)
    for i in range(times.size):
        if times[i] < begin:
            continue
        ago, square = times[-1] - times[i], 0.0
        for j in range(3):
            unit[j], force[j] = x[3 + j] + gained[i, j], -gained[i, j]
            square += unit[j] * unit[j]
        unit /= max(np.sqrt(square), 0.1)
        force[2] -= GRAVITY * ago
        for j in range(3):
            k, m = (j + 1) % 3, (j + 2) % 3
            h[3 + j] += unit[j] / n
            h[6 + j] += (unit[k] * force[m] - unit[m] * force[k]) / n
            h[bias + j] += ago * (unit[0] * c[j] + unit[1] * c[3 + j] + unit[2] * c[6 + j]) / n
