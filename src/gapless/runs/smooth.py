"""A recording in, the best that all of it says about every moment out: not causal, and said to be."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gapless.errors import ConfigError
from gapless.filters.adaptation.registry import KINDS, bends_gain
from gapless.filters.smoother import Adjoint, Correction
from gapless.fold.feed import events, in_order, merged
from gapless.fold.journal import Journal
from gapless.fold.navigator import Navigator, Settings
from gapless.fold.tape import Row, Tape
from gapless.inertial.belief import inject
from gapless.rehearsal.stage import Rehearsing
from gapless.runs.conduct import Folding, navigator_for, settings_for
from gapless.runs.decide import decide
from gapless.runs.fuse import Progress, fold
from gapless.runs.prepare import graded, prepared, withhold_from
from gapless.runs.tell import collect
from gapless.scenarios import Outage
from gapless.systems.build import stamps
from gapless.systems.recipe import System
from gapless.trip.recording import Recording
from gapless.trip.solution import Decision, Solution, first_deviations

SEGMENT = 60.0
"""Seconds that are kept in memory at once; the filter goes through each a second time."""
SMOOTHING = Decision(
    "smoothing", "fixed interval", "", "user", "every row from the whole recording: not a real-time result"
)


def smooth(
    recording: Recording,
    system: System | None = None,
    outages: Iterable[Outage] = (),
    rate: float = 10.0,
    progress: Progress | None = None,
) -> Solution:
    """Navigate a recording forwards, then let what came later correct what came before.

    Clock offsets and mounting are decided from the whole recording too. Memory does not grow with
    the recording but for its rows: the way forward is kept as a snapshot a minute, and each minute is
    navigated again when the way back reaches it.

    Parameters
    ----------
    recording : Recording
    system : System, optional
        The recipe of the filter; "constraints" if not given.
    outages : iterable of Outage
        Stretches in which GNSS is withheld.
    rate : float
        Rows of the solution per second.
    progress : callable, optional

    Returns
    -------
    Solution
        Innovations are those of the filter. The deviations of positions contain the filter's share of
        what fixes have in common, of which a smoother has between half and all (in variance).

    Raises
    ------
    AlignmentError
        If the vehicle never moved fast enough for a heading.
    ConfigError
        If the recipe corrects by feed-forward, takes another gain than the optimal one, or rows are asked
        for between its ticks.
    """
    system, outages = graded(System() if system is None else system, recording), tuple(outages)
    _optimal(system)
    recording = prepared(recording, system)
    open_sky = withhold_from(recording, outages)
    decided = decide(open_sky, system)
    built = settings_for(open_sky, system, decided, rate)
    navigator = Navigator(_on_ticks(built))
    first = navigator_for(open_sky, system, decided, rate)
    _prepare(navigator, first, open_sky, stamps(system, decided.offsets))
    held = in_order(open_sky, stamps(system, decided.offsets))
    cuts = [-np.inf, *np.arange(recording.start + SEGMENT, recording.imu.time[-1], SEGMENT), np.inf]
    parts = list(pairwise(cuts))
    snapshots = []
    for begin, end in parts:
        snapshots.append(navigator.snapshot())
        for event in merged(open_sky.imu, held, begin, end):
            navigator.step(event)
        if progress is not None:
            progress(0.5 * (navigator.time - recording.start))
    forward = collect(recording, system, outages, navigator, decided)
    adjoint, rows = Adjoint(built.layout.n), []
    for snapshot, (begin, end) in zip(reversed(snapshots), reversed(parts), strict=True):
        navigator.restore(snapshot)
        navigator.tape = Tape(built.layout)
        for event in merged(open_sky.imu, held, begin, end):
            navigator.step(event)
        rows += _back(adjoint, navigator.tape)
        if progress is not None and np.isfinite(begin):
            progress(recording.duration - 0.5 * (begin - recording.start))
    return _smoothed(forward, rows, navigator)


def _prepare(navigator: Navigator, first: Folding, open_sky: Recording, offsets: Mapping[str, float]) -> None:
    """Go through the recording once to know who may speak, and what bridges will have learned."""
    if not first.bridges:
        return
    fold(first, events(open_sky, offsets), open_sky.start)
    for bridge, taught in zip(navigator.bridges, first.bridges, strict=True):
        bridge.begin_with(taught)
    if isinstance(first, Rehearsing):
        navigator.adopt(first.manner)


def _optimal(system: System) -> None:
    """Refuse a filter whose gain is not the optimal one: the adjoint is that of the optimal filter."""
    for kind in KINDS:
        rule = bends_gain(getattr(system.adaptation, kind))
        if rule:
            raise ConfigError(
                f"smoothing needs the optimal gain, which {rule} does not take; "
                f"leave it out of adaptation.{kind}"
            )


def _on_ticks(built: Settings) -> Settings:
    """One step of the covariance a tick, for each must be gone back through."""
    if built.open_loop:
        raise ConfigError('smoothing needs filter.correction = "feedback"; this recipe feeds forward')
    if built.row < built.tick - 1e-9:
        most = 1.0 / built.tick
        raise ConfigError(f"smoothing gives {most:g} rows a second at most; ask for no more")
    return replace(built, period=built.tick, lateness=0.0, memory=0.0)


def _back(adjoint: Adjoint, tape: Tape) -> list[Row]:
    """Smoothed rows of a tape, last first."""
    rows = []
    for entry in reversed(tape.entries):
        if isinstance(entry, Row):
            dx, p = adjoint.smooth(entry.p)
            x = entry.x.copy()
            inject(x, dx)
            rows.append(entry._replace(x=x, p=p))
        elif isinstance(entry, Correction):
            adjoint.through_correction(entry)
        else:
            adjoint.through_step(entry)
    return rows


def _smoothed(forward: Solution, rows: list[Row], navigator: Navigator) -> Solution:
    built = navigator.settings
    journal, belief = Journal(built.layout, built.misalignment), navigator.belief.copy()
    for row in reversed(rows):
        belief.x[:] = row.x
        belief.P[:] = row.p
        journal.row(row.time, belief, row.shared, row.source)
    states, sds = journal.blocks()
    return replace(
        forward,
        system=f"{forward.system}, smoothed",
        trajectory=journal.trajectory(),
        states=states,
        states_sd=sds,
        start_sd=first_deviations(forward),
        decisions=(SMOOTHING, *forward.decisions),
    )
