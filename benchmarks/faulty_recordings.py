"""Real recordings with each fault put into them.

    python benchmarks/faulty_recordings.py [DIR ...], or benchmarks/faults.py --recordings DIR ...

Each is cut some minutes after the fault, which begins where the car drives; an outage of a minute follows
90 s later. Truth is the recording's own, or its fixes as they were.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from disturbed import felt, late
from faults import FOLLOWED, SETTLED, Found, all_of, held_against, notices, silenced, table, within, worst
from outages import recordings

from gapless.errors import GaplessError
from gapless.evaluation import score
from gapless.evaluation.errors import Errors
from gapless.io import read
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate.faults import FAULTS
from gapless.systems.adjust import named
from gapless.trip.motion import displace
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

AFTER, LENGTH, TAIL = 90.0, 60.0, 60.0
"""From a fault to its outage, the outage, and what comes after it [s]."""
LATEST = 600.0
"""A fault begins no later [s]."""
ASIDE = np.array([0.0, 22.0, 0.0])
"""Where positions move for good: north, east, down [m]."""


class Spoilt(NamedTuple):
    """A recording with a fault, without what lies, and what each is scored against."""

    faulted: Recording
    spared: Recording
    truth: Recording
    counts_from: float
    """Rows of the largest error begin here [s]."""


def planted(kind: str, size: float, length: float, log: Recording, at: float) -> Spoilt:
    """A kind of the simulator's, of a given size and length; before `at` where that is negative."""
    fault = FAULTS[kind]
    span = (at + min(length, 0.0), at + max(length, 0.0))
    both = fault.plant(log, span, size * fault.scale, np.random.default_rng(1))
    return Spoilt(*both, log, at)


def leaps(log: Recording, at: float) -> Spoilt:
    """Half a degree a second on the yaw gyro."""
    before, after = log.slice(-np.inf, at), log.slice(at, np.inf)
    moved = felt((0.0, 0.0, 0.5), (0.0,) * 3, (0.0,) * 3, after).imu
    parts = {
        name: np.concatenate([getattr(before.imu, name), getattr(moved, name)])
        for name in ("time", "dt", "dtheta", "dvel")
    }
    faulted = replace(log, imu=replace(log.imu, **parts))
    return Spoilt(faulted, faulted.slice(at, np.inf), log, at)


def moves(log: Recording, at: float) -> Spoilt:
    """Positions go aside for good, and truth with them."""

    def aside(time: np.ndarray, lla: np.ndarray) -> np.ndarray:
        return np.where(time[:, None] >= at, displace(lla, np.broadcast_to(ASIDE, lla.shape)), lla)

    gnss = replace(log.gnss, lla=aside(log.gnss.time, log.gnss.lla))
    truth = log.reference
    if truth is not None:
        truth = replace(truth, lla=aside(truth.time, truth.lla))
    return Spoilt(replace(log, gnss=gnss), log, replace(log, gnss=gnss, reference=truth), at + FOLLOWED)


def off(seconds: float, log: Recording, at: float) -> Spoilt:
    """Stamps of the receiver are off throughout."""
    faulted = late(seconds, log)
    return Spoilt(faulted, log, faulted, at)


CHANGES: dict[str, Callable[[Recording, float], Spoilt]] = {
    "repeats, 30 s": partial(planted, "repeats", 1.0, 30.0),
    "odometer-stands": partial(planted, "odometer-stands", 1.0, np.inf),
    "gyro leaps, 0.5 deg/s": leaps,
    "moves, 22 m": moves,
    "imu pauses, 0.5 s": partial(planted, "imu-pauses", 0.5, -240.0),
    "clock off, +0.3 s": partial(off, 0.3),
    "clock off, -0.3 s": partial(off, -0.3),
    "clock off, 60 s": partial(off, 60.0),
}
"""The last is to be refused."""


class Job(NamedTuple):
    """One recording, one fault."""

    number: int
    folder: Path
    change: str
    system: str


def driving(log: Recording) -> float:
    """When the fault begins: the first fix at speed after two fifths of the drive, or after `LATEST`."""
    earliest = log.start + min(0.4 * log.duration, LATEST)
    speed = np.hypot(log.gnss.v_n[:, 0], log.gnss.v_n[:, 1])
    rows = (log.gnss.time >= earliest) & (speed > 5.0)
    return float(log.gnss.time[rows][0]) if rows.any() else earliest


def fly(job: Job) -> Found | None:
    """One of them; none where it has nothing to spoil."""
    log = read(job.folder)
    at = driving(log)
    log = log.slice(-np.inf, at + AFTER + LENGTH + TAIL)
    if job.change.startswith("odometer") and log.odometer is None:
        return None
    spoilt = CHANGES[job.change](log, at)
    found = Found(job.change, job.number, story=f"{log.name}, {job.change} at {at - log.start:.0f} s")
    try:
        solution, errors, inside = scored(spoilt.faulted, spoilt.truth, at, job.system)
    except GaplessError as refusal:
        found.refused = str(refusal)
        return found
    found.said, found.silenced = notices(solution), silenced(solution, spoilt.faulted)
    known = np.isfinite(errors.horizontal) & (errors.time > solution.trajectory.time[0] + SETTLED)
    known &= (errors.time < at) | (errors.time >= spoilt.counts_from)
    since = known & (errors.time >= spoilt.counts_from)
    found.rows, found.inside = int(known.sum()), int(inside[known].sum())
    found.later, found.later_inside = int(since.sum()), int(inside[since].sum())
    try:
        _, other, _ = scored(spoilt.spared, log, at, job.system)
    except GaplessError:
        return found
    held_against(found, errors, since, other, spoilt.counts_from)
    return found


def scored(log: Recording, truth: Recording, at: float, system: str) -> tuple[Solution, Errors, np.ndarray]:
    """A solution, its errors, and which rows are inside."""
    begin = at - log.start + AFTER
    solution = fuse(replace(log, reference=None), named(system), [Outage(begin, begin + LENGTH)])
    errors = score(solution, truth).errors
    return solution, errors, within(errors)


def recorded(folders: list[Path], system: str, processes: int) -> list[Found]:
    """All of them, and the table."""
    jobs = [Job(k, folder, change, system) for change in CHANGES for k, folder in enumerate(folders)]
    found = [f for f in all_of(fly, jobs, processes, "recordings") if f is not None]
    for text in _told(found):
        print(text)
    return found


def _told(found: list[Found]) -> Iterator[str]:
    yield from table(found)
    yield from worst(found)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", nargs="*", type=Path)
    parser.add_argument("--system", default="auto")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    given = parser.parse_args()
    recorded(list(recordings(given.recordings)), given.system, given.jobs)


if __name__ == "__main__":
    main()
