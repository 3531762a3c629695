"""The fold: events in, belief forward. Batch, live and sweeps all step the same navigator."""

from __future__ import annotations

import bisect
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from gapless.alignment.coarse import Aligner, Start
from gapless.events import Event, ImuBlock, Motion, Reading
from gapless.filters.adaptation.gate import Gate
from gapless.filters.update import assess, correct
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief, inject
from gapless.inertial.increments import split
from gapless.inertial.layout import ROW, Layout
from gapless.journal import Journal
from gapless.measurements.base import Constraint, Observation, Sensor
from gapless.recording import Array
from gapless.units import DEG

EPS = 1e-6
"""Times closer than this are the same instant [s]."""
GAP = 0.5
"""A longer silence of the IMU is not bridged: it ends in a new alignment [s]."""


@dataclass(frozen=True)
class Settings:
    """What a navigator is built from; everything in SI units.

    Parameters
    ----------
    layout : Layout
        Error states.
    noise : ndarray, shape (7,)
        Process noise, as `propagate` takes it.
    initial_sd : mapping of str to float or ndarray
        Standard deviation of each block at the start (position, velocity, heading come from the fix).
    initial : mapping of str to ndarray
        Starting values of additive blocks; zero where not named.
    sensors : mapping of str to Sensor
        By channel.
    constraints : mapping of str to Constraint
        By channel; copied, never changed.
    gate : Gate
        Copied.
    aligner : Aligner
        Copied.
    tick : float
        Time between constraint updates [s].
    period : float
        Time between covariance steps [s].
    row : float
        Time between journal rows [s].
    lateness : float
        How late a reading may arrive and still be put in its place [s].
    open_loop : bool
        Feed-forward: never correct the nominal state.
    """

    layout: Layout
    noise: Array
    initial_sd: Mapping[str, float | Array]
    initial: Mapping[str, Array]
    sensors: Mapping[str, Sensor]
    constraints: Mapping[str, Constraint]
    gate: Gate = field(default_factory=Gate)
    aligner: Aligner = field(default_factory=Aligner)
    tick: float = 0.1
    period: float = 0.05
    row: float = 0.1
    lateness: float = 0.0
    open_loop: bool = False


@dataclass
class _State:
    """Everything that changes, but for the journal."""

    belief: Belief
    gate: Gate
    constraints: dict[str, Constraint]
    aligner: Aligner | None
    pending: list[Reading] = field(default_factory=list)
    heard: dict[str, float] = field(default_factory=dict)
    clock: float = -math.inf
    next_row: float = -math.inf
    aligned: bool = False

    def copy(self) -> _State:
        return _State(
            self.belief.copy(),
            self.gate.copy(),
            {name: c.copy() for name, c in self.constraints.items()},
            None if self.aligner is None else self.aligner.copy(),
            list(self.pending),
            dict(self.heard),
            self.clock,
            self.next_row,
            self.aligned,
        )


