"""The wheel-order odometer: hears in the IMU how fast the wheels turn.

While GNSS speaks it learns the comb of this car over orders; while GNSS is silent it finds the speed at
which a spectrum fits that comb best, around what the filter says, and whether it fits better than no
comb at all. What it says is a speed: (z, H, R) on the mean length of the velocity over the window.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import ClassVar, Final, Self

import numpy as np

from gapless.bridges.base import Saying
from gapless.bridges.comb import Memory
from gapless.bridges.combs import Combs
from gapless.bridges.course import Course, Drift
from gapless.bridges.felt import felt
from gapless.bridges.mean_speed import mean_speed
from gapless.bridges.orders import LONGEST, LOWEST, ORDERS, STEP, WINDOW, Spectrum, spectrum, window
from gapless.bridges.peak import Peak, Trust, peak
from gapless.bridges.slip import Hold
from gapless.bridges.vehicle import recalled
from gapless.errors import ConfigError
from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation, Sensor
from gapless.trip.events import ImuBlock, Motion, Reading
from gapless.trip.exhibits import Heard, WheelsHeard, fundamental
from gapless.trip.solution import Decision

TAUGHT: Final = 1.5
"""Spectra of slower driving are not learned from [m/s]."""
SURE: Final = 0.5
"""Nor are those where the filter's speed is less certain than this [m/s]."""
RATE: Final = 25.0
"""A slower IMU hears no wheels [Hz]."""
HOLE: Final = 0.2
"""In a window with a larger hole no wheels are heard [s]."""
ROOM: Final = 0.4
"""Samples and velocities are kept for so much longer than a window [s]."""


