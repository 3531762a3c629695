"""Standing still, told from driving by this drive's own vibration; then the zero-velocity update.

No threshold travels between cars. While GNSS speaks, the spread of rate and specific force over the
last second and a half is filed under "still" or "moving" by the GNSS speed; a stop is believed when
both spreads look much more like this drive's stops than like its driving, when acceleration and
turn rate are near zero too (steady braking has a small spread), when the filter's own speed allows
it and when all of it has lasted. A drive without a labelled stop gets no zero-velocity updates.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np

from gapless._numba import inline, kernel
from gapless.attitude import matrix_rows
from gapless.events import Motion, Reading
from gapless.inertial.belief import Belief
from gapless.inertial.layout import ROW
from gapless.inertial.trail import GRAVITY
from gapless.measurements.base import Constraint, Observation
from gapless.measurements.zero_velocity import zero_velocity
from gapless.recording import Array
from gapless.units import DEG

SLOTS = 15
"""Ticks in the window."""
STILL, MOVING = 0, 1
RING, MEAN, VAR, COUNT, SPREAD, SMOOTH = 0, 90, 94, 98, 100, 102
FILLED, LASTED, LAST, LABEL, LABEL_SINCE, LABEL_TIME = 107, 108, 109, 110, 111, 112
MEMORY_SIZE = 113
"""Indices of the memory: the window; mean and variance of the log spreads of each class, and how often each
was seen; log spreads now; smoothed rate and horizontal acceleration; ticks so far, how long everything has
lasted, the last update; the class that GNSS names, since when, and when it did last."""
SURE_STILL, SURE_MOVING = 8, 20
"""So often must each class have been seen."""


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


@inline
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


@inline
def rests(
    x: Array, p: Array, row: int, time: float, dt: float, felt: Array, tuning: Array, memory: Array
) -> bool:
    """Whether a stop is believed at the end of a tick, and an update is due.

    Parameters
    ----------
    x, p, row
        As for `stands`.
    time, dt : float
        End and length of the tick [s].
    felt : ndarray, shape (6,)
        As for `stands`.
    tuning : ndarray, shape (8,)
        `Stillness.tuning`.
    memory : ndarray, shape (113,)
        Changed in place.

    Returns
    -------
    bool
    """
    filled = int(memory[FILLED])
    slot = RING + 6 * (filled % SLOTS)
    for i in range(6):
        memory[slot + i] = felt[i]
    memory[FILLED] = filled + 1
    if filled + 1 < SLOTS:
        return False
    still = stands(
        x, p, row, felt, min(1.0, dt / 0.4), memory[RING:MEAN].reshape(SLOTS, 6), memory[SPREAD:SMOOTH],
        memory[SMOOTH:FILLED], memory[MEAN:VAR].reshape(2, 2), memory[VAR:COUNT].reshape(2, 2), tuning[2],
        tuning[5:],
    )  # fmt: skip
    known = memory[COUNT + STILL] >= SURE_STILL and memory[COUNT + MOVING] >= SURE_MOVING
    # a fresh GNSS speed does not contradict
    known = known and (time - memory[LABEL_TIME] >= 2.2 or memory[LABEL] == STILL)
    memory[LASTED] = memory[LASTED] + dt if still and known else 0.0
    if memory[LASTED] < tuning[3] or time - memory[LAST] < tuning[4] - 1e-3:
        return False
    memory[LAST] = time
    return True


@kernel
def _rests(
    x: Array, p: Array, row: int, time: float, dt: float, felt: Array, tuning: Array, memory: Array
) -> bool:
    return rests(x, p, row, time, dt, felt, tuning, memory)


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
    memory: Array = field(default_factory=lambda: _nothing_yet())
    fix_time: float = -math.inf
    fix: Array = field(default_factory=lambda: np.zeros(3))
    velocity_heard: bool = False
    needs_heading: ClassVar[bool] = False
    parameters: ClassVar[tuple[str, ...]] = ("sd", "sd_rate", "odds", "hold")

    @property
    def tuning(self) -> Array:
        """All parameters, as `rests` takes them."""
        return np.array([self.sd, self.sd_rate, self.odds, self.hold, self.interval, *self.limits.tolist()])

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
        _file(self.memory, time, STILL if speed < slow else MOVING if 2.0 < speed < 60.0 else -1)

    def tick(self, belief: Belief, motion: Motion) -> Observation | None:
        """Zero-velocity observation where the vehicle stands; see `Constraint.tick`."""
        x, tuning = belief.estimate(), self.tuning
        if not _rests(x, belief.p, ROW, motion.time, motion.dt, motion.felt, tuning, self.memory):
            return None
        return self.observe(belief, motion)

    def observe(self, belief: Belief, motion: Motion) -> Observation:
        """Zero-velocity observation of a vehicle that stands.

        Parameters
        ----------
        belief : Belief
        motion : Motion

        Returns
        -------
        Observation
        """
        x = belief.estimate()
        return Observation(*zero_velocity(x, belief.layout.n, motion.rate, self.sd, self.sd_rate))

    def copy(self) -> Self:
        """An independent copy; see `Constraint.copy`."""
        new = copy(self)
        new.memory = self.memory.copy()
        return new


def _nothing_yet() -> Array:
    memory = np.zeros(MEMORY_SIZE)
    memory[VAR:COUNT], memory[SPREAD:SMOOTH] = 0.1, 3.0
    memory[LABEL], memory[LAST], memory[LABEL_SINCE], memory[LABEL_TIME] = -1.0, *[-math.inf] * 3
    return memory


@kernel
def _file(memory: Array, time: float, label: int) -> None:
    """File the present spread under a class; -1 is none."""
    if label != memory[LABEL]:
        memory[LABEL], memory[LABEL_SINCE] = label, time
    memory[LABEL_TIME] = time
    if label < 0 or time - memory[LABEL_SINCE] < 1.0 or memory[FILLED] < SLOTS:
        return
    memory[COUNT + label] += 1.0
    count = memory[COUNT + label]
    for i in range(2):
        mean, var = MEAN + 2 * label + i, VAR + 2 * label + i
        off = memory[SPREAD + i] - memory[mean]
        if count > 20:
            limit = 4.0 * np.sqrt(memory[var])
            off = max(-limit, min(limit, off))
        memory[mean] += off / min(count, 300.0)
        if count > 5:
            memory[var] += (off * off - memory[var]) / min(count, 300.0)
        memory[var] = max(memory[var], 0.02)
