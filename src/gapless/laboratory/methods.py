"""What can be put on the bench: anything that makes a solution of a recording and its outages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from gapless.laboratory.prefix import Peek, from_the_start, samples
from gapless.runs.forks import Fork
from gapless.scenarios import Outage
from gapless.trip.recording import Recording, Trajectory
from gapless.trip.solution import Solution


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

    That it is causal is a claim, and checked.
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
