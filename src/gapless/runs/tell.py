"""What a run tells: its rows, and every decision with its evidence."""

from __future__ import annotations

import numpy as np

from gapless.errors import AlignmentError
from gapless.fold.journal import Journal
from gapless.rehearsal.stage import Rehearsing
from gapless.runs.arm import at_end
from gapless.runs.conduct import Folding
from gapless.runs.decide import Decided
from gapless.runs.notices import Evidence, grouped, noticed
from gapless.runs.prepare import withhold_from
from gapless.runs.verdict import judge
from gapless.scenarios import Outage
from gapless.systems.denoising import denoiser
from gapless.systems.recipe import System
from gapless.trip.recording import Note, Recording
from gapless.trip.solution import Decision, Solution


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
    trajectory, innovations = journal.trajectory(), journal.innovations()
    fed = withhold_from(recording, outages)
    seen = noticed(Evidence(journal, innovations, trajectory, fed, decided.offsets))
    return Solution(
        name=recording.name,
        system=system.name,
        trajectory=trajectory,
        states=states,
        states_sd=sds,
        innovations=innovations,
        decisions=(
            *denoise_decisions(system),
            *static_decisions(recording, system),
            *(at_end(d, states, sds) for d in decided.decisions),
            *_alignments(journal, recording.start),
            *_stops(journal),
            *(d for bridge in navigator.bridges for d in bridge.decisions(recording.start)),
            *(navigator.decisions(recording.start) if isinstance(navigator, Rehearsing) else ()),
        ),
        outages=tuple((o.start, o.until) for o in outages),
        start=recording.start,
        notes=(*recording.notes, *(Note("clocks", note, 0) for note in decided.notes)),
        learned=tuple(m for bridge in navigator.bridges if (m := bridge.learned()) is not None),
        exhibits=(
            *(e for bridge in navigator.bridges if (e := bridge.exhibit()) is not None),
            *((navigator.exhibit(),) if isinstance(navigator, Rehearsing) else ()),
        ),
        notices=grouped(seen),
        verdict=judge(seen, decided.decisions, fed.gnss, trajectory, innovations),
    )


def denoise_decisions(system: System) -> tuple[Decision, ...]:
    """What was done to the inertial signals, as a solution states it.

    Parameters
    ----------
    system : System

    Returns
    -------
    tuple of Decision
        None or one.
    """
    made = denoiser(system.denoise)
    return () if made is None else (Decision("denoising", made.name, "", "user", made.text),)


def static_decisions(recording: Recording, system: System) -> list[Decision]:
    """What is settled without navigating: the sensors.

    Parameters
    ----------
    recording : Recording
    system : System

    Returns
    -------
    list of Decision
    """
    imu, gnss = recording.imu, recording.gnss
    rate = 1.0 / float(np.median(np.diff(gnss.time))) if len(gnss) > 1 else 0.0
    return [
        Decision("IMU rate", round(imu.rate, 2), "Hz", "data", f"{len(imu)} samples, median interval"),
        Decision("GNSS rate", round(rate, 2), "Hz", "data", f"{len(gnss)} fixes, {_kinds(recording)}"),
    ]


def _kinds(recording: Recording) -> str:
    words = {1: "single point", 2: "differential", 4: "RTK fixed", 5: "RTK float"}
    codes, counts = np.unique(recording.gnss.fix, return_counts=True)
    named = [
        f"{words.get(int(c), 'other')} {100 * n / counts.sum():.0f} %"
        for c, n in zip(codes, counts, strict=True)
    ]
    velocity = "with velocity" if recording.gnss.has_velocity else "without velocity"
    return f"{', '.join(named)}, {velocity}"


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
