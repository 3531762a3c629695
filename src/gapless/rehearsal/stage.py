"""The stage: a navigator that rehearses outages in its own past, and adopts what came best out of them.

Every `every` seconds a copy of the navigator is kept. When `length` seconds have passed and GNSS spoke
all along, copies of the copy go through them without it, each in another manner, and are held
against the track that the navigator found with it. All happens at fixed times of the data, counted in
samples: the same log gives the same bits in a batch, live and after an interruption.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Self

import numpy as np

from gapless.fold.journal import Journal
from gapless.fold.manner import Manner
from gapless.fold.navigator import Navigator
from gapless.fold.settings import Settings
from gapless.rehearsal.judge import Choice, Rehearsed, choose
from gapless.rehearsal.replay import Attempt, Replay
from gapless.rehearsal.shown import shown
from gapless.rehearsal.stretch import Stretch
from gapless.trip.events import Event, ImuBlock
from gapless.trip.exhibits import Rehearsals
from gapless.trip.solution import Decision

SETTLE: Final = 45.0
"""After its alignment a navigator is left alone for so long [s]: bridges have something to say by then."""
RESERVE: Final = 8
"""Candidates that may be tried on credit, so that there is a choice early in a drive."""
PONDER: Final = 5.0
"""A rehearsal is replayed and adopted within so many seconds after its end, a slice with each sample [s]."""
SLOW: Final = 1.5
"""An outage through which the car mostly stood tells nothing of what would bridge one: mean speed [m/s]."""


@dataclass(frozen=True)
class Plan:
    """What is rehearsed, and how much.

    Parameters
    ----------
    bridges : mapping of str to tuple of int
        Candidates: which of the navigator's bridges may speak.
    presets : mapping of str to Manner
        Other tunings of the filter.
    every, length : float
        A rehearsal begins so often, and lasts so long [s].
    budget : float
        Samples that may be replayed for each sample that comes in, besides `RESERVE`.
    """

    bridges: Mapping[str, tuple[int, ...]]
    presets: Mapping[str, Manner] = field(default_factory=dict)
    every: float = 20.0
    length: float = 60.0
    budget: float = 0.4


class Rehearsing:
    """A navigator that rehearses; it is stepped, kept and forked like one.

    Parameters
    ----------
    navigator : Navigator
    plan : Plan
    """

    def __init__(self, navigator: Navigator, plan: Plan) -> None:
        self.navigator, self.plan = navigator, plan
        self.open: list[Stretch] = []
        self.work: list[Replay] = []
        self.history: tuple[Rehearsed, ...] = ()
        self.choice = choose((), plan.bridges, plan.presets)
        self.chosen: tuple[tuple[float, Choice], ...] = ()
        self.due = math.inf
        self.credit, self.seen = 0.0, 0
        self._adopt()

    @property
    def settings(self) -> Settings:
        """Those of the navigator."""
        return self.navigator.settings

    def trust(self, settings: Settings) -> None:
        """Go on with what was found of the receiver's stamps meanwhile; see `Navigator.trust`.

        Parameters
        ----------
        settings : Settings
        """
        self.navigator.trust(settings)

    @property
    def journal(self) -> Journal:
        """Rows and innovations so far."""
        return self.navigator.journal

    @property
    def time(self) -> float:
        """End of the last IMU sample taken in [s]."""
        return self.navigator.time

    @property
    def bridges(self) -> list[Any]:
        """The navigator's bridges as they are now."""
        return list(self.navigator.bridges)

    @property
    def manner(self) -> Manner:
        """How the next outage is met."""
        return self._manner(self.choice.bridge, self.choice.preset, self.choice.scale)

    def step(self, event: Event) -> None:
        """Take in one event; see `Navigator.step`.

        Parameters
        ----------
        event : ImuBlock or tuple of Reading
        """
        if not isinstance(event, ImuBlock):
            self.navigator.step(event)
            self._keep(tuple(r for r in event if r.channel == "odometer"))
            return
        if self.due == math.inf and self.journal.alignments:
            self.due = self.journal.alignments[0][0] + SETTLE
        first, n = 0, len(event.time)
        while first < n:
            end = first + int(np.searchsorted(event.time[first:], self._next(), side="right"))
            if end > first:
                part = event.rows(first, end)
                self.navigator.step(part)
                self._keep(part)
                self._watch()
                self._replay(float(part.time[-1]))
                self.credit += self.plan.budget * (end - first)
                first = end
            else:
                self._act()

    def snapshot(self) -> Any:
        """All that must be kept to go on from here.

        Returns
        -------
        object
        """
        opened = [o.copy() for o in self.open]
        told = self.history, self.choice, self.chosen
        return self.navigator.snapshot(), opened, self._begun(), told, self.due, self.credit

    def restore(self, snapshot: Any) -> None:
        """Go back to a snapshot.

        Parameters
        ----------
        snapshot : object
        """
        kept, opened, begun, told, self.due, self.credit = snapshot
        self.history, self.choice, self.chosen = told
        self.navigator.restore(kept)
        self.seen = len(self.journal.times)
        self.open = [o.copy() for o in opened]
        self.work = [replay.copy() for replay in begun]

    def fork(self) -> Self:
        """A cheap copy that can run ahead, with a journal of its own.

        Returns
        -------
        Rehearsing
        """
        new = object.__new__(type(self))
        new.__dict__.update(self.__dict__)
        new.navigator = self.navigator.fork()
        new.open, new.work, new.seen = [o.copy() for o in self.open], self._begun(), 0
        return new

    def decisions(self, start: float) -> tuple[Decision, ...]:
        """What was rehearsed, what came of it, and what is chosen now.

        Parameters
        ----------
        start : float
            Time of the first IMU sample [s].

        Returns
        -------
        tuple of Decision
        """
        c, n = self.choice, len(self.history)
        asked = f"{n} outages of {self.plan.length:g} s rehearsed in the good past"
        since = f"; since {self.chosen[-1][0] - start:.1f} s" if self.chosen else ""
        who = Decision("bridge chosen", c.bridge or "nobody", "", "data", asked + since)
        how = Decision("tuning chosen", c.preset or "the recipe's own", "", "data", asked)
        sure = Decision("stated covariance in silence", round(c.scale, 2), "times", "data", asked)
        told = (
            Decision(f"rehearsed, {s.name}", "better" if s.earned else "not better", "", "data", s.text)
            for s in (*c.bridges, *c.presets)
        )
        return (who, *([how] if c.presets else []), sure, *told)

    def exhibit(self) -> Rehearsals:
        """What was rehearsed, for the report.

        Returns
        -------
        Rehearsals
        """
        return shown(self.history, self.plan.bridges, self.plan.presets, self.plan.length)

    # --- acting ---------------------------------------------------------------------------------

    def _next(self) -> float:
        ends = [one.start + self.plan.length for one in self.open]
        return min(self.due, *ends, *(replay.end + PONDER for replay in self.work), math.inf)

    def _begun(self) -> list[Replay]:
        return [replay.copy() for replay in self.work]

    def _keep(self, event: Event) -> None:
        if event:
            for one in self.open:
                one.events.append(event)

    def _watch(self) -> None:
        """Note the rows that were written: where the navigator was, and whether GNSS held it."""
        rows = self.journal
        if self.open and self.seen < len(rows.times):
            for one in self.open:
                one.watch(rows, self.seen)
        self.seen = len(rows.times)

    def _act(self) -> None:
        """Do what is due before the next sample."""
        now = self._next()
        if self.work and self.work[0].end + PONDER <= now:
            self._conclude(self.work.pop(0))
            return
        if self.open and self.open[0].start + self.plan.length <= now:
            self._consider(self.open.pop(0), now)
            return
        self.due = now + self.plan.every
        if self.navigator.aided:
            self.open.append(Stretch(now, self.navigator.fork()))

    def _consider(self, one: Stretch, end: float) -> None:
        """Have a stretch replayed in every manner that the budget allows, where it can tell anything."""
        if not one.aided or len(one.track) < 10 or one.way < SLOW * self.plan.length:
            return
        cost = one.samples
        if not self.history and not self.work:
            self.credit = max(self.credit, RESERVE * cost)
        least = 1 + len(self.plan.bridges)
        if self.credit < cost * least:
            return
        tried = self._order()[: int(self.credit / cost)]
        self.credit -= cost * len(tried)
        self.work.append(Replay(one, [Attempt(b, p, self._manner(b, p, 1.0)) for b, p in tried], end))

    def _replay(self, now: float) -> None:
        """A slice of what is to be replayed; whatever is ready before its time waits for it."""
        for replay in self.work:
            replay.advance(min(1.0, (now - replay.end) / PONDER))

    def _conclude(self, replay: Replay) -> None:
        """Adopt what comes of a rehearsal."""
        self.history = (*self.history, replay.finish())
        choice = choose(self.history, self.plan.bridges, self.plan.presets)
        if choice[:2] != self.choice[:2]:
            self.chosen = (*self.chosen, (replay.end + PONDER, choice))
        self.choice = choice
        self._adopt()

    def _order(self) -> list[tuple[str, str]]:
        """Nobody first, then the bridges, then tunings of the chosen one, the least tried first."""
        tried = dict.fromkeys(self.plan.presets, 0)
        for trial in (t for one in self.history for t in one.trials if t.preset):
            tried[trial.preset] += 1
        presets = sorted(tried, key=tried.__getitem__)
        return [("", ""), *((b, "") for b in self.plan.bridges), *((self.choice.bridge, p) for p in presets)]

    def _adopt(self) -> None:
        self.navigator.adopt(self.manner)

    def _manner(self, bridge: str, preset: str, scale: float) -> Manner:
        tuned = self.plan.presets[preset] if preset else self.settings.manner
        return replace(tuned, voices=self.plan.bridges.get(bridge, ()), scale=scale)
