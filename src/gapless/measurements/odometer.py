"""Wheel speed, its scale and its offset states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation
from gapless.measurements.vehicle import odometer
from gapless.trip.events import Reading


@dataclass(frozen=True)
class Odometer:
    """Wheel speed.

    Parameters
    ----------
    sd : float
        Standard deviation of a reading [m/s].
    correlation : float
        Correlation time of its error [s].
    jitter : float
        Standard deviation of its time stamps [s]; an odometer's clock may drift by some tenths.
    side : float
        Standard deviation of how far the wheel is aside of the box [m].
    mounting : tuple of 2 float
        Pitch and yaw of the car's forward axis in the box, where they are not states [rad].
    """

    sd: float = 0.2
    correlation: float = 0.5
    jitter: float = 0.2
    side: float = 0.5
    mounting: tuple[float, float] = (0.0, 0.0)

    def observe(self, belief: Belief, reading: Reading) -> Observation:
        """Observation of the forward speed; see `Sensor.observe`."""
        layout = belief.layout
        sd = self.sd * max(1.0, self.correlation / max(reading.interval, 0.01)) ** 0.5
        return Observation(
            *odometer(
                belief.estimate(),
                layout.offsets,
                layout.n,
                np.asarray(self.mounting),
                belief.memory,
                self.jitter,
                self.side,
                float(reading.value[0]),
                sd,
            )
        )
