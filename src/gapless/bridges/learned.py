"""A bridge with a learner: it collects epochs, trains on them, and speaks when fixes stay away."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

import numpy as np

from gapless.bridges.base import Saying
from gapless.bridges.epochs import NOWHERE, Epoch
from gapless.bridges.model import Model, go_on
from gapless.bridges.noise import FilterNoise, Noise, rehearse
from gapless.bridges.schedule import Schedule, Trained
from gapless.bridges.shadow import Shadow, difference
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief
from gapless.inertial.coast import STATE
from gapless.measurements.base import Observation, Sensor
from gapless.trip.events import ImuBlock, Motion, Reading
from gapless.trip.recording import Array
from gapless.trip.solution import Decision

if TYPE_CHECKING:
    from gapless.learners import Regressor

ABSURD: Final = {"position": 1e5, "velocity": 1e3, "attitude": math.pi}
"""What a bridge says farther from the filter is not said [m, m/s, rad]: no filter is linear so far out, and a
learner that extrapolates has moved one to where no fix could bring it back from."""


@dataclass
class LearnedBridge:
    """An input-output model, a learner and a noise.

    Parameters
    ----------
    model : Model
    learner : callable
        A new, untrained one; None where nothing is to be learned here.
    sensors : dict of str to Sensor
        "position", and "velocity" where there is one.
    noise : Noise
    schedule : Schedule
    shadow : Shadow
    trained : Trained, optional
        One that has learned elsewhere.
    """

    model: Model
    learner: Callable[[], Regressor] | None
    sensors: dict[str, Sensor]
    noise: Noise = field(default_factory=FilterNoise)
    schedule: Schedule = field(default_factory=Schedule)
    shadow: Shadow = field(default_factory=Shadow)
    trained: Trained | None = None
    trainings: tuple[Trained, ...] = ()
    epochs: list[Epoch] = field(default_factory=list)
    heard: dict[str, Array] = field(default_factory=dict)
    fix: Array = field(default_factory=lambda: NOWHERE)
    fix_time: float = math.nan
    spoke: float = math.nan
    velocity_error: tuple[float, Array] = (-math.inf, NOWHERE)
    felt: Array = field(default_factory=lambda: np.zeros(6))
    felt_before: Array = field(default_factory=lambda: np.zeros(6))
    felt_fix: Array = field(default_factory=lambda: np.zeros(6))
    before: float = math.nan
    course: Any = None
    began: float = math.nan
    count: int = 0
    pace: float = math.nan
    settled: float = -math.inf
    reach: ClassVar[float] = 0.0

    def __post_init__(self) -> None:
        if math.isnan(self.pace):
            self.pace = self.schedule.interval

    def feel(self, block: ImuBlock) -> None:
        """See `Bridge`: the shadow goes by ticks."""

    def hear(self, belief: Belief, reading: Reading, used: bool) -> None:
        """See `Bridge`; a rejected fix breaks the silence too.

        A filter that went wrong on a bridge's word would else listen to nothing but the bridge.
        """
        if reading.channel not in self.sensors:
            return
        if reading.channel == "position":
            self.spoke = reading.time
        if not used:
            return
        seen = self.sensors[reading.channel].observe(belief, reading)
        self.heard[reading.channel] = seen.R
        if not self.shadow.running:
            return
        x = self.shadow.now(belief)
        apart = difference(x, belief.estimate()[:STATE])
        if reading.channel == "velocity":
            self.velocity_error = (reading.time, apart[3:6] - seen.z)
            return
        if not math.isnan(self.began):  # an outage ends: its last word is no epoch to go on from
            self.course, self.began, self.count, self.before = None, math.nan, 0, math.nan
            self.settled = reading.time + self.schedule.settle
        self.fix, self.fix_time, self.felt_fix = reading.value, reading.time, self._felt_now(belief)
        if reading.time < self.settled:
            return
        if not reading.time - self.before < self.schedule.interval - 0.05:
            self._learn_from(belief, reading.time, x, apart, seen.z)

    def tick(self, belief: Belief, motion: Motion) -> tuple[Saying, ...]:
        """See `Bridge`."""
        self.felt = self.felt + motion.felt * motion.dt
        silent = motion.time - self.spoke > 1.5 * self.pace + self.schedule.slack
        if not silent:
            self._keep_up(belief, motion)
            return ()
        self.shadow.tick(belief, motion)
        if self.course is None:
            if math.isnan(self.began):
                self._go_silent(belief, motion.time)
            if self.course is None:
                return ()
        if motion.time < self.before + self.pace - 0.5 * motion.dt:
            return ()
        return self._speak(belief, motion.time)

    def begin_with(self, other: Self) -> None:
        """See `Bridge`: what it learns is of its time, so there is nothing to take over."""

    def lost(self) -> None:
        """See `Bridge`."""
        self.before = self.fix_time = self.spoke = self.shadow.began = math.nan
        self.course, self.velocity_error = None, (-math.inf, NOWHERE)

    def decisions(self, start: float) -> tuple[Decision, ...]:
        """See `Bridge`."""
        return tuple(
            Decision("bridge trained", t.rows, "epochs", "data", f"{t.time - start:.1f} s; {t.noise.text}")
            for t in self.trainings
        )

    def exhibit(self) -> None:
        """See `Bridge`."""

    def learned(self) -> object | None:
        """See `Bridge`."""
        return None if self.trained is None else self.trained.learner

    def copy(self) -> Self:
        """See `Bridge`: values are shared, lists are not."""
        return replace(self, epochs=list(self.epochs), heard=dict(self.heard), shadow=self.shadow.copy())

    # --- learning -------------------------------------------------------------------------------

    def _learn_from(self, belief: Belief, time: float, x: Array, apart: Array, seen: Array) -> None:
        """Keep an epoch; `apart` is shadow less filter, `seen` is GNSS less filter."""
        when, velocity = self.velocity_error
        if not time - when < self.schedule.interval:
            # a receiver without velocities: the filter's, which its positions hold, stands in
            velocity = apart[3:6]
        gnss = np.concatenate([apart[:3] - seen, velocity])
        epoch = self._epoch(belief, time, x)
        if not epoch.dt < 1.6 * self.pace:
            epoch = epoch._replace(dt=math.nan)
        epoch = epoch._replace(gnss_error=gnss, filter_error=apart, fix=self.fix)
        self.epochs.append(epoch)
        del self.epochs[: -self.schedule.samples]
        steps = [e.dt for e in self.epochs[-20:] if not math.isnan(e.dt)]
        self.pace = statistics.median(steps) if steps else self.pace
        self.felt_before, self.before = self._felt_now(belief), time

    def _epoch(self, belief: Belief, time: float, x: Array) -> Epoch:
        """An epoch without what GNSS said in it."""
        dt = time - self.before
        mean = (self._felt_now(belief) - self.felt_before) / dt
        shadow, unknown = self.shadow, np.full(9, np.nan)
        return Epoch(
            time, dt, shadow.starts, time - shadow.began, x, shadow.displacement(x),
            belief.estimate()[3:6].copy(), mean[:3], mean[3:], unknown[:6], unknown, NOWHERE,
        )  # fmt: skip

    def _felt_now(self, belief: Belief) -> Array:
        return self.felt + belief.memory[at.TICK_W : at.TICK_W + 6]

    def _keep_up(self, belief: Belief, motion: Motion) -> None:
        """While GNSS speaks: the shadow starts anew where that is due, and a schedule is kept."""
        stale = math.isfinite(self.shadow.interval) and self.shadow.began < self.settled <= motion.time
        if stale or self.shadow.due(motion.time):
            self.shadow.restart(belief, motion.time)
        else:
            self.shadow.tick(belief, motion)
        last = self.trained.time if self.trained is not None else -math.inf
        if math.isfinite(self.schedule.every) and motion.time - last >= self.schedule.every:
            self._train(motion.time)

    def _train(self, time: float) -> None:
        """Train on what there is, after a rehearsal on what was held out of a first training."""
        if self.learner is None:
            return
        noise = self.noise
        if noise.held_out:
            noise = self._calibrated(noise, self.learner())
        x, y = self.model.pairs(self.epochs)
        if len(x) < self.schedule.least:
            return
        learner = self.learner()
        learner.fit(x, y)
        self.trained = Trained(learner, noise, time, len(x))
        self.trainings = (*self.trainings, self.trained)

    def _calibrated(self, noise: Noise, learner: Regressor) -> Noise:
        """The noise that fits what a learner of the older epochs gets wrong in the later ones."""
        cut = round((1.0 - noise.held_out) * len(self.epochs))
        older, later = self.epochs[: max(0, cut - self.schedule.purge)], self.epochs[cut:]
        x, y = self.model.pairs(older)
        if len(x) < max(2, self.schedule.least // 2) or len(later) < 6:
            return noise
        learner.fit(x, y)
        horizon = max(5, min(60, len(later) // 2))
        return noise.fitted(rehearse(self.model, learner.predict, later, horizon))

    # --- speaking -------------------------------------------------------------------------------

    def _go_silent(self, belief: Belief, time: float) -> None:
        """Fixes stay away: train if that is due, and begin."""
        self.began = self.fix_time
        if not self.epochs or math.isnan(self.before):
            return
        if not math.isfinite(self.schedule.every):
            self._train(time)
        if self.trained is None:
            return
        anew = math.isfinite(self.shadow.interval)
        if anew:  # so it is never older than those that were learned from, in an outage as long as they
            self.shadow.restart(belief, time)
        self.course = self.model.begin([] if anew else self.epochs, self.fix)
        self.felt_before, self.before = self.felt_fix, self.fix_time

    def _speak(self, belief: Belief, time: float) -> tuple[Saying, ...]:
        assert self.trained is not None
        epoch = self._epoch(belief, time, self.shadow.x)
        self.felt_before, self.before, self.count = self._felt_now(belief), time, self.count + 1
        course = go_on(self.model, self.trained.learner.predict, self.course, epoch)
        if course is None:
            return ()
        self.course = course
        said = []
        for name, z, h in self.model.say(self.course, belief, epoch):
            r = self.trained.noise.of(name, len(z), self.heard, time - self.began, self.count)
            if r is not None and (np.abs(z) < ABSURD[name]).all():
                said.append(Saying(f"bridge_{name}", Observation(z, h, r)))
        return tuple(said)
