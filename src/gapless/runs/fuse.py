"""A recording in, a solution out: decide, fold, collect."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise

import numpy as np

from gapless.fold.feed import events
from gapless.runs.conduct import Finish, Folding, as_built, navigator_for, settings_for
from gapless.runs.decide import Decided, decide, decide_before
from gapless.runs.prepare import graded, prepared, withhold_from
from gapless.runs.tell import collect
from gapless.scenarios import Outage
from gapless.systems.build import stamps
from gapless.systems.recipe import System
from gapless.trip.events import Event, ImuBlock
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

Progress = Callable[[float], None]
"""Told the time that navigation has reached [s after the first sample]."""


def fuse(
    recording: Recording,
    system: System | None = None,
    outages: Iterable[Outage] = (),
    rate: float = 10.0,
    causal: bool = False,
    progress: Progress | None = None,
    decided: Decided | None = None,
    finish: Finish = as_built,
) -> Solution:
    """Navigate a recording.

    Parameters
    ----------
    recording : Recording
    system : System, optional
        The recipe; "constraints" if not given.
    outages : iterable of Outage
        Stretches in which GNSS is withheld.
    rate : float
        Rows of the solution per second.
    causal : bool
        Find clock offsets and mounting on the way, from the past of each moment only. Otherwise
        they are found in a first pass over what was logged before the first outage.
    progress : callable, optional
    decided : Decided, optional
        What `decide_before` found, where it is known already.
    finish : callable
        Has the last word on the navigator's settings.

    Returns
    -------
    Solution
        Row by row from no later sample than its own; what a first pass decided is in `decisions`.

    Raises
    ------
    AlignmentError
        If the vehicle never moved fast enough for a heading.
    """
    system = graded(System() if system is None else system, recording)
    recording, outages = prepared(recording, system), tuple(outages)
    open_sky = withhold_from(recording, outages)
    legs = _on_the_way(open_sky, system) if causal else _at_once(open_sky, system, outages, decided)
    navigator: Folding | None = None
    for begin, end, decided in legs:
        if navigator is None:
            navigator = navigator_for(open_sky, system, decided, rate, SLACK * causal, finish)
        else:
            navigator.trust(settings_for(open_sky, system, decided, rate))
        feed = events(open_sky, stamps(system, decided.offsets), begin, end)
        fold(navigator, feed, recording.start, progress)
    assert navigator is not None
    assert decided is not None
    return collect(recording, system, outages, navigator, decided)


def fold(navigator: Folding, feed: Iterable[Event], start: float, progress: Progress | None = None) -> None:
    """Step through events.

    Parameters
    ----------
    navigator : Navigator or Rehearsing
    feed : iterable of Event
    start : float
        Time of the first IMU sample [s].
    progress : callable, optional
    """
    told = 0.0
    for event in feed:
        navigator.step(event)
        if progress is not None and isinstance(event, ImuBlock) and navigator.time - start > told + 5.0:
            told = navigator.time - start
            progress(told)


STAGES = (60.0, 120.0, 240.0, 480.0)
"""When a causal run decides anew [s after the first sample]."""
SLACK = 1.6
"""So late may readings come when an offset is found on the way [s]."""
Leg = tuple[float, float, Decided]
"""From when to when what was decided holds [s, logged]."""


def _at_once(
    open_sky: Recording, system: System, outages: tuple[Outage, ...], decided: Decided | None
) -> Iterator[Leg]:
    """What is known before the first outage holds for all of the recording."""
    yield -np.inf, np.inf, decided or decide_before(open_sky, system, outages)


def _on_the_way(open_sky: Recording, system: System) -> Iterator[Leg]:
    """Decide at fixed data times from the past alone; the navigator goes on with what was decided."""
    cuts = [open_sky.start + s for s in STAGES if s < open_sky.duration]
    for begin, end in pairwise([-np.inf, *cuts, np.inf]):
        yield begin, end, decide(open_sky, system, max(begin, open_sky.start))
