"""A run that can be taken up again where each outage began.

One navigator goes through the recording; when an outage is about to begin, a copy of it is kept. From
there one can run ahead without that outage's fixes, for the same bits as a run from the start: nothing
that was fed before the copy knows of the outage.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields

import numpy as np

from gapless.fold.feed import events
from gapless.runs.conduct import Folding, navigator_for
from gapless.runs.decide import Decided
from gapless.runs.fuse import fold
from gapless.runs.prepare import graded, withhold_from
from gapless.runs.tell import collect
from gapless.scenarios import Outage
from gapless.systems.build import stamps
from gapless.systems.recipe import System
from gapless.trip.recording import Recording, Trajectory
from gapless.trip.solution import Solution

LEAD = 2.0
"""A piece begins so long before its outage [s], and ends so long after: clocks differ by less."""


@dataclass(frozen=True, eq=False)
class Fork:
    """A navigator as it stood when an outage was about to begin.

    Parameters
    ----------
    outage : Outage
    begin : float
        All that arrived before it was fed [s, logged]; later than it is the first fix that the outage
        touches.
    navigator : Navigator or Rehearsing
        Never stepped itself.
    """

    outage: Outage
    begin: float
    navigator: Folding


def run_with_forks(
    recording: Recording,
    system: System,
    through: Iterable[Outage],
    outages: Iterable[Outage],
    decided: Decided,
    rate: float,
) -> tuple[Solution, tuple[Fork, ...]]:
    """Navigate a recording and keep a copy at the beginning of each outage.

    Parameters
    ----------
    recording : Recording
    system : System
    through : iterable of Outage
        Those that this very run goes through without their fixes.
    outages : iterable of Outage
        Those at which to keep a copy.
    decided : Decided
    rate : float
        Rows per second.

    Returns
    -------
    solution : Solution
        The same bits as from `fuse` with the same decisions.
    forks : tuple of Fork
        In order of time; an outage that begins after the last sample has none.
    """
    system, through = graded(system, recording), tuple(through)
    fed, late = withhold_from(recording, through), stamps(system, decided.offsets)
    navigator = navigator_for(recording, system, decided, rate)
    last = float(recording.imu.time[-1])
    at = sorted(((first_touched(recording, o), o) for o in outages), key=lambda pair: pair[0])
    forks, previous = [], -np.inf
    for begin, outage in ((b, o) for b, o in at if b <= last):
        fold(navigator, events(fed, late, previous, begin), recording.start)
        forks.append(Fork(outage, begin, navigator.fork()))
        previous = begin
    fold(navigator, events(fed, late, previous), recording.start)
    return collect(recording, system, through, navigator, decided), tuple(forks)


def first_touched(recording: Recording, outage: Outage) -> float:
    """When the first fix arrives that an outage changes, or the outage begins.

    Parameters
    ----------
    recording : Recording
    outage : Outage

    Returns
    -------
    float
        [s]
    """
    whole, left = recording.gnss, withhold_from(recording, [outage]).gnss
    n = min(len(whole), len(left))
    same = whole.time[:n] == left.time[:n]
    for name in ("lla", "v_n"):
        a, b = getattr(whole, name)[:n], getattr(left, name)[:n]
        same &= ((a == b) | (np.isnan(a) & np.isnan(b))).all(axis=1)
    touched = whole.time[:n][~same]
    begin = recording.start + outage.start
    return min(begin, float(touched[0])) if len(touched) else begin


def piece(fork: Fork, recording: Recording, whole: Solution, system: System, decided: Decided) -> Trajectory:
    """The path through an outage from its fork, all other fixes open.

    Parameters
    ----------
    fork : Fork
    recording : Recording
    whole : Solution
        Of the run that was forked: it gives the rows just before.
    system : System
    decided : Decided
        The one of that run.

    Returns
    -------
    Trajectory
        From `LEAD` before the outage to `LEAD` after what is scored of it.
    """
    navigator, late = fork.navigator.fork(), stamps(system, decided.offsets)
    end = recording.start + fork.outage.until + LEAD
    left = withhold_from(recording, [fork.outage])
    fold(navigator, events(left, late, fork.begin, end), recording.start)
    rows = whole.trajectory
    before = (rows.time <= fork.navigator.journal.last) & (rows.time > fork.begin - LEAD)
    return join(rows.take(before), navigator.journal.trajectory())


def join(a: Trajectory, b: Trajectory) -> Trajectory:
    """Two trajectories one after the other.

    Parameters
    ----------
    a, b : Trajectory

    Returns
    -------
    Trajectory
    """
    return Trajectory(*(np.concatenate([getattr(a, f.name), getattr(b, f.name)]) for f in fields(a)))
