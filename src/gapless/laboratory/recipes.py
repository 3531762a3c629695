"""A recipe on the bench: runs with forks, for either protocol and for the check of the prefix law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final

import numpy as np

from gapless.fold.feed import events
from gapless.laboratory.methods import Function, Run
from gapless.laboratory.prefix import Peek, first_difference, from_the_start, known_at, samples, spoil
from gapless.runs.decide import DECISIONS_TAKEN_LATE, Decided, decide_before
from gapless.runs.forks import piece, run_with_forks
from gapless.runs.fuse import fold
from gapless.runs.prepare import prepared, withhold_from
from gapless.runs.smooth import smooth
from gapless.scenarios import Outage
from gapless.systems.build import stamps
from gapless.systems.denoising import sees_the_future
from gapless.systems.recipe import System
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

RATE: Final = 10.0
"""Rows of a solution per second."""


@dataclass(frozen=True)
class Recipe:
    """A system as `fuse` runs it, with its decisions taken before the first outage.

    Parameters
    ----------
    system : System
    """

    system: System
    _known: dict[object, Decided] = field(default_factory=dict, compare=False, repr=False)

    _looked_at: set[tuple[int, bool]] = field(default_factory=set, compare=False, repr=False)

    @property
    def name(self) -> str:
        """What tables call it."""
        return self.system.name

    @property
    def causal(self) -> bool:
        """Whether no row knows of anything logged later: a recipe may denoise whole records."""
        return not sees_the_future(self.system)

    @property
    def description(self) -> str:
        """One line."""
        return self.system.description

    def passes(self, recording: Recording, outages: tuple[Outage, ...]) -> Run:
        """See `Method`.

        Parameters
        ----------
        recording : Recording
        outages : tuple of Outage

        Returns
        -------
        Run
        """
        recording = prepared(recording, self.system)
        decided = self._decided(recording, outages)
        solution, forks = run_with_forks(recording, self.system, outages, outages, decided, RATE)
        return Run(solution, outages, forks=forks)

    def isolated(self, recording: Recording, outages: tuple[Outage, ...]) -> Run:
        """See `Method`.

        Parameters
        ----------
        recording : Recording
        outages : tuple of Outage

        Returns
        -------
        Run
        """
        recording = prepared(recording, self.system)
        decided = self._decided(recording, outages)
        whole, forks = run_with_forks(recording, self.system, (), outages, decided, RATE)
        pieces = tuple((f.outage, piece(f, recording, whole, self.system, decided)) for f in forks)
        return Run(whole, outages, pieces, forks)

    def peek(
        self, recording: Recording, outages: Sequence[Outage], run: Run, rng: np.random.Generator
    ) -> Peek | None:
        """See `Method`: from each fork on, sample by sample, with nothing there but what was logged before.

        What comes before the forks, decisions and denoising among it, is looked at in one run from the
        start, cut at a sample of the first outage; once for all plans with the same decisions.

        Parameters
        ----------
        recording : Recording
        outages : sequence of Outage
        run : Run
        rng : numpy.random.Generator

        Returns
        -------
        Peek or None
        """
        every, known, raw = run.planned, dict(run.pieces), recording
        recording = prepared(recording, self.system)
        decided = self._decided(recording, every)
        late, way = stamps(self.system, decided.offsets), (id(decided), bool(known))
        for fork in (f for f in run.forks if f.outage in outages):
            gone = (fork.outage,) if known else every
            rows = known.get(fork.outage, run.solution.trajectory)
            times = samples(rows, fork.outage, recording.start, rng)
            spoilt = spoil(recording, gone, rng)
            navigator, previous = fork.navigator.fork(), fork.begin
            for time in times:
                cut = known_at(recording, time)
                left = withhold_from(spoilt.slice(-np.inf, cut), gone)
                fold(navigator, events(left, late, previous, cut), recording.start)
                previous = cut
            found = first_difference(rows, navigator.journal.trajectory(), fork.navigator.journal.last, times)
            if found is None and times and way not in self._looked_at:
                self._looked_at.add(way)
                again = partial(self._afresh, every)
                found = from_the_start(again, raw, gone, rows, times[len(times) // 2], rng)
            if found is not None:
                return Peek(fork.outage, found - recording.start)
        return None

    def _afresh(
        self, planned: tuple[Outage, ...], recording: Recording, through: tuple[Outage, ...]
    ) -> Solution:
        """Decide and navigate with nothing kept from earlier runs."""
        recording = prepared(recording, self.system)
        decided = decide_before(withhold_from(recording, planned), self.system, planned)
        return run_with_forks(recording, self.system, through, (), decided, RATE)[0]

    def _decided(self, recording: Recording, outages: tuple[Outage, ...]) -> Decided:
        """What is decided before the first outage depends on no other, nor on how long that one is."""
        if not outages:
            return decide_before(recording, self.system, ())
        first = min(outages)
        keys = (recording.name, first.start, first.effect), (recording.name, outages)
        for key in keys:
            if key in self._known:
                return self._known[key]
        decided = decide_before(withhold_from(recording, outages), self.system, outages)
        late = any(d.name == DECISIONS_TAKEN_LATE for d in decided.decisions)
        self._known[keys[late]] = decided
        return decided


def smoothed(system: System, name: str = "smoothed") -> Function:
    """The bound that no real-time system passes: a recipe's filter, corrected by all that came later.

    Parameters
    ----------
    system : System
    name : str
        What tables call it.

    Returns
    -------
    Function
        Declared not causal, with a run for each isolated outage.
    """
    what = f"{system.name}, then smoothed over the whole recording: not a real-time result"
    return Function(name, what, False, partial(_smooth, system))


def _smooth(system: System, recording: Recording, outages: tuple[Outage, ...]) -> Solution:
    return smooth(recording, system, outages, RATE)
