"""What a navigator noticed on its way, each in a clause: who was not believed, what moved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import chain
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless.fold.journal import KNOCK, Journal
from gapless.runs.leans import leans
from gapless.runs.lies import how
from gapless.runs.surprises import too_large
from gapless.trip.recording import Array, Recording, Trajectory
from gapless.trip.solution import Innovations, Notice
from gapless.units import DEG

LASTING: Final = 3.0
"""A channel that was silenced for less was a spike; pauses that are shorter part no silence [s]."""
INCIDENT: Final = 30.0
"""What moves again within this is one incident [s]."""
RETURN: Final = 5.0
"""Fixes that come back after so long are believed as a matter of course [s]."""
PLACE: Final = 5.0
"""Fixes that are further off have another place [m]."""
MOST: Final = 8
"""So many notices are told one by one."""
CHANNELS: Final = ("position", "velocity", "odometer")
NAMES: Final = {
    "position": "positions",
    "velocity": "velocities",
    "odometer": "the odometer's readings",
    "nonholonomic": "the constraint to the car's wheels",
}
FIRST: Final = ("anew", "turned", "leaned", "silenced", "believed", "drifted", "felt", "heading", "surprised")
"""What is told one by one before the rest, where there is too much of it."""


class Evidence(NamedTuple):
    """What a run left.

    Parameters
    ----------
    journal : Journal
    innovations : mapping of str to Innovations
    trajectory : Trajectory
    recording : Recording
        As it was fed: withheld fixes taken out.
    offsets : mapping of str to float
        Of clocks, by channel [s].
    """

    journal: Journal
    innovations: Mapping[str, Innovations]
    trajectory: Trajectory
    recording: Recording
    offsets: Mapping[str, float]

    @property
    def start(self) -> float:
        """Time of the first IMU sample [s]."""
        return self.recording.start


def noticed(evidence: Evidence) -> tuple[Notice, ...]:
    """Everything that is to be told of a run, in order of time.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    tuple of Notice
        Not yet grouped; see `grouped`.
    """
    kinds = (_silenced, _believed, _turned, _leaned, _headings, _drifted, _felt, _anew, _surprised)
    found = sorted(chain.from_iterable(kind(evidence) for kind in kinds), key=lambda n: n.start)
    return tuple(_rounded(n) for n in found)


def grouped(notices: tuple[Notice, ...]) -> tuple[Notice, ...]:
    """Those that weigh most, and one notice for the rest.

    Parameters
    ----------
    notices : tuple of Notice
        In order of time.

    Returns
    -------
    tuple of Notice
        `MOST` at most, in order of time, the rest at the end.
    """
    if len(notices) <= MOST:
        return notices
    weighed = sorted(notices, key=lambda n: (FIRST.index(n.kind) > 2, -n.lasting))
    told, rest = weighed[: MOST - 1], weighed[MOST - 1 :]
    begin, end = min(n.start for n in rest), max(n.end for n in rest)
    channels = ", ".join(dict.fromkeys(n.channel for n in sorted(rest, key=lambda n: n.start)))
    text = f"and {len(rest)} more between {begin:.0f} and {end:.0f} s ({channels})"
    more = Notice(begin, end, "", text, "more", sum(n.lasting for n in rest))
    return (*sorted(told, key=lambda n: n.start), more)


# --- one kind each ------------------------------------------------------------------------------


def _silenced(e: Evidence) -> Iterator[Notice]:
    """Stretches in which a channel spoke and was not heard."""
    for channel in CHANNELS:
        if channel not in e.innovations:
            continue
        told = e.innovations[channel]
        interval = float(np.median(np.diff(told.time))) if len(told) > 1 else 0.0
        mute = np.isinf(told.factor) & _in_silence(e.journal, channel, told.time)
        times = told.time[mute]
        for a, b in _runs(times, max(LASTING, 2.5 * interval)):
            rows = (told.time >= a) & (told.time <= b) & mute
            lasting = round(float(rows.sum()) * interval, 1)
            if lasting < LASTING:
                continue
            begin, end = a - e.start, b + interval - e.start
            again = bool(np.isfinite(told.factor[told.time > b]).any())
            until = f"to {end:.0f} s" if again else "s on"
            after = "used again since" if again else "to the end"
            why = how(channel, told, rows, e.recording, e.trajectory, e.offsets.get(channel, 0.0))
            if any(a <= time <= b + INCIDENT for time in _begun_anew(e.journal)):
                why = "it was the filter that was wrong"
            text = f"{channel} not believed from {begin:.0f} {until}: {why} ({lasting:.0f} s; {after})"
            yield Notice(begin, end, channel, text, "silenced", lasting)


def _believed(e: Evidence) -> Iterator[Notice]:
    """Readings that were believed against the filter: places that moved, and all the rest in one."""
    for channel in CHANNELS:
        last, rest = -np.inf, []
        for time in _ruled(e.journal, channel, "believe"):
            told, fresh = e.innovations.get(channel), time - last > INCIDENT
            last = time
            if told is None or not fresh or _returns(told.time, time):
                continue
            z = told.z[min(int(np.searchsorted(told.time, time)), len(told) - 1)]
            at, away = time - e.start, float(np.linalg.norm(z))
            if channel == "position" and away >= PLACE:
                text = f"from {at:.0f} s on the fixes' new place was believed, {_side(z)}"
                yield Notice(at, at, channel, text, "believed", 0.0, away)
            else:
                rest.append((at, away))
        if rest:
            yield _beliefs(channel, rest)


def _side(z: Array) -> str:
    """Where a place lies."""
    away = float(np.hypot(*z[:2]))
    if away >= abs(z[2]):
        return f"{away:.0f} m aside"
    return f"{abs(z[2]):.0f} m {'below' if z[2] > 0.0 else 'above'}"


def _beliefs(channel: str, found: list[tuple[float, float]]) -> Notice:
    """All that a channel was believed, but for places."""
    begin, end, most = found[0][0], found[-1][0], max(away for _, away in found)
    when, much = f"at {begin:.0f} s", f"{most:.1f} {'m' if channel == 'position' else 'm/s'} apart"
    if len(found) > 1:
        when, much = f"{len(found)} times from {begin:.0f} to {end:.0f} s", f"at most {much}"
    text = f"{NAMES[channel]} were believed against the filter {when}, {much}"
    return Notice(begin, end, channel, text, "believed", 0.0, most)


def _turned(e: Evidence) -> Iterator[Notice]:
    """A box that was turned on its way; what came soon after belongs to it."""
    knocks = [(k.time, abs(k.angle)) for k in e.journal.knocks if abs(k.angle) > KNOCK]
    for group in _incidents([t for t, _ in knocks]):
        at, angle = group[0] - e.start, max(angle for t, angle in knocks if t in group)
        text = f"the box was turned by about {angle / DEG:.0f} deg at {at:.0f} s: "
        text += "its new mounting was found on the way"
        yield Notice(at, at, "imu", text, "turned", 0.0, angle)


def _leaned(e: Evidence) -> Iterator[Notice]:
    """A box that its own gyros felt being turned: it leans as no car does, and goes on doing so."""
    known = [k.time for k in e.journal.knocks if abs(k.angle) > KNOCK]
    known += _begun_anew(e.journal)
    for at, angle in leans(e.trajectory):
        if any(abs(at - time) < INCIDENT for time in known):
            continue
        at -= e.start
        text = f"the box was turned by about {angle / DEG:.0f} deg at {at:.0f} s, as its own gyros felt"
        yield Notice(at, at, "imu", text, "leaned", 0.0, angle)


def _headings(e: Evidence) -> Iterator[Notice]:
    """A heading that was put right."""
    moves = [(t, abs(size)) for t, what, size in e.journal.moves if what == "heading"]
    for group in _incidents([t for t, _ in moves]):
        at, angle = group[0] - e.start, max(size for t, size in moves if t in group)
        text = f"the heading was off by {angle / DEG:.0f} deg at {at:.0f} s, by what was felt, and put right"
        yield Notice(at, at, "filter", text, "heading", 0.0, angle)


def _drifted(e: Evidence) -> Iterator[Notice]:
    """A gyro's zero that was another at rest."""
    moves = [(t, size) for t, what, size in e.journal.moves if what == "gyro"]
    for group in _incidents([t for t, _ in moves]):
        at, size = group[0] - e.start, max(size for t, size in moves if t in group)
        text = f"a gyro's zero had moved by {size / DEG:.1f} deg/s when the car stood at {at:.0f} s"
        yield Notice(at, at, "gyro", text, "drifted", 0.0, size)