@dataclass
class Wheels:
    """See the module.

    Parameters
    ----------
    sensors : mapping of str to Sensor
        Of the same system.
    temper : float
        Factor on log likelihoods: neighbouring orders are correlated, and templates are not exact.
    least : int
        Spectra that must have been learned from.
    period : float
        Time between spectra [s].
    inflate : float
        Factor on variances: windows overlap, longer ones more.
    floor : float
        Standard deviation that no reading is better than [m/s].
    doubt : float
        Factor on the filter's deviation of the speed, which it is over-sure of.
    evidence : float
        Log likelihood ratio against no comb that is asked for.
    deaf : float
        Prior probability that a window has no comb to be heard, whatever the speed.
    mass : float
        Share of the probability that the peak must hold.
    widest : float
        Speeds farther from the filter's than this are not looked at [m/s].
    patience : float
        Without a fix for so long, GNSS is silent [s].
    vehicle : str
        File with what was heard of the car on an earlier drive.
    """

    sensors: Mapping[str, Sensor]
    temper: float = 0.15
    least: int = 30
    period: float = 1.0
    inflate: float = 4.0
    floor: float = 0.1
    doubt: float = 2.0
    evidence: float = 0.7
    deaf: float = 0.2
    mass: float = 0.8
    widest: float = 6.0
    patience: float = 2.5
    vehicle: str = ""
    blocks: list[ImuBlock] = field(default_factory=list, init=False)
    memory: Memory | None = field(default=None, init=False)
    combs: Combs | None = field(default=None, init=False)
    rate: float = field(default=math.nan, init=False)
    fixed: float = field(default=-math.inf, init=False)
    due: float = field(default=-math.inf, init=False)
    readings: tuple[Heard, ...] = field(default=(), init=False)
    refused: int = field(default=0, init=False)
    drift: Drift = field(default=Drift(), init=False)
    course: Course | None = field(default=None, init=False)
    hold: Hold | None = field(default=None, init=False)
    reach: ClassVar[float] = LONGEST + ROOM

    def __post_init__(self) -> None:
        for name in (f.name for f in fields(self) if f.init and f.name not in ("sensors", "vehicle")):
            value, most = getattr(self, name), 1.0 if name in ("deaf", "mass") else math.inf
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value < most:
                bound = "from 0 to less than 1" if most == 1.0 else "of 0 or more"
                raise ConfigError(f"bridge.parameters: {name} is {value!r}; give a number {bound}")
        if not isinstance(self.vehicle, str):
            raise ConfigError(f"bridge.parameters: vehicle is {self.vehicle!r}; give the name of a file")
        if self.vehicle:
            self.memory = recalled(self.vehicle)

    @property
    def trust(self) -> Trust:
        """How likelihoods are believed."""
        return Trust(self.temper, self.deaf, self.evidence, self.mass, self.widest)

    def feel(self, block: ImuBlock) -> None:
        """See `Bridge`."""
        self.blocks.append(block)

    def hear(self, belief: Belief, reading: Reading, used: bool) -> None:
        """See `Bridge`: a fix that is used breaks the silence."""
        if used and reading.channel in self.sensors and reading.channel != "odometer":
            self.fixed = reading.time

    def tick(self, belief: Belief, motion: Motion) -> tuple[Saying, ...]:
        """See `Bridge`."""
        if motion.time < self.due:
            return ()
        self.due = motion.time + self.period - 0.5 * motion.dt
        heard = self._listen(belief, motion.time)
        if heard is None:
            return ()
        if motion.time - self.fixed > self.patience:
            return self._speak(belief, heard, motion.time)
        self._learn(belief, heard, motion.time)
        return ()

    def begin_with(self, other: Self) -> None:
        """See `Bridge`: a car's wheels are the same all day."""
        self.memory, self.combs = other.memory, None

    def lost(self) -> None:
        """See `Bridge`."""
        self.blocks = []

    def decisions(self, start: float) -> tuple[Decision, ...]:
        """See `Bridge`."""
        if self.rate < RATE - 0.5:
            slow = f"the IMU logs {self.rate:.0f} samples a second; {RATE:g} are needed"
            return (Decision("wheels heard", 0, "spectra", "data", slow),)
        shown = self.exhibit()
        if shown is None:
            return (Decision("wheels heard", 0, "spectra", "data", "no driving fast enough to learn from"),)
        around = shown.circumference
        size = f"{around:.2f} m in circumference" if around else "no comb stands out"
        said = f"{len(self.readings)} speeds read in silence, {self.refused} spectra that said too little"
        slipped = sum(one.slips > 0.5 for one in self.readings)
        said += f"; slip noticed in {slipped}"
        return (Decision("wheels heard", round(shown.spectra), "spectra", "data", f"{size}; {said}"),)

    def exhibit(self) -> WheelsHeard | None:
        """See `Bridge`."""
        if self.memory is None:
            return None
        comb, orders = self.memory.comb(), np.asarray(LOWEST + STEP * np.arange(ORDERS), float)
        found = fundamental(orders, comb.height, comb.error)
        return WheelsHeard(
            self.memory.windows, orders, comb.height, comb.error, *found, self.readings, self.refused
        )

    def learned(self) -> object | None:
        """See `Bridge`: the memory of this car."""
        return self.memory

    def copy(self) -> Self:
        """See `Bridge`: sums are shared, for they are never changed."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))  # copy.copy takes ten times as long, and this is done at every block
        new.blocks = list(self.blocks)
        return new

    # --- hearing --------------------------------------------------------------------------------

    def _listen(self, belief: Belief, time: float) -> Spectrum | None:
        """The spectrum of the window that ends now, warped by the inertial course of the speed."""
        if not self.blocks:
            return None
        self.blocks = [ImuBlock.join(self.blocks).within(time - self.reach, math.inf)]  # some lie ahead
        times, gained = belief.trail.behind(LONGEST)
        if len(times) < 10 or times[-1] < time - 1e-3:
            return None
        v = belief.estimate()[3:6] + gained
        speeds = np.sqrt((v * v).sum(axis=1))
        length = window(times, speeds)
        found = felt(self.blocks[0], time - length - ROOM, time) if length else None
        if found is None:
            return None
        self.rate = found.rate
        first, last = found.rows[0, 0], found.rows[-1, 0]
        if self.rate < RATE - 0.5 or found.gap > HOLE or first > time - length or last < time - HOLE:
            return None
        return spectrum(found.rows, times, speeds, length, 0.5 * self.rate - 3.0)

    def _learn(self, belief: Belief, heard: Spectrum, time: float) -> None:
        if heard.speed < TAUGHT or speed_sd(belief) > SURE:
            return
        memory = self.memory or Memory.empty(heard.top)
        self.memory, self.combs = memory.after(heard), None
        v = belief.estimate()[3:6]
        self.drift = self.drift.after(time, v / np.linalg.norm(v), belief.trail.corrected)

    def _speak(self, belief: Belief, heard: Spectrum, time: float) -> tuple[Saying, ...]:
        if self.memory is None or self.memory.windows < self.least:
            return ()
        if self.combs is None:
            self.combs = Combs.of(self.memory)
        self._follow(belief, time)
        h = mean_speed(belief, heard.length)
        own = math.sqrt(max(float(h[0] @ belief.P @ h[0]), 0.0))
        found = peak(self.combs.at(heard.speed), heard, math.hypot(self.doubt * own, 0.3), self.trust)
        if found is None:
            self.refused += 1
            return ()
        speed = float(np.linalg.norm(belief.estimate()[3:6]))
        r, slips = self._doubted(time, found, speed, self.inflate * heard.length / WINDOW)
        self.readings = (*self.readings, Heard(time, speed + found.off, math.sqrt(r), speed, slips))
        return (Saying("bridge_speed", Observation(np.array([found.off]), h, np.array([[r]]))),)

    def _follow(self, belief: Belief, time: float) -> None:
        """The inertial course through this silence."""
        v, corrected = belief.estimate()[3:6], belief.trail.corrected
        if self.course is None or self.course.begun < self.fixed:
            self.course = Course(time, corrected, time)
            self.hold = Hold.begin(time - self.patience, speed_sd(belief) ** 2, self.drift.rate)
        self.course = self.course.to(time, v / np.linalg.norm(v), corrected)

    def _doubted(self, time: float, found: Peak, speed: float, inflate: float) -> tuple[float, float]:
        """Variance that a reading counts with [m^2/s^2], and the probability of slip that widens it."""
        own = found.variance + self.floor**2
        assert self.hold is not None
        assert self.course is not None
        self.hold = self.hold.after(time, found.off + self.course.gained, own, speed)
        return inflate * own / self.hold.rolls, self.hold.slips


def speed_sd(belief: Belief) -> float:
    """Standard deviation of the length of the velocity.

    Parameters
    ----------
    belief : Belief

    Returns
    -------
    float
        [m/s]
    """
    v = belief.estimate()[3:6]
    unit = v / max(float(np.linalg.norm(v)), 0.1)
    return math.sqrt(max(float(unit @ belief.P[3:6, 3:6] @ unit), 0.0))
