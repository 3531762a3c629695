"""A shadow INS: it runs beside the filter and is never corrected, so its error can be seen and learned.

In a feedback filter the INS is put right at every fix; what an uncorrected one would have drifted, no
row shows. The shadow starts from the filter's belief, goes on with the biases of that moment, and
starts anew at an interval: never for a fibre-optic gyro (the paper), about as often as outages are long
for a cheap sensor, whose error else is beyond what any learner can follow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from gapless import attitude, earth
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief
from gapless.inertial.coast import STATE, coast
from gapless.trip.events import Motion
from gapless.trip.recording import Array


@dataclass
class Shadow:
    """An INS that runs on ticks.

    Parameters
    ----------
    interval : float
        Time between new starts [s]; inf for none but the first.
    """

    interval: float = math.inf
    began: float = math.nan
    starts: int = 0
    x: Array = field(default_factory=lambda: np.zeros(STATE))
    origin: Array = field(default_factory=lambda: np.zeros(3))
    biases: Array = field(default_factory=lambda: np.zeros(6))
    before: Array = field(default_factory=lambda: np.zeros(7))

    def restart(self, belief: Belief, time: float) -> None:
        """Start anew from the filter's belief.

        Parameters
        ----------
        belief : Belief
        time : float
            [s]
        """
        estimate = belief.estimate()
        self.x, self.origin = estimate[:STATE].copy(), estimate[:3].copy()
        self.biases = estimate[at.GYRO_BIAS : at.EXTRA].copy()
        self.before = np.zeros(7)
        self.began = time
        self.starts += 1

    @property
    def running(self) -> bool:
        """Whether it was ever started."""
        return not math.isnan(self.began)

    def due(self, time: float) -> bool:
        """Whether a new start is due.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        return not self.running or time - self.began >= self.interval - 1e-6

    def tick(self, belief: Belief, motion: Motion) -> None:
        """Carry on over a tick.

        Parameters
        ----------
        belief : Belief
            For the biases that the tick's motion was corrected for.
        motion : Motion
        """
        felt = motion.felt + belief.x[at.GYRO_BIAS : at.EXTRA] - self.biases
        self.x = coast(self.x, self.before, felt, motion.dt)
        self.before = np.concatenate([[motion.dt], felt])

    def now(self, belief: Belief) -> Array:
        """State at the belief's time, which may lie between ticks.

        Parameters
        ----------
        belief : Belief

        Returns
        -------
        ndarray, shape (10,)
        """
        m = belief.memory
        dt = float(m[at.TICK_DT])
        if dt <= 0.0:
            return self.x
        felt = m[at.TICK_W : at.TICK_W + 6] / dt + belief.x[at.GYRO_BIAS : at.EXTRA] - self.biases
        return coast(self.x, self.before, felt, dt)

    def displacement(self, x: Array) -> Array:
        """How far a state of the shadow is from where it started.

        Parameters
        ----------
        x : ndarray, shape (10,)

        Returns
        -------
        ndarray, shape (3,)
            NED [m].
        """
        return earth.lla_to_ned(x[:3], self.origin)

    def copy(self) -> Self:
        """An independent copy; arrays are replaced, never changed, so they are shared.

        Returns
        -------
        Shadow
        """
        return type(self)(
            self.interval, self.began, self.starts, self.x, self.origin, self.biases, self.before
        )


def difference(x: Array, reference: Array) -> Array:
    """Error of one navigation state against another.

    Parameters
    ----------
    x, reference : ndarray, shape (10,)

    Returns
    -------
    ndarray, shape (9,)
        Position north, east, down [m], velocity [m/s], attitude as a rotation vector in NED [rad]
        (C of `x` = exp(error x) C of `reference`).
    """
    r_m, r_n = earth.radii(math.sin(reference[0]))
    d = x - reference
    h = float(reference[2])
    position = [d[0] * (r_m + h), d[1] * (r_n + h) * math.cos(reference[0]), -d[2]]
    back = reference[6:10] * np.array([1.0, -1.0, -1.0, -1.0])
    turned = attitude.multiply(x[6:10], back)
    return np.concatenate([position, d[3:6], 2.0 * math.copysign(1.0, turned[0]) * turned[1:]])
