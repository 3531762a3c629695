"""How the mean speed over the last seconds hangs on the present errors.

A window's spectrum tells the speed of its middle. What was gained since is inertial, and as wrong as the tilt
and the biases are with which it was reckoned: half a degree is 0.17 m/s in two seconds. To take the mean for
the present speed calls that an error of the reading, and learns nothing of the tilt.
"""

from __future__ import annotations

import numpy as np

from gapless.attitude import to_matrix
from gapless.inertial.belief import Belief
from gapless.inertial.trail import GRAVITY
from gapless.recording import Array


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
    x, layout = belief.estimate(), belief.layout
    times, gained = belief.trail.behind(window)
    inside = times >= times[-1] - window
    ago, lag = times[-1] - times[inside], -gained[inside]
    v = x[3:6] - lag
    along = v / np.maximum(np.linalg.norm(v, axis=1), 0.1)[:, None]
    force = lag - np.outer(ago, [0.0, 0.0, GRAVITY])
    h = np.zeros((1, layout.n))
    h[0, 3:6] = along.mean(axis=0)
    h[0, 6:9] = np.cross(along, force).mean(axis=0)
    h[0, layout.blocks["accel_bias"]] = (along * ago[:, None]).mean(axis=0) @ to_matrix(x[6:10])
    return h
