"""Samples through a belief, and what is due on ticks: constraints, bridges, a row of the journal."""

from __future__ import annotations

import math

import numpy as np

from gapless.assimilate import assimilate
from gapless.bridges.base import Bridge, due_of
from gapless.events import EPS, ImuBlock, Motion
from gapless.filters.adaptation.gate import Gate
from gapless.filters.adaptation.relock import soft_bound
from gapless.inertial import propagate as at
from gapless.inertial.cubature import propagate_points
from gapless.journal import Journal
from gapless.measurements import coast as on
from gapless.measurements.base import Observation
from gapless.measurements.nonholonomic import NonHolonomic
from gapless.measurements.stillness import Stillness
from gapless.recording import Array
from gapless.settings import Settings
from gapless.state import State
from gapless.tape import Tape

COMPILED = {"zero_velocity": Stillness, "nonholonomic": NonHolonomic}
"""Constraints that `coast` knows, in the order in which it asks them."""
BOUNDS = np.array([soft_bound(6), soft_bound(2)])
"""What does not surprise a gate, by their dimensions."""
NONE = np.zeros(0)
MOST = 1024
"""Ticks in one call of it."""


class Ticking:
    """Runs a state through samples.

    Parameters
    ----------
    settings : Settings
    state : State

    Attributes
    ----------
    journal : Journal
        Rows and innovations so far.
    tape : Tape or None
        Where a smoother listens; no part of a snapshot.
    keeps_learning : bool
        Whether bridges that are not listened to are asked all the same, and so go on learning; a copy
        that runs ahead and is thrown away saves their time.
    """

    def __init__(self, settings: Settings, state: State) -> None:
        self.settings = settings
        self.journal = Journal(settings.layout, settings.misalignment)
        self.tape: Tape | None = None
        self.keeps_learning = True
        self._state = state
        self._propagate = propagate_points if settings.cubature else at.propagate
        self._compiled = _compiled(settings)

    def _run(self, block: ImuBlock, first: int, last: int, due: bool) -> None:
        """Propagate samples first..last-1, ticking on the way; `due`: an observation waits there."""
        state = self._state
        if state.aligner is not None:
            rows = np.column_stack([block.time, block.dt, block.dtheta, block.dvel])[first:last]
            state.aligner.feel(float(block.time[last - 1]), rows)
        if not state.aligned:
            state.clock = float(block.time[last - 1])
            return
        if state.bridges and last > first:
            felt = block.rows(first, last)
            for bridge in state.bridges:
                bridge.feel(felt)
        if state.fade > 1.0:  # the epoch is over
            state.belief.fade(state.fade, self.settings.ceiling)
            state.fade = 1.0
        if self._compiled and self.tape is None and state.aligner is None:
            while first < last:
                first = self._coast(block, first, last, due)
        else:
            self._walk(block, first, last, due)

    # --- tick by tick ---------------------------------------------------------------------------

    def _walk(self, block: ImuBlock, first: int, last: int, due: bool) -> None:
        """From tick to tick, with any parts."""
        s, state, b = self.settings, self._state, self._state.belief
        often = s.row < s.tick
        while first < last:
            end = self._next_row(block, first, last) if often else last
            flush = due and end == last
            first = self._propagate(
                b.x, b.memory, s.layout.width, b.p, b.scratch, b.error, s.layout.offsets, state.noise,
                block.time, block.dt, block.dtheta, block.dvel, first, end, s.period, s.tick, flush,
            )  # fmt: skip
            state.clock = float(block.time[first - 1])
            if self.tape is not None and b.memory[at.COV_DT] == 0.0:
                self.tape.stepped(b)
            ticked = b.memory[at.TICK_DT] >= s.tick - at.ROUND
            if ticked or (due and first == last):  # never at a block's end: blocks change no bits
                b.trail.mark(state.clock, b.v_n)
            if ticked:
                dt = float(b.memory[at.TICK_DT])
                motion = Motion(state.clock, dt, b.memory[at.TICK_W :] / dt)
                b.memory[at.TICK_DT :] = 0.0
                self._tick(motion)
            elif often:
                self._row()

    def _next_row(self, block: ImuBlock, first: int, last: int) -> int:
        """Sample after which a row is due, where rows come more often than ticks."""
        rows = block.time[first:last]
        return min(last, first + int(np.searchsorted(rows, self._state.next_row - EPS)) + 1)

    def _tick(self, motion: Motion, asked: int = 0) -> None:
        """What is due on a tick; so many of the constraints were asked already."""
        state = self._state
        for name, constraint in list(state.constraints.items())[asked:]:
            observation = constraint.tick(state.belief, motion)
            if observation is None or (state.aligner is not None and constraint.needs_heading):
                continue
            if self._update(name, motion.time, observation):
                state.heard[name] = motion.time
        for k, bridge in self._told():
            for channel, said in bridge.tick(state.belief, motion):
                if k in state.manner.voices and self._update(channel, motion.time, said):
                    state.heard["bridge"] = motion.time
        self._row()

    def _told(self) -> list[tuple[int, Bridge]]:
        """Bridges that are told of ticks."""
        state, all_of_them = self._state, self.keeps_learning
        return [(k, b) for k, b in enumerate(state.bridges) if all_of_them or k in state.manner.voices]

    def _row(self) -> None:
        """Write a row where one is due; it changes nothing of the belief."""
        state, often = self._state, self.settings.row
        if state.clock >= state.next_row - EPS:
            state.next_row = max(state.next_row + often, state.clock + 0.5 * often)
            source, shared = self._source(), state.wander.response
            if source != "gnss" and state.manner.scale != 1.0:
                shared = shared + (state.manner.scale - 1.0) * state.belief.P[:3, :3]
            row = state.clock, state.belief, shared, source
            self.journal.row(*row)
            if self.tape is not None:
                self.tape.row(*row)

    def _source(self) -> str:
        gnss, bridge, others = self._heard()
        now = self._state.clock
        if now - gnss < 1.6:
            return "gnss"
        if now - bridge < 1.6:
            return "bridge"
        return "constraints" if now - others < 1.0 else "ins"

    def _heard(self) -> tuple[float, float, float]:
        """When a fix, a bridge, a constraint or an odometer was used last."""
        heard, never = self._state.heard.get, -math.inf
        gnss = max(heard("position", never), heard("velocity", never))
        held = [heard(name, never) for name in self._state.constraints]
        return gnss, heard("bridge", never), max([heard("odometer", never), *held])

    def _update(self, channel: str, time: float, o: Observation) -> bool:
        return assimilate(self._state, self.settings, channel, time, o, self.journal, self.tape)

    # --- many ticks at once ---------------------------------------------------------------------

    def _coast(self, block: ImuBlock, first: int, last: int, due: bool) -> int:
        """Run until samples are used up or something is due that is not compiled; the next sample."""
        s, state, journal = self.settings, self._state, self.journal
        b, trail, n = state.belief, state.belief.trail, s.layout.n
        still, slips = state.constraints.get("zero_velocity"), state.constraints.get("nonholonomic")
        assert still is None or isinstance(still, Stillness)
        assert slips is None or isinstance(slips, NonHolonomic)
        heard = np.array([*self._heard(), -math.inf, -math.inf])
        row = np.array([state.next_row, journal.last, s.row, state.manner.scale])
        ticks = min(MOST, int((block.time[last - 1] - block.time[first]) / s.tick) + 2)
        rows, found = np.empty((ticks, on.STATE + n + 1 + journal.kept.size)), np.empty((2, ticks, 44))
        latest = np.array([journal.latest.get(name, -math.inf) for name in COMPILED])
        motion, count = np.empty(8), np.empty(5, np.int64)
        told = min((due_of(bridge) for _, bridge in self._told()), default=math.inf)
        following = on.coast(
            b.x, b.memory, s.layout.width, n, b.p, b.scratch, b.error, s.layout.offsets, state.noise,
            block.time, block.dt, block.dtheta, block.dvel, first, last, s.period, s.tick, due,
            trail.store, trail.ends, trail.length, trail.corrected,
            NONE if still is None else still.tuning, NONE if still is None else still.memory,
            NONE if slips is None else slips.tuning, NONE if slips is None else slips.memory,
            BOUNDS, latest, told, heard, row, state.wander.response, journal.kept, rows, found, motion, count,
        )  # fmt: skip
        state.clock = float(block.time[following - 1])
        state.next_row = float(row[on.NEXT])
        _, written, *updates, why = count.tolist()
        journal.rows(rows[:written])
        for which, name in enumerate(COMPILED):
            self._passed(name, float(heard[on.OWN + which]), found[which, : updates[which]])
        if why == on.ROOM:
            trail.grow()
        elif why != on.ALL_RUN:
            self._finish(Motion(float(motion[0]), float(motion[1]), motion[2:]), why)
        return int(following)

    def _passed(self, name: str, time: float, found: Array) -> None:
        """Note what did not surprise, the last of it at a time."""
        if time > -math.inf:
            rule = self._state.adaptation["constraints"]
            assert isinstance(rule, Gate)
            rule.passed(name, time)
            self._state.heard[name] = time
            self.journal.passed(name, found)

    def _finish(self, motion: Motion, why: int) -> None:
        """The rest of a tick that `coast` did not finish."""
        state, names = self._state, list(self._state.constraints)
        if why == on.BRIDGES:
            self._tick(motion, len(names))
            return
        name = tuple(COMPILED)[why - on.SURPRISE]
        constraint = state.constraints[name]
        assert isinstance(constraint, Stillness | NonHolonomic)
        if self._update(name, motion.time, constraint.observe(state.belief, motion)):
            state.heard[name] = motion.time
        self._tick(motion, names.index(name) + 1)


def _compiled(s: Settings) -> bool:
    """Whether all parts that are asked on ticks are those that `coast` knows."""
    names = list(s.constraints)
    known = names == [name for name in COMPILED if name in names] and all(
        type(s.constraints[name]) is COMPILED[name] for name in names
    )
    plain = not s.open_loop and not s.cubature and s.row >= s.tick
    return known and plain and isinstance(s.adaptation["constraints"], Gate)
