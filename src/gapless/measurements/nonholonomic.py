"""The non-holonomic constraint of a car, at ticks, while it drives forward."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from gapless.inertial.belief import Belief
from gapless.measurements.base import Constraint, Observation
from gapless.measurements.vehicle import slip
from gapless.trip.events import Motion, Reading


@dataclass
class NonHolonomic(Constraint):
    """No slip sideways or upwards at the rear axle.

    Parameters
    ----------
    lateral, vertical : float
        Standard deviation of one update on a straight [m/s].
    turn : float
        Further standard deviation per lateral acceleration [s].
    min_speed : float
        Slower than this it says nothing: a standing car shows no direction [m/s].
    axle : float
        Forward coordinate of the rear axle from the box, where it is not a state [m].
    mounting : tuple of 2 float
        Pitch and yaw of the car's forward axis in the box, where they are not states [rad].
    interval : float
        Least time between updates [s].
    """

    lateral: float = 0.08
    vertical: float = 0.3
    turn: float = 0.1
    min_speed: float = 1.0
    axle: float = 0.0
    mounting: tuple[float, float] = (0.0, 0.0)
    interval: float = 0.1
    last: float = -math.inf
    needs_heading: ClassVar[bool] = True
    parameters: ClassVar[tuple[str, ...]] = ("lateral", "vertical", "turn")

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Observation of lateral and vertical slip; see `Constraint.tick`."""
        if motion.time - self.last < self.interval - 1e-3:
            return None
        layout = belief.layout
        speed, *observation = slip(
            belief.estimate(),
            layout.offsets,
            layout.n,
            np.asarray(self.mounting),
            self.axle,
            motion.felt,
            self.lateral,
            self.vertical,
            self.turn,
        )
        if abs(speed) < self.min_speed:
            return None
        self.last = motion.time
        return Observation(*observation)

    def hear(self, reading: Reading) -> None:
        """Nothing to learn."""

    def copy(self) -> Self:
        """An independent copy; see `Constraint.copy`."""
        return type(self)(**vars(self))
