"""Standing still, told from driving by this drive's own vibration; then the zero-velocity update.

No threshold travels between cars. While GNSS speaks, the spread of rate and specific force over the
last second and a half is filed under "still" or "moving" by the GNSS speed; a stop is believed when
both spreads look much more like this drive's stops than like its driving, when acceleration and
turn rate are near zero too (steady braking has a small spread), when the filter's own speed allows
it and when all of it has lasted. A drive without a labelled stop gets no zero-velocity updates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Self

import numpy as np

from gapless._numba import kernel
from gapless.events import Motion, Reading
from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation
from gapless.measurements.zero_velocity import zero_velocity
from gapless.recording import Array
from gapless.units import DEG

SLOTS = 15
"""Ticks in the window."""
STILL, MOVING = 0, 1
FLOOR = np.array([3e-4, 3e-3])
"""Spread that no sensor resolves: rad/s, m/s^2."""


@kernel
def log_spread(ring: Array) -> tuple[float, float]:
    """Log of the total standard deviation of rate and of specific force over a window of ticks.

    Parameters
    ----------
    ring : ndarray, shape (slots, 6)
        Mean rate [rad/s] and specific force [m/s^2] of each tick.

    Returns
    -------
    rate, force : float
    """
    n = ring.shape[0]
    total = np.zeros(2)
    for c in range(6):
        mean = 0.0
        for i in range(n):
            mean += ring[i, c]
        mean /= n
        for i in range(n):
            total[c // 3] += (ring[i, c] - mean) ** 2 / n
    return 0.5 * math.log(total[0] + 3e-4**2), 0.5 * math.log(total[1] + 3e-3**2)


@dataclass
class Stillness:
    """Zero velocity and zero angular rate, when the vehicle stands.

    Parameters
    ----------
    sd, sd_rate : float
        Standard deviation of one update: velocity [m/s], rate [rad/s].
    odds : float
        Log odds for "still" that are believed.
    hold : float
        Seconds that everything must have lasted.
    interval : float
        Least time between updates [s].
    """

    sd: float = 0.12
    sd_rate: float = 0.12 * DEG
    odds: float = 4.5
    hold: float = 1.5
    interval: float = 0.2
    max_accel: float = 0.12
    max_rate: float = 0.4 * DEG
    max_surprise: float = 22.5
    ring: Array = field(default_factory=lambda: np.zeros((SLOTS, 6)))
    filled: int = 0
    count: Array = field(default_factory=lambda: np.zeros(2))
    mean: Array = field(default_factory=lambda: np.zeros((2, 2)))
    var: Array = field(default_factory=lambda: np.full((2, 2), 0.1))
    smooth: Array = field(default_factory=lambda: np.zeros(6))
    spread: Array = field(default_factory=lambda: np.full(2, 3.0))
    label: int = -1
    label_since: float = -math.inf
    label_time: float = -math.inf
    fix_time: float = -math.inf
    fix: Array = field(default_factory=lambda: np.zeros(3))
    velocity_heard: bool = False
    lasted: float = 0.0
    last: float = -math.inf

    def hear(self, reading: Reading) -> None:
        """File the present spread under the class that the GNSS speed names."""
        if reading.channel == "velocity":
            self.velocity_heard = True
            self._file(reading.time, math.hypot(reading.value[0], reading.value[1]), 0.25)
        elif reading.channel == "position" and not self.velocity_heard:
            self._displacement(reading)

    def _displacement(self, reading: Reading) -> None:
        """Speed of a receiver that reports none, from fixes 3.5 s apart."""
        gap = reading.time - self.fix_time
        if gap < 3.5:
            return
        if gap < 6.0:
            step = (reading.value - self.fix) * 6.37e6
            east = step[1] * math.cos(reading.value[0])
            self._file(reading.time, math.hypot(step[0], east) / gap, 0.35)
        self.fix_time, self.fix = reading.time, np.array(reading.value)

    def _file(self, time: float, speed: float, slow: float) -> None:
        label = STILL if speed < slow else MOVING if 2.0 < speed < 60.0 else -1
        if label != self.label:
            self.label, self.label_since = label, time
        self.label_time = time
        if label < 0 or time - self.label_since < 1.0 or self.filled < SLOTS:
            return
        self.count[label] += 1
        weight = 1.0 / min(self.count[label], 300.0)
        off = self.spread - self.mean[label]
        if self.count[label] > 20:
            limit = 4.0 * np.sqrt(self.var[label])
            off = np.clip(off, -limit, limit)
        self.mean[label] += weight * off
        if self.count[label] > 5:
            self.var[label] += weight * (off * off - self.var[label])
        self.var[label] = np.maximum(self.var[label], 0.02)

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Zero-velocity observation where the vehicle stands; see `Constraint.tick`."""
        self.ring[self.filled % SLOTS, :3] = motion.rate
        self.ring[self.filled % SLOTS, 3:] = motion.force
        self.filled += 1
        if self.filled < SLOTS:
            return None
        self.spread[:] = log_spread(self.ring)
        self.lasted = self.lasted + motion.dt if self._still(belief, motion) else 0.0
        if self.lasted < self.hold or motion.time - self.last < self.interval - 1e-3:
            return None
        self.last = motion.time
        x = belief.estimate()
        return Observation(*zero_velocity(x, belief.layout.n, motion.rate, self.sd, self.sd_rate))

    def _still(self, belief: Belief, motion: Motion) -> bool:
        x = belief.estimate()
        c = belief.C_nb
        accel = c @ motion.force
        accel[2] = 0.0
        felt = np.concatenate([accel, motion.rate])
        self.smooth += min(1.0, motion.dt / 0.4) * (felt - self.smooth)
        if self.count[STILL] < 8 or self.count[MOVING] < 20 or not self._looks_still():
            return False
        if np.linalg.norm(self.smooth[:3]) > self.max_accel or np.linalg.norm(self.smooth[3:]) > self.max_rate:
            return False
        if motion.time - self.label_time < 2.2 and self.label != STILL:
            return False
        v, p = x[3:5], belief.P[3:5, 3:5]
        return bool(v @ np.linalg.solve(p + 0.04 * np.eye(2), v) < self.max_surprise)

    def _looks_still(self) -> bool:
        """One-sided classes: quieter than the stops is still, rougher than the driving is driving."""
        over = np.maximum(self.spread - self.mean[STILL], 0.0)
        under = np.minimum(self.spread - self.mean[MOVING], 0.0)
        still = -0.5 * float(np.sum(over**2 / self.var[STILL] + np.log(self.var[STILL])))
        moving = -0.5 * float(np.sum(under**2 / self.var[MOVING] + np.log(self.var[MOVING])))
        best = -0.5 * float(np.sum(np.log(self.var[STILL])))
        return still - moving > self.odds and still > best - 4.5

    def copy(self) -> Self:
        """An independent copy; see `Constraint.copy`."""
        new = object.__new__(type(self))
        for f in fields(self):
            value = getattr(self, f.name)
            setattr(new, f.name, value.copy() if isinstance(value, np.ndarray) else value)
        return new
