"""Who is fooled by what: faults planted in simulated drives, each against doing without what lies.

    python benchmarks/faults.py [--kinds repeats,gyro-leaps] [--drives 40] [--pairs] [--clean] [--alarms 50]
    python benchmarks/faults.py --recordings DIR ...

For each kind: the share of rows whose stated 95 % ellipse holds the truth, from 60 s after alignment and
from the fault on; and the ratio of the largest horizontal errors, to those of the same drive without what
lies (the receiver's fixes withheld for the span, no odometer, a filter begun anew after an inertial fault,
clocks and arms told rightly), over the rows that both have. Half of the drives have an outage of a minute,
one to two minutes after the fault, or about it. `--pairs` plants two faults at a time. `--clean`: the same
rows of drives without faults. `--alarms`: channels that were silenced in so many hours of them. The columns
"said" and "mute" count drives with notices, and with a silenced channel; "no" those that were refused.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np

from gapless.errors import GaplessError
from gapless.evaluation.errors import Errors, solution_errors
from gapless.evaluation.statistics import chi_square_quantile
from gapless.laboratory.pool import in_order
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate.faults import FAULTS, PROFILES, Planted, base, plant
from gapless.systems.adjust import named
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

SETTLED = 60.0
"""Rows count from so long after alignment [s]."""
FOLLOWED = 30.0
"""So long may the ellipse hold both places after positions moved for good [s]."""
SILENCED = 5.0
"""A channel that logs and is not heard for so long is silenced [s]."""
LENGTH = 60.0
"""Of an outage [s]."""

T = TypeVar("T")
R = TypeVar("R")


class Job(NamedTuple):
    """One drive: its faults (none for a clean one), what is driven, and its seed."""

    kinds: tuple[str, ...]
    of: str
    seed: int
    seconds: float
    system: str


@dataclass
class Found:
    """What one drive showed."""

    kind: str
    seed: int
    refused: str = ""
    rows: int = 0
    inside: int = 0
    later: int = 0
    later_inside: int = 0
    largest: float = np.nan
    spared: float = np.nan
    said: int = 0
    silenced: int = 0
    story: str = ""

    @property
    def ratio(self) -> float:
        """Of the largest error to that of the drive that was spared."""
        return self.largest / self.spared

    @property
    def share(self) -> float:
        """Of its settled rows that are inside."""
        return self.inside / self.rows if self.rows else np.nan


def silenced(solution: Solution, log: Recording) -> int:
    """How often a channel that went on logging was not heard."""
    readings = {"position": log.gnss.time, "velocity": log.gnss.time}
    if log.odometer is not None:
        readings["odometer"] = log.odometer.time
    count = 0
    for channel, logged in readings.items():
        if channel not in solution.innovations:
            continue
        told = solution.innovations[channel]
        heard = told.time[np.isfinite(told.factor)]
        ends = np.append(heard, logged[-1])
        for a, b in pairwise(ends):
            between = logged[(logged > a + 1.0) & (logged < b - 1.0)]
            outside = ~solution.in_outage(between)
            count += bool(
                b - a > SILENCED and np.sum(outside) > 1 and np.ptp(between[outside]) > SILENCED - 2
            )
    return count


def notices(solution: Solution) -> int:
    """How many things a solution tells that it noticed."""
    return len(getattr(solution, "notices", ()))


def within(errors: Errors) -> np.ndarray:
    """Rows whose stated 95 % ellipse holds the truth; none whose ellipse is no ellipse."""
    (n, e), c = errors.position[:, :2].T, errors.covariance
    a, b, d = c[:, 0, 0], c[:, 0, 1], c[:, 1, 1]
    with np.errstate(over="ignore", invalid="ignore"):  # an ellipse of 1e200 m is none
        room = a * d - b**2
        far = d * n**2 - 2.0 * b * n * e + a * e**2
        return (room > 0.0) & np.isfinite(room) & (far < chi_square_quantile(0.95, 2) * room)


def judged(solution: Solution, planted: Planted, clean: Recording) -> tuple[Errors, np.ndarray, np.ndarray]:
    """Errors; which rows are inside; and which count for the largest error.

    Positions that moved for good: both places are to be held for half a minute, then the new one.
    """
    assert clean.reference is not None
    assert planted.faulted.reference is not None
    old = solution_errors(solution.trajectory, clean.reference)
    new = solution_errors(solution.trajectory, planted.faulted.reference)
    moved = ~np.isclose(clean.reference.lla, planted.faulted.reference.lla, rtol=0.0, atol=1e-12).all(axis=1)
    changing = moved & (old.time < planted.start + FOLLOWED)
    inside = within(new) & (within(old) | ~changing)
    return new, inside, ~changing


def outage_of(job: Job, planted: Planted | None, log: Recording) -> list[Outage]:
    """In every other drive: after the fault, or with it where it is one that outages are flown with."""
    if planted is None or job.seed % 2:
        return []
    chance = np.random.default_rng([job.seed, 5])
    start = max(planted.end, planted.start, 200.0) + chance.uniform(60.0, 120.0)
    within = FAULTS[job.kinds[0]].sensor in ("imu", "odometer") and chance.random() < 1.0 / 3.0
    if within and planted.start > 150.0:
        start = planted.start - chance.uniform(5.0, 40.0)
    start = min(start, job.seconds - LENGTH - 20.0) - log.start
    return [Outage(start, start + LENGTH)]


def moved_outages(outages: Sequence[Outage], by: float) -> list[Outage]:
    """The same ones of a recording that begins later [s]; none that begin before it."""
    return [Outage(max(o.start - by, 0.0), o.end - by) for o in outages if o.end > by]


def story(job: Job, planted: Planted, outages: Sequence[Outage]) -> str:
    """What happened, when, and how bad it was."""
    told = [
        f"{k} {size:.3g} {FAULTS[k].unit} {a:.0f}-{b:.0f} s"
        for k, size, (a, b) in zip(job.kinds, planted.sizes, planted.spans, strict=True)
    ]
    return ", ".join([*told, *(f"outage {o.start:.0f}:{o.end:.0f}" for o in outages)])


def fly(job: Job) -> Found:
    """One drive with its faults, and without what lies."""
    sensors = {FAULTS[k].sensor for k in job.kinds}
    clean = base(job.of, job.seconds, job.seed, True if "odometer" in sensors else None)
    chance = np.random.default_rng([job.seed, 4])
    first = chance.uniform(130.0, 180.0)
    planted = plant(job.kinds, clean, [first, first + chance.uniform(0.0, 60.0)][: len(job.kinds)], job.seed)
    outages = outage_of(job, planted if job.kinds else None, clean)
    found = Found(" + ".join([*job.kinds[:1], *["another"] * (len(job.kinds) - 1)]) or job.of, job.seed)
    found.story = story(job, planted, outages)
    try:
        solution = fuse(planted.faulted, named(job.system), outages)
    except GaplessError as refusal:
        found.refused = str(refusal)
        return found
    found.said, found.silenced = notices(solution), silenced(solution, planted.faulted)
    errors, inside, counts = judged(solution, planted, clean)
    known = np.isfinite(errors.horizontal) & (errors.time > solution.trajectory.time[0] + SETTLED)
    since = known & (errors.time >= planted.start) if job.kinds else known
    found.rows, found.inside = int(known.sum()), int(inside[known].sum())
    found.later, found.later_inside = int(since.sum()), int(inside[since].sum())
    found.largest = float(np.max(errors.horizontal[known & counts], initial=0.0))
    if job.kinds:
        compare(found, job, planted, outages, errors, since & counts)
    return found


def compare(
    found: Found, job: Job, planted: Planted, outages: list[Outage], errors: Errors, rows: np.ndarray
) -> None:
    """Largest errors of both over the rows that both have, from the fault on."""
    spared = planted.spared
    try:
        other = fuse(spared, named(job.system), moved_outages(outages, spared.start - planted.faulted.start))
    except GaplessError:
        return
    assert spared.reference is not None
    held_against(found, errors, rows, solution_errors(other.trajectory, spared.reference), planted.start)


def held_against(found: Found, errors: Errors, rows: np.ndarray, other: Errors, start: float) -> None:
    """The largest errors of both, from the start of the fault, or of the other one where that is later."""
    theirs = np.isfinite(other.horizontal) & (other.time >= start)
    if theirs.any():
        ours = rows & (errors.time >= other.time[theirs][0])
        theirs &= other.time >= errors.time[ours][0] if ours.any() else False
    if theirs.any():
        found.largest = float(errors.horizontal[ours].max())
        found.spared = float(other.horizontal[theirs].max())


def all_of(work: Callable[[T], R], jobs: Sequence[T], processes: int, what: str) -> Iterator[R]:
    """Every outcome, with the state of things on stderr."""
    begun = time.monotonic()

    def tell(done: float) -> None:
        gone = time.monotonic() - begun
        left = gone / done * (len(jobs) - done)
        print(
            f"\r{what}: {done:.0f} of {len(jobs)}, {gone:.0f} s, {left:.0f} s left ", end="", file=sys.stderr
        )

    yield from in_order(work, jobs, processes, tell)
    print(file=sys.stderr)


def table(found: Sequence[Found]) -> Iterator[str]:
    """A line a kind, and all of them."""
    yield (
        f"{'':36}{'n':>4}{'no':>4}{'inside':>8}{'since':>8}{'worst':>8}{'seed':>6}{'largest':>9}"
        f"{'ratio':>7}{'P95':>7}{'worst':>8}{'seed':>6}{'said':>6}{'mute':>6}"
    )
    for kind in dict.fromkeys(f.kind for f in found):
        yield line(kind, [f for f in found if f.kind == kind])
    yield line("all", found)


def line(name: str, found: Sequence[Found]) -> str:
    """Figures of one kind."""
    ran = [f for f in found if not f.refused]
    start = f"{name[:36]:36}{len(found):4}{len(found) - len(ran):4}"
    if not ran:
        return start
    inside, since = share(ran, "inside", "rows"), share(ran, "later_inside", "later")
    worst = min(ran, key=lambda f: f.share if f.rows else 1.0)
    text = f"{start}{inside:8.1f}{since:8.1f}{100.0 * worst.share:8.1f}{worst.seed:6}"
    text += f"{np.median([f.largest for f in ran]):9.1f}"
    compared = [f for f in ran if np.isfinite(f.ratio)]
    if compared:
        far = max(compared, key=lambda f: f.ratio)
        r = [f.ratio for f in compared]
        text += f"{np.median(r):7.2f}{np.percentile(r, 95.0):7.2f}{far.ratio:8.2f}{far.seed:6}"
    else:
        text += " " * 28
    return f"{text}{sum(f.said > 0 for f in ran):6}{sum(f.silenced > 0 for f in ran):6}"


def share(found: Sequence[Found], inside: str, rows: str) -> float:
    """Pooled, in per cent."""
    return 100.0 * sum(getattr(f, inside) for f in found) / max(sum(getattr(f, rows) for f in found), 1)


def worst(found: Sequence[Found], count: int = 15) -> Iterator[str]:
    """The drives that fared worst against doing without."""
    yield f"\nthe worst {count} ratios of {len(found)} drives"
    for f in sorted((f for f in found if np.isfinite(f.ratio)), key=lambda f: -f.ratio)[:count]:
        errors = f"{f.ratio:7.2f} = {f.largest:7.1f} / {f.spared:6.1f} m"
        yield f"{errors}, {100 * f.share:5.1f} % inside, {f.seed}: {f.story}"
    for f in found:
        if f.refused:
            yield f"refused, {f.kind} {f.seed}: {f.refused}"


def planned(given: argparse.Namespace) -> list[Job]:
    """What is to be driven with faults."""
    kinds = given.kinds.split(",") if given.kinds else list(FAULTS)
    if unknown := sorted(set(kinds) - set(FAULTS)):
        raise SystemExit(f"no fault {', '.join(unknown)}; the faults are {', '.join(FAULTS)}")
    jobs = []
    for kind in kinds:
        for seed in range(given.first, given.first + given.drives):
            both = (kind, another(kind, seed)) if given.pairs else (kind,)
            jobs.append(Job(both, drive_of(both), seed, given.seconds, given.system))
    return jobs


def another(kind: str, seed: int) -> str:
    """A second fault, by chance; one that can happen in the drive of the first."""
    fit = [k for k, f in FAULTS.items() if k != kind and f.drive in ("any", FAULTS[kind].drive)]
    return str(np.random.default_rng([seed, *kind.encode()]).choice(fit))


def drive_of(kinds: Sequence[str]) -> str:
    """What all of these need to be driven."""
    return next((FAULTS[k].drive for k in kinds if FAULTS[k].drive != "any"), "any")


def clean(given: argparse.Namespace) -> list[Found]:
    """Without faults: what the ellipses hold."""
    seeds = range(given.first, given.first + given.drives)
    jobs = [Job((), p, seed, given.seconds, given.system) for p in PROFILES for seed in seeds]
    found = list(all_of(fly, jobs, given.jobs, "clean drives"))
    for text in table(found):
        print(text)
    return found


def alarms(given: argparse.Namespace) -> list[Found]:
    """Without faults: who was silenced, in so many hours."""
    count = max(1, round(3600.0 * given.alarms / given.seconds))
    jobs = [Job((), "any", 10_000 + k, given.seconds, given.system) for k in range(count)]
    found = list(all_of(fly, jobs, given.jobs, "hours without faults"))
    hours = sum(not f.refused for f in found) * given.seconds / 3600.0
    mute, said = sum(f.silenced for f in found), sum(f.said for f in found)
    no = sum(bool(f.refused) for f in found)
    print(f"{hours:.1f} h without faults: {mute} channels silenced, {said} notices; {no} drives refused")
    print("silenced with seeds", ", ".join(str(f.seed) for f in found if f.silenced) or "none")
    return found


def faults(given: argparse.Namespace) -> list[Found]:
    """With faults."""
    found = list(all_of(fly, planned(given), given.jobs, "faulty drives"))
    for text in (*table(found), *worst(found)):
        print(text)
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--kinds", help="names, by commas; all if not given")
    parser.add_argument("--drives", type=int, default=40, help="of each kind")
    parser.add_argument("--first", type=int, default=1, help="seed of the first drive")
    parser.add_argument("--seconds", type=float, default=480.0, help="of each drive")
    parser.add_argument("--pairs", action="store_true", help="two faults at a time")
    parser.add_argument("--clean", action="store_true", help="drives without faults, by profile")
    parser.add_argument("--alarms", type=float, metavar="HOURS", help="without faults, who is silenced")
    parser.add_argument(
        "--recordings", nargs="+", type=Path, metavar="DIR", help="real ones, each with each fault"
    )
    parser.add_argument("--system", default="auto")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--json", type=Path, metavar="FILE", help="where the figures of each drive go")
    given = parser.parse_args()
    if given.recordings:
        from faulty_recordings import recorded

        found = recorded(given.recordings, given.system, given.jobs)
    elif given.alarms:
        found = alarms(given)
    else:
        found = clean(given) if given.clean else faults(given)
    if given.json:
        known = [{k: None if v != v else v for k, v in asdict(f).items()} for f in found]  # JSON has no NaN
        given.json.write_text(json.dumps(known, indent=1))


if __name__ == "__main__":
    main()
