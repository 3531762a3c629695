"""Any sensor with cubature moments, by statistical linear regression."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gapless.inertial.belief import Belief, inject
from gapless.inertial.layout import ROW
from gapless.inertial.points import factor, linearised, scatter
from gapless.measurements.base import Observation, Sensor
from gapless.trip.events import Reading


@dataclass(frozen=True)
class Spread:
    """A sensor asked at cubature points of the belief.

    Parameters
    ----------
    sensor : Sensor
    """

    sensor: Sensor

    def observe(self, belief: Belief, reading: Reading) -> Observation:
        """Observation of a reading over the whole belief; see `Sensor.observe`."""
        return regress(belief, lambda point: self.sensor.observe(point, reading))


def regress(belief: Belief, observe: Callable[[Belief], Observation]) -> Observation:
    """What an observation is over a Gaussian belief instead of at its mean.

    With the points of Arasaratnam and Haykin (2009): H = P_xz' P^-1, z its mean, and R with what of P_zz
    is not linear, P_zz - H P H'. So S = P_zz + R and the gain P_xz S^-1 are those of the cubature filter,
    and whatever weighs, adapts or smooths an observation does so unchanged.

    Parameters
    ----------
    belief : Belief
        Corrected by feedback; not changed.
    observe : callable
        Observation at a belief, of which the innovation is used, and R and slow at the middle.

    Returns
    -------
    Observation
    """
    n, point, middle = belief.layout.n, belief.copy(), observe(belief)
    low = factor(belief.p, ROW, n)
    values = np.empty((2, n, middle.z.size))
    for i, step in enumerate((math.sqrt(n) * low).T):
        for side, dx in enumerate((step, -step)):
            point.x[:] = belief.x
            inject(point.x, dx)
            values[side, i] = observe(point).z
    half, level = 0.5 * (values[0] - values[1]), 0.5 * (values[0] + values[1])
    z, extra = scatter(level)
    return Observation(z, -linearised(half, low), middle.R + extra, middle.slow)
