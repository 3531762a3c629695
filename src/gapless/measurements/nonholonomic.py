"""The non-holonomic constraint of a car, at ticks, while it drives forward."""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np

from gapless.events import Motion, Reading
from gapless.inertial.belief import Belief
from gapless.measurements.base import Constraint, Observation
from gapless.measurements.vehicle import slip
from gapless.recording import Array


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
    memory : ndarray, shape (1,)
        When it was observed last [s].
    """

    lateral: float = 0.08
    vertical: float = 0.3
    turn: float = 0.1
    min_speed: float = 1.0
    axle: float = 0.0
    mounting: tuple[float, float] = (0.0, 0.0)
    interval: float = 0.1
    memory: Array = field(default_factory=lambda: np.full(1, -math.inf))
    needs_heading: ClassVar[bool] = True
    parameters: ClassVar[tuple[str, ...]] = ("lateral", "vertical", "turn")

    @property
    def tuning(self) -> Array:
        """All parameters, as `coast` takes them."""
        bounds = self.min_speed, self.interval, self.axle, *self.mounting
        return np.array([self.lateral, self.vertical, self.turn, *bounds])

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Observation of lateral and vertical slip; see `Constraint.tick`."""
        if motion.time - self.memory[0] < self.interval - 1e-3:
            return None
        speed, observation = self._slip(belief, motion)
        if speed < self.min_speed:
            return None
        self.memory[0] = motion.time
        return observation

    def observe(self, belief: Belief, motion: Motion) -> Observation:
        """Observation of lateral and vertical slip, at whatever speed.

        Parameters
        ----------
        belief : Belief
        motion : Motion

        Returns
        -------
        Observation
        """
        return self._slip(belief, motion)[1]

    def _slip(self, belief: Belief, motion: Motion) -> tuple[float, Observation]:
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
        return speed, Observation(*observation)

    def hear(self, reading: Reading) -> None:
        """Nothing to learn."""

    def copy(self) -> Self:
        """An independent copy; see `Constraint.copy`."""
        new = copy(self)
        new.memory = self.memory.copy()
        return new
