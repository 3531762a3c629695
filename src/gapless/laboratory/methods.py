"""What can be put on the bench: a recipe, or any function from a recording and its outages to a solution."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final, NamedTuple, Protocol

import numpy as np

from gapless.feed import events
from gapless.laboratory.prefix import Peek, first_difference, from_the_start, samples, spoil
from gapless.recording import Recording, Trajectory
from gapless.scenarios import Outage
from gapless.solution import Solution
from gapless.systems.build import stamps
from gapless.systems.decide import Decided
from gapless.systems.forks import Fork, piece, run_with_forks
from gapless.systems.fuse import DECISIONS_TAKEN_LATE, decide_before, fold, withhold_from
from gapless.systems.recipe import System

RATE: Final = 10.0
"""Rows of a solution per second."""


class Run(NamedTuple):
    """What a method made of a recording and some outages.

    Parameters
    ----------
    solution : Solution
        *passes*: through all the outages. *isolated*: with every fix there is.
    planned : tuple of Outage
        All that the run was for.
    pieces : tuple of (Outage, Trajectory)
        *isolated*: through each outage alone; a trajectory covers its outage at least.
    forks : tuple of Fork
        Where a recipe can be taken up again.
    """

    solution: Solution
    planned: tuple[Outage, ...]
    pieces: tuple[tuple[Outage, Trajectory], ...] = ()
    forks: tuple[Fork, ...] = ()


class Method(Protocol):
    """A way to navigate.

    Attributes
    ----------
    name : str
    description : str
    causal : bool
        Whether it claims that no row knows of anything logged later. A claim is checked.
    """

    @property
    def name(self) -> str:
        """What tables call it."""
        ...

    @property
    def description(self) -> str:
        """One line."""
        ...

    @property
    def causal(self) -> bool:
        """Whether no row knows of anything logged later."""
        ...

    def passes(self, recording: Recording, outages: tuple[Outage, ...]) -> Run:
        """One run without the fixes of all the outages.

        Parameters
        ----------
        recording : Recording
            Its reference is not in it.
        outages : tuple of Outage

        Returns
        -------
        Run
        """
        ...

    def isolated(self, recording: Recording, outages: tuple[Outage, ...]) -> Run:
        """Each outage alone, with all other fixes.

        Parameters
        ----------
        recording : Recording
            Its reference is not in it.
        outages : tuple of Outage
            They may overlap.

        Returns
        -------
        Run
        """
        ...

    def peek(
        self, recording: Recording, outages: Sequence[Outage], run: Run, rng: np.random.Generator
    ) -> Peek | None:
        """Look for a row that knows of something logged later, or of a withheld fix.

        Parameters
        ----------
        recording : Recording
            As the run had it.
        outages : sequence of Outage
            Those to look at.
        run : Run
        rng : numpy.random.Generator
            Chooses samples, and what withheld fixes are spoilt with.

        Returns
        -------
        Peek or None
        """
        ...


@dataclass(frozen=True)
class Recipe:
    """A system as `fuse` runs it, with its decisions taken before the first outage.

    Parameters
    ----------
    system : System
    """

    system: System
    _known: dict[object, Decided] = field(default_factory=dict, compare=False, repr=False)

    causal: bool = field(default=True, init=False)

    @property
    def name(self) -> str:
        """What tables call it."""
        return self.system.name

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
        decided = self._decided(recording, outages)
        whole, forks = run_with_forks(recording, self.system, (), outages, decided, RATE)
        pieces = tuple((f.outage, piece(f, recording, whole, self.system, decided)) for f in forks)
        return Run(whole, outages, pieces, forks)

    def peek(
        self, recording: Recording, outages: Sequence[Outage], run: Run, rng: np.random.Generator
    ) -> Peek | None:
        """See `Method`: from each fork on, sample by sample, with nothing there but what was logged before.

        What comes before the forks, decisions among it, is looked at in one run from the start, cut at a
        sample of the first outage.

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
        every, known = run.planned, dict(run.pieces)
        late = stamps(self.system, self._decided(recording, every).offsets)
        looked_at = [f for f in run.forks if f.outage in outages]
        for fork in looked_at:
            gone = (fork.outage,) if known else every
            rows = known.get(fork.outage, run.solution.trajectory)
            times = samples(rows, fork.outage, recording.start, rng)
            spoilt = spoil(recording, gone, rng)
            navigator, previous = fork.navigator.fork(), fork.begin
            for time in times:
                cut = float(np.nextafter(time, np.inf))
                left = withhold_from(spoilt.slice(-np.inf, cut), gone)
                fold(navigator, events(left, late, previous, cut), recording.start)
                previous = cut
            found = first_difference(rows, navigator.journal.trajectory(), fork.navigator.journal.last, times)
            if found is None and times and fork is looked_at[0]:
                again = partial(self._afresh, every)
                found = from_the_start(again, recording, gone, rows, times[len(times) // 2], rng)
            if found is not None:
                return Peek(fork.outage, found - recording.start)
        return None

    def _afresh(
        self, planned: tuple[Outage, ...], recording: Recording, through: tuple[Outage, ...]
    ) -> Solution:
        """Decide and navigate with nothing kept from earlier runs."""
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


@dataclass(frozen=True)
class Function:
    """Anything that makes a solution of a recording and its outages.

    Parameters
    ----------
    name, description : str
    causal : bool
        Whether it claims that no row knows of anything logged later.
    run : callable
        (recording, outages) -> Solution, with the fixes of the outages in the recording: it has to
        withhold them itself.
    """

    name: str
    description: str
    causal: bool
    run: Callable[[Recording, tuple[Outage, ...]], Solution]

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
        return Run(self.run(recording, outages), outages)

    def isolated(self, recording: Recording, outages: tuple[Outage, ...]) -> Run:
        """See `Method`: a run for each outage.

        Parameters
        ----------
        recording : Recording
        outages : tuple of Outage

        Returns
        -------
        Run
        """
        pieces = tuple((o, self.run(recording, (o,)).trajectory) for o in outages)
        return Run(self.run(recording, ()), outages, pieces)

    def peek(
        self, recording: Recording, outages: Sequence[Outage], run: Run, rng: np.random.Generator
    ) -> Peek | None:
        """See `Method`: a run from the start for each sample, for there is no other way into a function.

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
        known = dict(run.pieces)
        for outage in outages:
            rows = known.get(outage, run.solution.trajectory)
            gone = (outage,) if known else run.planned
            for time in samples(rows, outage, recording.start, rng):
                found = from_the_start(self.run, recording, gone, rows, time, rng)
                if found is not None:
                    return Peek(outage, found - recording.start)
        return None