def _felt(e: Evidence) -> Iterator[Notice]:
    """Forces that were none."""
    moves = [(t, size) for t, what, size in e.journal.moves if what == "force"]
    for group in _incidents([t for t, _ in moves]):
        at, size = group[0] - e.start, max(size for t, size in moves if t in group)
        what = f"a force of {size:.1f} m/s2 was felt that wheels deny"
        text = f"accelerometers not believed at {at:.0f} s: {what}"
        yield Notice(at, at, "imu", text, "felt", 0.0, size)


def _anew(e: Evidence) -> Iterator[Notice]:
    """Alignments that threw away what was believed."""
    for time in _begun_anew(e.journal):
        at = time - e.start
        text = f"begun anew at {at:.0f} s: the filter was beyond what fixes put right"
        yield Notice(at, at, "filter", text, "anew")


def _surprised(e: Evidence) -> Iterator[Notice]:
    """Channels in use that disagree with the filter by more than is stated, for long."""
    for channel, name in NAMES.items():
        told = e.innovations.get(channel)
        if told is None:
            continue
        used = np.isfinite(told.factor) & np.isfinite(told.nis)
        for a, b, ratio in too_large(told.time[used], told.nis[used] / max(told.z.shape[1], 1)):
            begin, end = a - e.start, b - e.start
            verb = "disagrees" if channel == "nonholonomic" else "disagree"
            much = "it states" if channel == "nonholonomic" else "they state"
            text = f"{name} {verb} with the filter by more than {much} from {begin:.0f} to {end:.0f} s "
            yield Notice(begin, end, channel, text + f"(NIS {ratio:.0f})", "surprised", end - begin, ratio)


