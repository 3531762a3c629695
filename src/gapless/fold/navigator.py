"""The fold: events in, belief forward. Batch, live and sweeps all step the same navigator."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any, Self

import numpy as np

from gapless.bridges.base import Bridge
from gapless.filters.consider import Wander
from gapless.filters.stamp_doubt import StampDoubt
from gapless.fold.assimilate import assimilate
from gapless.fold.begin import begin
from gapless.fold.box import before_box, in_box, watch
from gapless.fold.holes import gap
from gapless.fold.journal import Journal
from gapless.fold.manner import Manner
from gapless.fold.observed import observed
from gapless.fold.past import Past, sorted_out
from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.fold.stated import beside
from gapless.fold.tape import Tape
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief, inject
from gapless.inertial.cubature import propagate_points
from gapless.inertial.lately import Filling
from gapless.inertial.pieces import parted, pieces, without_holes
from gapless.inertial.unseen import stray, tilt
from gapless.measurements.base import Observation
from gapless.trip.events import EPS, GAP, Event, ImuBlock, Motion, Reading
from gapless.trip.recording import Array
from gapless.witnesses.hearing import FoundOut, Hearing

__all__ = ["Navigator", "Settings"]


def load_kernels() -> None:
    """Do now what the first kernel called would wait for: a fifth of a second, once a process."""
    inject(np.array([0.0] * 6 + [1.0] + [0.0] * 9), np.zeros(15))


class Navigator:
    """Folds time-ordered events over a belief.

    Parameters
    ----------
    settings : Settings

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

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.journal = Journal(settings.layout, settings.misalignment)
        belief = Belief(settings.layout, settings.open_loop, settings.trail)
        constraints = {name: c.copy() for name, c in settings.constraints.items()}
        bridges = [bridge.copy() for bridge in settings.bridges]
        wander = Wander(settings.wander_time)
        rules = {kind: rule.copy() for kind, rule in settings.adaptation.items()}
        aligner = settings.aligner.copy()
        manner = settings.manner
        hearing = Hearing(np.zeros(settings.layout.n))
        self._state = State(
            belief, rules, constraints, bridges, aligner, wander, StampDoubt(), manner.noise, manner, hearing
        )
        self._past = Past(settings.lateness, settings.memory)
        self._propagate = propagate_points if settings.cubature else at.propagate
        self.dropped = 0
        self.tape: Tape | None = None
        self.keeps_learning = True

    @property
    def belief(self) -> Belief:
        """The present belief (not a copy)."""
        return self._state.belief

    @property
    def bridges(self) -> list[Bridge]:
        """The bridges as they are now (not copies)."""
        return self._state.bridges

    @property
    def time(self) -> float:
        """End of the last IMU sample taken in [s]."""
        return self._state.clock

    @property
    def aligned(self) -> bool:
        """Whether there is an attitude yet."""
        return self._state.aligned

    @property
    def aided(self) -> bool:
        """Whether GNSS speaks."""
        return self.aligned and self._state.source == "gnss"

    def adopt(self, manner: Manner) -> None:
        """Go on in another manner; what was estimated and learned stays.

        Parameters
        ----------
        manner : Manner
        """
        state = self._state
        state.manner, state.noise = manner, manner.noise
        for name, like in manner.constraints.items():
            state.constraints[name] = state.constraints[name].tuned(like)

    def trust(self, settings: Settings) -> None:
        """Go on with what was found of the receiver's stamps meanwhile.

        Parameters
        ----------
        settings : Settings
            Of these, how uneven stamps are and what is not known of their clock.
        """
        heard = {
            name: settings.sensors[name] for name in ("position", "velocity") if name in settings.sensors
        }
        sensors = {**self.settings.sensors, **heard}
        self.settings = replace(self.settings, sensors=sensors, doubt=settings.doubt)

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
            self._through(list(self._past.parts(event)))
        elif event:
            self._hear(event)

    def snapshot(self) -> Any:
        """All that must be kept to go on from here.

        Returns
        -------
        object
            For `restore`; independent of what happens next.
        """
        return self._state.copy(), self._past.copy(), self.journal.mark(), self.dropped

    def restore(self, snapshot: Any) -> None:
        """Go back to a snapshot, journal included.

        Parameters
        ----------
        snapshot : object
            From `snapshot` of this navigator or of one with the same settings.
        """
        state, past, mark, self.dropped = snapshot
        self._state = state.copy()
        self._past = past.copy()
        self.journal.rewind(mark)

    def fork(self) -> Self:
        """A cheap copy that can run ahead, with a journal of its own.

        Returns
        -------
        Navigator
        """
        new = type(self)(self.settings)
        new._state = self._state.copy()
        new._past = self._past.copy()
        new.journal.after(self.journal)
        return new

    # --- readings -------------------------------------------------------------------------------

    def _hear(self, readings: tuple[Reading, ...]) -> None:
        kept = tuple(r for r in readings if r.channel in self.settings.sensors)
        if not kept:
            return
        if min(r.time for r in kept) <= self._state.clock + EPS and self.time > -math.inf:
            self._rewind(kept)
        else:
            self._state.expect(kept)
            self._past.heard(kept)

    def _rewind(self, late: tuple[Reading, ...]) -> None:
        """Go back to before a late reading, put it in its place, and replay."""
        found = self._past.rewind(min(r.time for r in late) - EPS)
        if found is None:
            self.dropped += len(late)
            return
        kept, fed = found
        self._return_to(kept)
        self._through(*sorted_out(fed, late), kept)

    def _return_to(self, kept: State) -> None:
        manner = self._state.manner
        self._state = kept.copy()
        if kept.manner is not manner:
            self.adopt(manner)

    def _through(
        self, blocks: list[ImuBlock], readings: tuple[Reading, ...] = (), kept: State | None = None
    ) -> None:
        """Run through blocks; anew from before a lie, where one is found out on the way.

        `kept` is the present state, where the past is to have it as it was.
        """
        self._state.expect(readings)
        while blocks:
            block = blocks.pop(0)
            self._past.before(kept or self._state.copy(), block)
            kept = None
            try:
                self._feel(block)
            except FoundOut as lie:
                shared, fed = self._past.back(lie.since)
                kept = shared.copy()  # forks and snapshots may have it, and know of no lie
                kept.hearing.disown(lie)
                again, readings = sorted_out(fed, readings)
                blocks = again + blocks
                self._return_to(kept)
                self._state.expect(readings)
        self._past.heard(readings)

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
                begin(start, state, self.settings, self.journal, self.tape)
            if start is not None or not state.aligned:
                return
        observation = observed(state, self.settings, reading)
        state.face(observation)
        used = self._update(reading.channel, reading.time, observation, reading)
        if state.hearing.lie is not None and self.settings.memory:
            raise state.hearing.lie
        if used:
            state.heard[reading.channel] = reading.time
        for bridge in state.bridges:
            if state.misled:
                bridge.lost()
            else:
                bridge.hear(state.belief, reading, used)

    # --- samples --------------------------------------------------------------------------------

    def _feel(self, block: ImuBlock) -> None:
        """Run through samples, bridging holes between them and stopping wherever a reading waits."""
        state = self._state
        for stretch in without_holes(block):
            silent = parted(state.clock, stretch)
            if silent > GAP:
                gap(state, self.settings, self.tape, float(stretch.time[0] - stretch.dt[0]))
            elif silent:
                self._bridge(state.lately.across(state.clock, stretch.rows(0, 1)))
            self._go(stretch)
            state.lately.feel(stretch)

    def _bridge(self, filling: Filling) -> None:
        """Go through a hole by what was felt on both sides; what listens to samples is told of it."""
        for constraint in self._state.constraints.values():
            constraint.lost()
        self._state.guessed = True
        self._go(filling.block, filling.doubt)
        tilt(self._state.belief, filling.tilt)

    def _go(self, stretch: ImuBlock, doubt: Array | None = None) -> None:
        """Run through samples without a hole; `doubt` of those that are guessed."""
        for piece in pieces(stretch, self._state.pending, partial(before_box, self._state)):
            if piece.last > piece.first:
                self._run(*piece, doubt)
            if piece.due:
                self._apply_due()

    def _run(self, block: ImuBlock, first: int, last: int, due: bool, doubt: Array | None) -> None:
        """Propagate samples first..last-1, ticking on the way; `due`: an observation waits there."""
        s, state = self.settings, self._state
        raw, box = block, state.box
        block = in_box(raw, box)
        if not state.aligned:
            self._told(block, first, last, doubt)
            state.clock = float(block.time[last - 1])
            return
        b, often = state.belief, s.row < s.tick
        if state.fade > 1.0:  # the epoch is over
            b.fade(state.fade, s.ceiling)
            state.fade = 1.0
        while first < last:
            end = self._next_row(block, first, last) if often else last
            flush, begin = due and end == last, first
            first = self._propagate(
                b.x, b.memory, s.layout.width, b.p, b.scratch, b.error, s.layout.offsets, state.noise,
                block.time, block.dt, block.dtheta, block.dvel, first, end, s.period, s.tick, flush,
            )  # fmt: skip
            before, state.clock = state.clock, float(block.time[first - 1])
            self._told(block, begin, first, doubt)
            if doubt is not None:
                stray(b, doubt, state.clock - before)
            if self.tape is not None and b.memory[at.COV_DT] == 0.0:
                self.tape.stepped(b)
            ticked = b.memory[at.TICK_DT] >= s.tick - at.ROUND
            if ticked or (due and first == last):  # never at a block's end: blocks change no bits
                b.trail.mark(state.clock, b.v_n)
            if ticked:
                self._tick()
                if state.box is not box:
                    box = state.box
                    block = in_box(raw, box)
                state.guessed = doubt is not None
            elif often:
                self._row()

    def _told(self, block: ImuBlock, first: int, last: int, doubt: Array | None) -> None:
        """Samples for who listens to them: no more than were propagated, for a tick may turn the box."""
        state = self._state
        if state.aligner is None and not state.bridges:
            return
        felt = block.rows(first, last)
        if state.aligner is not None:
            rows = np.column_stack([felt.time, felt.dt, felt.dtheta, felt.dvel])
            state.aligner.feel(float(felt.time[-1]), rows)
        if state.aligned and doubt is None:
            for bridge in state.bridges:
                bridge.feel(felt)

    def _next_row(self, block: ImuBlock, first: int, last: int) -> int:
        """Sample after which a row is due, where rows come more often than ticks."""
        rows = block.time[first:last]
        return min(last, first + int(np.searchsorted(rows, self._state.next_row - EPS)) + 1)

    def _tick(self) -> None:
        state, m = self._state, self._state.belief.memory
        dt = float(m[at.TICK_DT])
        motion = Motion(state.clock, dt, m[at.TICK_W :] / dt)
        m[at.TICK_DT :] = 0.0
        watch(state, self.settings, self.journal, motion)
        for name, constraint in state.constraints.items():
            if state.guessed and constraint.needs_samples:
                continue
            observation = constraint.tick(state.belief, motion)
            if observation is None or (constraint.needs_heading and not state.headed):
                continue
            if self._update(name, motion.time, observation):
                state.heard[name] = motion.time
        for k, bridge in enumerate(state.bridges):
            heeded = k in state.manner.voices
            if heeded or self.keeps_learning:
                for channel, said in bridge.tick(state.belief, motion):
                    if heeded:
                        state.face(said)
                        if self._update(channel, motion.time, said):
                            state.heard["bridge"] = motion.time
        self._row()

    def _row(self) -> None:
        """Write a row where one is due; it changes nothing of the belief."""
        state, often = self._state, self.settings.row
        if state.clock >= state.next_row - EPS:
            state.next_row = max(state.next_row + often, state.clock + 0.5 * often)
            row = state.clock, state.stated, beside(state, self.settings), state.source
            self.journal.row(*row)
            if self.tape is not None:
                self.tape.row(*row)

    def _update(self, channel: str, time: float, o: Observation, reading: Reading | None = None) -> bool:
        return assimilate(self._state, self.settings, channel, time, o, self.journal, self.tape, reading)