class Navigator:
    """Folds time-ordered events over a belief.

    Parameters
    ----------
    settings : Settings

    Attributes
    ----------
    journal : Journal
        Rows and innovations so far.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.journal = Journal(settings.layout)
        belief = Belief(settings.layout, settings.open_loop)
        constraints = {name: c.copy() for name, c in settings.constraints.items()}
        self._state = _State(belief, settings.gate.copy(), constraints, settings.aligner.copy())
        self._past: list[tuple[_State, list[Event]]] = []
        self.dropped = 0

    @property
    def belief(self) -> Belief:
        """The present belief (not a copy)."""
        return self._state.belief

    @property
    def time(self) -> float:
        """End of the last IMU sample taken in [s]."""
        return self._state.clock

    @property
    def aligned(self) -> bool:
        """Whether there is an attitude yet."""
        return self._state.aligner is None

    def step(self, event: Event) -> None:
        """Take in one event.

        Parameters
        ----------
        event : ImuBlock or tuple of Reading
            Samples that follow the last ones, or readings in the order in which they arrive.
            A reading may hold for a time still to come, or for one past by up to
            `Settings.lateness`.
        """
        if isinstance(event, ImuBlock):
            self._remember(event)
            self._feel(event)
        elif event:
            self._hear(event)

    def snapshot(self) -> Any:
        """All that must be kept to go on from here.

        Returns
        -------
        object
            For `restore`; independent of what happens next.
        """
        past = [(state, list(events)) for state, events in self._past]
        return self._state.copy(), past, self.journal.mark(), self.dropped

    def restore(self, snapshot: Any) -> None:
        """Go back to a snapshot, journal included.

        Parameters
        ----------
        snapshot : object
            From `snapshot` of this navigator or of one with the same settings.
        """
        state, past, mark, self.dropped = snapshot
        self._state = state.copy()
        self._past = [(s, list(events)) for s, events in past]
        self.journal.rewind(mark)

    def fork(self) -> Self:
        """A cheap copy that can run ahead, with a journal of its own.

        Returns
        -------
        Navigator
        """
        new = type(self)(self.settings)
        new._state = self._state.copy()
        new._past = [(s, list(events)) for s, events in self._past]
        new.journal.after(self.journal)
        return new

    # --- readings -------------------------------------------------------------------------------

    def _hear(self, readings: tuple[Reading, ...]) -> None:
        kept = tuple(r for r in readings if r.channel in self.settings.sensors)
        if not kept:
            return
        if min(r.time for r in kept) < self._state.clock - EPS:
            self._rewind(kept)
        else:
            self._await(kept)
            if self._past:
                self._past[-1][1].append(kept)
            self._apply_due()

    def _await(self, readings: tuple[Reading, ...]) -> None:
        for reading in readings:
            bisect.insort(self._state.pending, reading, key=lambda r: r.time)

    def _remember(self, block: ImuBlock) -> None:
        """Keep what a late reading would need: the state before the block, and the block."""
        lateness = self.settings.lateness
        if lateness <= 0.0:
            return
        self._past.append((self._state.copy(), [block]))
        while len(self._past) > 1 and self._past[1][0].clock < self._state.clock - lateness:
            self._past.pop(0)

    def _rewind(self, late: tuple[Reading, ...]) -> None:
        """Go back to before a late reading, put it in its place, and replay."""
        first = min(r.time for r in late)
        k = len(self._past) - 1
        while k >= 0 and self._past[k][0].clock > first + EPS:
            k -= 1
        if k < 0:
            self.dropped += len(late)
            return
        events = [event for _, kept in self._past[k:] for event in kept]
        self._state = self._past[k][0].copy()
        del self._past[k:]
        for event in (*events, late):
            if not isinstance(event, ImuBlock):
                self._await(event)
        for event in events:
            if isinstance(event, ImuBlock):
                self._remember(event)
                self._apply_due()
                self._feel(event)
        self._apply_due()

    def _apply_due(self) -> None:
        pending, state = self._state.pending, self._state
        while pending and pending[0].time <= state.clock + EPS:
            self._apply(pending.pop(0))

    def _apply(self, reading: Reading) -> None:
        state = self._state
        for constraint in state.constraints.values():
            constraint.hear(reading)
        if state.aligner is not None:
            start = state.aligner.hear(reading, state.clock)
            if start is not None:
                self._begin(start)
            return
        observation = self.settings.sensors[reading.channel].observe(state.belief, reading)
        if self._update(reading.channel, reading.time, observation):
            state.heard[reading.channel] = reading.time

    # --- samples --------------------------------------------------------------------------------

    def _feel(self, block: ImuBlock) -> None:
        """Run through samples that may have gaps between them."""
        begin = block.time - block.dt
        cuts = [0, *(np.flatnonzero(begin[1:] - block.time[:-1] > GAP) + 1).tolist(), len(begin)]
        for first, last in zip(cuts[:-1], cuts[1:], strict=True):
            if begin[first] - self._state.clock > GAP:
                self._gap(float(begin[first]))
            self._through(block if len(cuts) == 2 else block.rows(first, last))

    def _through(self, block: ImuBlock) -> None:
        """Run through samples without gaps, stopping wherever a reading waits."""
        pending, start, n = self._state.pending, 0, len(block.time)
        while start < n:
            if not pending or pending[0].time > block.time[-1] + EPS:
                self._run(block, start, n, False)
                return
            due = pending[0].time
            end = int(np.searchsorted(block.time, due + EPS, side="right"))
            if end > start:
                self._run(block, start, end, due <= block.time[end - 1] + EPS)
                self._apply_due()
                start = end
            else:
                self._cut(block.rows(start, start + 1), due)
                start += 1

    def _cut(self, sample: ImuBlock, due: float) -> None:
        """One sample, cut where a reading waits inside it."""
        memory = self._state.belief.memory
        dt = float(sample.dt[0])
        part = dt - (float(sample.time[0]) - due)
        if part <= EPS:  # held for the instant before the sample began
            self._apply(self._state.pending.pop(0))
            self._through(sample)
            return
        before = float(memory[at.PREV_DT])
        parts = []
        for increment, i in ((sample.dtheta[0], at.PREV_THETA), (sample.dvel[0], at.PREV_VEL)):
            parts.append(split(increment, memory[i : i + 3], before, dt, part))
        head = ImuBlock(np.array([due]), np.array([part]), parts[0][None], parts[1][None])
        tail = ImuBlock(sample.time, np.array([dt - part]), sample.dtheta - parts[0], sample.dvel - parts[1])
        self._run(head, 0, 1, True)
        self._apply_due()
        self._through(tail)

    def _run(self, block: ImuBlock, first: int, last: int, due: bool) -> None:
        """Propagate samples first..last-1, ticking on the way; `due`: an observation waits there."""
        s, state = self.settings, self._state
        if state.aligner is not None:
            rows = np.column_stack([block.time, block.dt, block.dtheta, block.dvel])[first:last]
            state.clock = float(block.time[last - 1])
            state.aligner.feel(state.clock, rows)
            return
        b = state.belief
        while first < last:
            first = at.propagate(
                b.x, b.memory, s.layout.width, b.p, b.scratch, b.error, s.layout.offsets, s.noise,
                block.time, block.dt, block.dtheta, block.dvel, first, last, s.period, s.tick, due,
            )  # fmt: skip
            state.clock = float(block.time[first - 1])
            if b.memory[at.TICK_DT] >= s.tick - at.ROUND:
                self._tick()

    def _gap(self, begin: float) -> None:
        """The IMU was silent: nothing is known of the motion; what is constant is kept."""
        state = self._state
        if math.isfinite(state.clock):
            while state.pending and state.pending[0].time <= begin:
                state.pending.pop(0)
            state.belief.memory[:] = 0.0
            state.belief.memory[at.TIME] = begin
            state.aligner = self.settings.aligner.copy()
        state.clock = begin

    def _tick(self) -> None:
        state, m = self._state, self._state.belief.memory
        dt = float(m[at.TICK_DT])
        motion = Motion(state.clock, dt, m[at.TICK_W : at.TICK_W + 3] / dt, m[at.TICK_F : at.TICK_F + 3] / dt)
        m[at.TICK_DT :] = 0.0
        for name, constraint in state.constraints.items():
            observation = constraint.tick(state.belief, motion)
            if observation is not None and self._update(name, motion.time, observation):
                state.heard[name] = motion.time
        if state.clock >= state.next_row - EPS:
            state.next_row = max(state.next_row + self.settings.row, state.clock + 0.5 * self.settings.row)
            self.journal.row(state.clock, state.belief, self._source())

    def _source(self) -> str:
        heard, now = self._state.heard, self._state.clock
        if now - max(heard.get("position", -math.inf), heard.get("velocity", -math.inf)) < 1.6:
            return "gnss"
        if any(now - heard.get(name, -math.inf) < 1.0 for name in (*self._state.constraints, "odometer")):
            return "constraints"
        return "ins"

    # --- belief ---------------------------------------------------------------------------------

    def _begin(self, start: Start) -> None:
        """Take over an initial state; blocks that an earlier alignment left are kept."""
        state, s = self._state, self.settings
        b = state.belief
        b.x[:3], b.x[3:6], b.x[6:10] = start.lla, start.v_n, start.q_nb
        first = not state.aligned
        if first:
            for name, value in s.initial.items():
                b.block(name)[:] = value
            for name in s.layout.blocks:
                b.set_sd(name, s.initial_sd.get(name, 0.0))
            if start.gyro_bias is not None:
                b.block("gyro_bias")[:] = start.gyro_bias
                b.set_sd("gyro_bias", np.minimum(s.initial_sd["gyro_bias"], 0.1 * DEG))
        b.set_sd("position", 2.0 * start.sd_position + 1.0)
        b.set_sd("velocity", start.sd_velocity + 0.5)
        b.set_sd("attitude", np.array([1.0, 1.0, 0.0]) * s.initial_sd["attitude"])
        self._heading_sd(start)
        b.memory[:] = 0.0
        b.memory[at.TIME] = state.clock
        state.aligner, state.aligned = None, True
        state.next_row = max(state.next_row, state.clock)
        self.journal.align(state.clock, start.evidence)

    def _heading_sd(self, start: Start) -> None:
        """The box's heading is the course less the mounting yaw, and shares its error."""
        b = self._state.belief
        p = b.p.reshape(ROW, ROW)
        p[8, 8] = start.sd_heading**2
        if "mounting" in b.layout:
            yaw = b.layout.blocks["mounting"].start + 1
            p[8, 8] += p[yaw, yaw]
            p[8, yaw] = p[yaw, 8] = -p[yaw, yaw]

    def _update(self, channel: str, time: float, o: Observation) -> bool:
        """Gate, adapt, correct; False where the observation was rejected."""
        state, n = self._state, self.settings.layout.n
        b = state.belief
        z = o.z - o.H @ b.error[:n] if b.error.size else o.z
        nis, s = assess(b.p, ROW, n, z, o.H, o.R)
        verdict = state.gate.judge(channel, time, z, nis, o.R)
        self.journal.innovation(channel, time, z, s, nis, verdict.factor)
        if verdict.widen:
            b.widen(o.H, z)
        if math.isinf(verdict.factor):
            return False
        r = o.R if verdict.factor == 1.0 else o.R * verdict.factor
        dx = correct(b.p, ROW, n, z, o.H, r, 1.0)
        if b.error.size:
            b.error[:n] += dx
        else:
            inject(b.x, dx)
        return True