# --- parts of them ------------------------------------------------------------------------------


def _rounded(n: Notice) -> Notice:
    """Figures as good as they are."""
    start, end, lasting = (round(x, 2) for x in (n.start, n.end, n.lasting))
    return replace(n, start=start, end=end, lasting=lasting, size=round(n.size, 4))


def _ruled(journal: Journal, channel: str, ruling: str) -> list[float]:
    return [t for t, c, r in journal.rulings if c == channel and r == ruling]


def _begun_anew(journal: Journal) -> list[float]:
    return [time for time, evidence in journal.alignments if "anew" in evidence]


def _in_silence(journal: Journal, channel: str, time: Array) -> NDArray[np.bool_]:
    """Which readings were made while a channel was silenced."""
    own = [(t, r == "silence") for t, c, r in journal.rulings if c == channel]
    if not own:
        return np.zeros(len(time), bool)
    since, silent = np.array([t for t, _ in own]), np.array([False, *(s for _, s in own)])
    return np.asarray(silent[np.searchsorted(since, time, side="right")])


def _runs(times: Array, pause: float) -> Iterator[tuple[float, float]]:
    """First and last of times that are not further apart."""
    if len(times):
        cuts = np.flatnonzero(np.diff(times) > pause)
        for a, b in zip([0, *(cuts + 1)], [*cuts, len(times) - 1], strict=True):
            yield float(times[a]), float(times[b])


def _incidents(times: list[float]) -> list[list[float]]:
    """Times in groups, each of which follows on from the last one."""
    groups: list[list[float]] = []
    for time in times:
        if groups and time - groups[-1][-1] <= INCIDENT:
            groups[-1].append(time)
        else:
            groups.append([time])
    return groups


def _returns(times: Array, at: float) -> bool:
    """Whether readings came back shortly before, from a silence of their own."""
    back = times[1:][np.diff(times) > RETURN]
    return bool(((back > at - INCIDENT) & (back <= at)).any())
