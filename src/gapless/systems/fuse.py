"""A recording in, a solution out: decide, fold, collect."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from gapless.errors import AlignmentError
from gapless.fold.feed import events
from gapless.fold.journal import Journal
from gapless.rehearsal.stage import Rehearsing
from gapless.scenarios import Outage, withhold
from gapless.systems.adjust import graded
from gapless.systems.build import stamps
from gapless.systems.conduct import Finish, Folding, as_built, navigator_for
from gapless.systems.decide import Decided, decide, static_decisions
from gapless.systems.prepare import denoise_decisions, prepared
from gapless.systems.recipe import System
from gapless.trip.events import Event, ImuBlock
from gapless.trip.recording import Recording
from gapless.trip.solution import Decision, Solution

Progress = Callable[[float], None]
"""Told the time that navigation has reached [s after the first sample]."""
DECISIONS_TAKEN_LATE = "decisions taken late"
"""Names the decision that tells that an outage had begun before anything could be decided."""


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
    if causal:
        navigator, decided = _on_the_way(open_sky, system, rate, progress, finish)
    else:
        decided = decided or decide_before(open_sky, system, outages)
        navigator = navigator_for(open_sky, system, decided, rate, finish=finish)
        fold(navigator, events(open_sky, stamps(system, decided.offsets)), recording.start, progress)
    return collect(recording, system, outages, navigator, decided)


def decide_before(open_sky: Recording, system: System, outages: tuple[Outage, ...]) -> Decided:
    """Decide from what was logged before the first outage that interrupts navigation.

    An outage before there was half a minute of it (a car still parked) leaves nothing to decide from
    and nothing to bridge: the next one counts.

    Parameters
    ----------
    open_sky : Recording
        As `withhold_from` leaves it.
    system : System
    outages : tuple of Outage

    Returns
    -------
    Decided
    """
    system = graded(system, open_sky)
    horizons = [open_sky.start + start for start in sorted(o.start for o in outages)] or [np.inf]
    for horizon in horizons:
        decided = decide(open_sky, system, horizon)
        if decided.span > 0.0:
            break
    if horizon > horizons[0]:
        late = Decision(
            DECISIONS_TAKEN_LATE,
            round(horizon - open_sky.start, 3),
            "s after the first sample",
            "data",
            "before the outages that began earlier there was too little motion to decide from",
        )
        decided = replace(decided, decisions=(*decided.decisions, late))
    return decided


def withhold_from(recording: Recording, outages: Iterable[Outage]) -> Recording:
    """The recording without the GNSS epochs of the outages.

    Parameters
    ----------
    recording : Recording
    outages : iterable of Outage

    Returns
    -------
    Recording
    """
    return replace(recording, gnss=withhold(recording.gnss, tuple(outages), recording.start))


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


def _on_the_way(
    recording: Recording, system: System, rate: float, progress: Progress | None, finish: Finish
) -> tuple[Folding, Decided]:
    """Decide at fixed data times from the past alone; the navigator goes on with what was decided."""
    cuts = [recording.start + s for s in STAGES if s < recording.duration]
    decided = decide(recording, system, recording.start)
    navigator = navigator_for(recording, system, decided, rate, 1.6, finish)
    for begin, end in zip([-np.inf, *cuts], [*cuts, np.inf], strict=True):
        feed = events(recording, stamps(system, decided.offsets), begin, end)
        fold(navigator, feed, recording.start, progress)
        if np.isfinite(end):
            decided = decide(recording, system, end)
    return navigator, decided


def collect(
    recording: Recording,
    system: System,
    outages: tuple[Outage, ...],
    navigator: Folding,
    decided: Decided,
) -> Solution:
    """What a navigator that has come to the end found.

    Parameters
    ----------
    recording : Recording
    system : System
    outages : tuple of Outage
    navigator : Navigator or Rehearsing
    decided : Decided

    Returns
    -------
    Solution

    Raises
    ------
    AlignmentError
        If there was never a heading to start from.
    """
    journal = navigator.journal
    if not journal.times:
        raise AlignmentError(
            f"{recording.name}: GNSS never showed three fixes in a row faster than "
            f"{system.alignment.min_speed:g} m/s, so there is no heading to start from; "
            "lower alignment.min_speed in the configuration"
        )
    states, sds = journal.blocks()
    return Solution(
        name=recording.name,
        system=system.name,
        trajectory=journal.trajectory(),
        states=states,
        states_sd=sds,
        innovations=journal.innovations(),
        decisions=(
            *denoise_decisions(system),
            *static_decisions(recording, system),
            *decided.decisions,
            *_alignments(journal, recording.start),
            *_stops(journal),
            *(d for bridge in navigator.bridges for d in bridge.decisions(recording.start)),
            *(navigator.decisions(recording.start) if isinstance(navigator, Rehearsing) else ()),
        ),
        outages=tuple((o.start, o.until) for o in outages),
        start=recording.start,
        notes=recording.notes,
        learned=tuple(m for bridge in navigator.bridges if (m := bridge.learned()) is not None),
        exhibits=(
            *(e for bridge in navigator.bridges if (e := bridge.exhibit()) is not None),
            *((navigator.exhibit(),) if isinstance(navigator, Rehearsing) else ()),
        ),
    )


def _alignments(journal: Journal, start: float) -> list[Decision]:
    return [
        Decision("alignment", round(time - start, 2), "s after the first sample", "data", evidence)
        for time, evidence in journal.alignments
    ]


def _stops(journal: Journal) -> list[Decision]:
    """Stationary stretches, from the zero-velocity updates."""
    channel = journal.channels.get("zero_velocity")
    if channel is None or not channel.time:
        return []
    times = np.array(channel.time)
    edges = np.flatnonzero(np.diff(times) > 2.0)
    total = float(np.sum(np.minimum(np.diff(times), 0.3)))
    evidence = (
        f"{len(times)} zero-velocity updates; spreads like this drive's own stops, not like its driving"
    )
    return [
        Decision("stationary stretches", float(len(edges) + 1), f"in all {total:.0f} s", "data", evidence)
    ]
