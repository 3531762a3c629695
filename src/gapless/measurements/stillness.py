"""Standing still, told from driving by this drive's own vibration; then the zero-velocity update.

No threshold travels between cars. While GNSS speaks, the spread of rate and specific force over the
last second and a half is filed under "still" or "moving" by the GNSS speed; a stop is believed when
both spreads look much more like this drive's stops than like its driving, when acceleration and
turn rate are near zero too (steady braking has a small spread), when the filter's own speed allows
it and when all of it has lasted. A drive without a labelled stop gets no zero-velocity updates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np

from gapless import earth
from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows
from gapless.inertial.belief import Belief
from gapless.inertial.layout import ROW
from gapless.inertial.trail import GRAVITY
from gapless.measurements.base import Constraint, Observation
from gapless.measurements.zero_velocity import zero_velocity
from gapless.trip.events import Motion, Reading
from gapless.trip.recording import Array
from gapless.units import DEG

SLOTS = 15
"""Ticks in the window."""
STILL, MOVING = 0, 1


@inline
def log_spread(ring: Array, column: int, floor: float) -> Any:
    """Log of the total standard deviation of three columns over a window of ticks.

    Parameters
    ----------
    ring : ndarray, shape (slots, 6)
        Mean rate [rad/s] and specific force [m/s^2] of each tick.
    column : int
        First of the three.
    floor : float
        Spread that no sensor resolves.

    Returns
    -------
    float
    """
    n = ring.shape[0]
    total = floor * floor
    for c in range(column, column + 3):
        mean = 0.0
        for i in range(n):
            mean += ring[i, c]
        mean /= n
        for i in range(n):
            total += (ring[i, c] - mean) ** 2 / n
    return 0.5 * np.log(total)


@inline
def log_odds(spread: Array, mean: Array, var: Array) -> tuple[Any, Any]:
    """Log likelihood of "still" over that of "moving", and over the best that "still" can have.

    The classes are one-sided: quieter than the stops is still, rougher than the driving is driving.

    Parameters
    ----------
    spread : ndarray, shape (2,)
        Log spreads of rate and specific force.
    mean, var : ndarray, shape (2, 2)
        Of the log spreads of each class.

    Returns
    -------
    odds, fit : float
    """
    odds = fit = 0.0
    for i in range(2):
        over = max(spread[i] - mean[STILL, i], 0.0)
        under = min(spread[i] - mean[MOVING, i], 0.0)
        fit -= 0.5 * over * over / var[STILL, i]
        odds += 0.5 * (under * under / var[MOVING, i] + np.log(var[MOVING, i] / var[STILL, i]))
    return odds + fit, fit


@inline
def _acceleration_variance(c: Any, p: Array, row: int) -> Any:
    """Of the horizontal acceleration that tilt and accelerometer bias feign, north and east together.

    Its error is g phi_e + C ba in the north and -g phi_n + C ba in the east (Groves 2013, eq. 14.67).
    """
    total = 0.0
    for axis in range(2):
        tilt, lean = 7 - axis, GRAVITY * (1.0 - 2.0 * axis)
        total += lean * lean * p[tilt * row + tilt]
        for i in range(3):
            a = c[3 * axis + i]
            total += 2.0 * lean * a * p[tilt * row + 12 + i]
            for j in range(3):
                total += a * c[3 * axis + j] * p[(12 + i) * row + 12 + j]
    return max(total, 0.0)


@kernel
def stands(
    x: Array,
    p: Array,
    row: int,
    felt: Array,
    share: float,
    ring: Array,
    spread: Array,
    smooth: Array,
    mean: Array,
    var: Array,
    odds: float,
    limits: Array,
) -> bool:
    """Whether a tick looks like a stop of this drive.

    Parameters
    ----------
    x : ndarray
        Nominal state.
    p : ndarray, shape (row * row,)
        Covariance.
    row : int
    felt : ndarray, shape (6,)
        Mean rate [rad/s] and specific force [m/s^2] of the tick.
    share : float
        Weight of the tick in the smoothed motion.
    ring : ndarray, shape (slots, 6)
        The window, this tick included.
    spread, smooth : ndarray, shape (2,), (5,)
        Changed in place: log spreads; smoothed rate and horizontal acceleration.
    mean, var : ndarray, shape (2, 2)
        Of the classes.
    odds : float
        Least log odds.
    limits : ndarray, shape (3,)
        Largest rate [rad/s]; acceleration beyond two of its deviations, for a tilt that the filter is
        not sure of feigns one [m/s^2]; squared Mahalanobis norm of the velocity.

    Returns
    -------
    bool
    """
    c = matrix_rows((x[6], x[7], x[8], x[9]))
    spread[0], spread[1] = log_spread(ring, 0, 3e-4), log_spread(ring, 3, 3e-3)
    for i in range(3):
        smooth[i] += share * (felt[i] - smooth[i])
    for i in range(2):
        a = c[3 * i] * felt[3] + c[3 * i + 1] * felt[4] + c[3 * i + 2] * felt[5]
        smooth[3 + i] += share * (a - smooth[3 + i])
    better, fit = log_odds(spread, mean, var)
    if better < odds or fit < -4.5:
        return False
    if smooth[0] ** 2 + smooth[1] ** 2 + smooth[2] ** 2 > limits[0] ** 2:
        return False
    doubt = np.sqrt(_acceleration_variance(c, p, row))
    if smooth[3] ** 2 + smooth[4] ** 2 > (limits[1] + 2.0 * doubt) ** 2:
        return False
    nn, ee, ne = p[3 * row + 3] + 0.04, p[4 * row + 4] + 0.04, p[3 * row + 4]
    surprise = (ee * x[3] ** 2 - 2.0 * ne * x[3] * x[4] + nn * x[4] ** 2) / (nn * ee - ne * ne)
    return bool(surprise < limits[2])


@dataclass
class Stillness(Constraint):
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
    limits : ndarray, shape (3,)
        As `stands` takes them: above these, nothing stands.
    """

    sd: float = 0.12
    sd_rate: float = 0.12 * DEG
    odds: float = 4.5
    hold: float = 1.5
    interval: float = 0.2
    limits: Array = field(default_factory=lambda: np.array([0.4 * DEG, 0.12, 22.5]))
    ring: Array = field(default_factory=lambda: np.zeros((SLOTS, 6)))
    filled: int = 0
    count: Array = field(default_factory=lambda: np.zeros(2))
    mean: Array = field(default_factory=lambda: np.zeros((2, 2)))
    var: Array = field(default_factory=lambda: np.full((2, 2), 0.1))
    smooth: Array = field(default_factory=lambda: np.zeros(5))
    spread: Array = field(default_factory=lambda: np.full(2, 3.0))
    label: int = -1
    label_since: float = -math.inf
    label_time: float = -math.inf
    fix_time: float = -math.inf
    fix: Array = field(default_factory=lambda: np.zeros(3))
    velocity_heard: bool = False
    lasted: float = 0.0
    last: float = -math.inf
    needs_heading: ClassVar[bool] = False
    needs_samples: ClassVar[bool] = True
    parameters: ClassVar[tuple[str, ...]] = ("sd", "sd_rate", "odds", "hold")

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
            north, east = reading.value[:2] - self.fix[:2]
            east = earth.longitude(east) * math.cos(reading.value[0])
            self._file(reading.time, math.hypot(6.37e6 * north, 6.37e6 * east) / gap, 0.35)
        self.fix_time, self.fix = reading.time, np.array(reading.value)

    def _file(self, time: float, speed: float, slow: float) -> None:
        label = STILL if speed < slow else MOVING if 2.0 < speed < 60.0 else -1
        if label != self.label:
            self.label, self.label_since = label, time
        self.label_time = time
        if label < 0 or time - self.label_since < 1.0 or self.filled < SLOTS:
            return
        self.count[label] += 1
        weight, clipped = 1.0 / min(self.count[label], 300.0), self.count[label] > 20
        for i in range(2):
            off = self.spread[i] - self.mean[label, i]
            if clipped:
                limit = 4.0 * math.sqrt(self.var[label, i])
                off = max(-limit, min(limit, off))
            self.mean[label, i] += weight * off
            if self.count[label] > 5:
                self.var[label, i] += weight * (off * off - self.var[label, i])
            self.var[label, i] = max(self.var[label, i], 0.02)

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Zero-velocity observation where the vehicle stands; see `Constraint.tick`."""
        self.ring[self.filled % SLOTS] = motion.felt
        self.filled += 1
        if self.filled < SLOTS:
            return None
        x, share = belief.estimate(), min(1.0, motion.dt / 0.4)
        limits = self.limits if not self._seen_still(motion.time) else np.array([np.inf, *self.limits[1:]])
        still = stands(
            x, belief.p, ROW, motion.felt, share, self.ring, self.spread, self.smooth,
            self.mean, self.var, self.odds, limits,
        )  # fmt: skip
        self.lasted = self.lasted + motion.dt if still and self._known(motion.time) else 0.0
        if self.lasted < self.hold or motion.time - self.last < self.interval - 1e-3:
            return None
        self.last = motion.time
        return Observation(*zero_velocity(x, belief.layout.n, motion.rate, self.sd, self.sd_rate))

    def _seen_still(self, time: float) -> bool:
        """GNSS sees the car stand: a steady rate is then the gyro's, however large."""
        return self.label == STILL and time - self.label_time < 2.2 and time - self.label_since > 2.0

    def lost(self) -> None:
        """Begin a new window; see `Constraint.lost`."""
        self.filled, self.lasted = 0, 0.0

    def _known(self, time: float) -> bool:
        """Both classes have been seen, and a fresh GNSS speed does not contradict."""
        if self.count[STILL] < 8 or self.count[MOVING] < 20:
            return False
        return time - self.label_time >= 2.2 or self.label == STILL

    def copy(self) -> Self:
        """An independent copy; see `Constraint.copy`."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))  # copy.copy takes ten times as long, and this is done at every block
        for name in ("ring", "count", "mean", "var", "smooth", "spread"):
            setattr(new, name, getattr(self, name).copy())
        return new
