"""How often the truth lies in the ellipses that are stated of clean drives, and how far clocks are off.

    python benchmarks/clean.py [--drives 40] [--profiles urban,highway,mixed] [--receivers ...]

Simulated drives whose grade, receiver, clock and lever arm are drawn from their seed, fused with nothing
told but the lever arm. By profile and by receiver: the share of rows, from 60 s after the alignment on, that
lie in the 95 % ellipse, the worst drive's, and the clocks' errors over their stated deviations (RMS), which
are one if these are honest.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from gapless.evaluation import solution_errors
from gapless.evaluation.statistics import rms
from gapless.runs.fuse import fuse
from gapless.simulate import PROFILES, Receiver, Segment, Vehicle, simulate

GRADES = ("consumer", "consumer", "adis16448", "tactical")
RECEIVERS = {
    "standard": Receiver(stated=1.5),
    "white": Receiver(5.0, (0.2, 0.2, 0.4), (0.0, 0.0, 0.0)),
    "ten": Receiver(10.0, (0.3, 0.3, 0.6), (1.0, 1.0, 2.0), stated=1.2),
    "rtk": Receiver(5.0, (0.01, 0.01, 0.02), (0.01, 0.01, 0.02), 60.0, (0.02, 0.02, 0.04), fix=4),
    "mean": Receiver(1.0, velocity_window=1.0, stated=1.5),
}
"""Good and plain ones. Each is late as its seed has it."""


@dataclass(frozen=True)
class Drive:
    """What one drive showed."""

    seed: int
    receiver: str
    grade: str
    inside: float
    along: float
    cross: float
    stated: float
    clocks: dict[str, tuple[float, float]]


def mixed(duration: float, rng: np.random.Generator) -> Sequence[Segment]:
    """A city and a motorway, in either order, with a halt between."""
    parts = [PROFILES[name](0.5 * duration - 10.0, rng) for name in rng.permutation(["urban", "highway"])]
    speed = max(0.0, sum(s.acceleration * s.duration for s in parts[0]))
    return (*parts[0], Segment(20.0, -speed / 20.0), *parts[1])


def drawn(profile: str, seed: int, kinds: Sequence[str], seconds: float) -> tuple[Drive, object]:
    """Simulate, fuse, and compare with the truth."""
    rng = np.random.default_rng([seed, len(profile)])
    kind, grade = str(rng.choice(kinds)), str(rng.choice(GRADES))
    late = float(rng.choice([0.0, rng.uniform(0.0, 0.4)]))
    arm = rng.uniform([-1.0, -0.5, -1.5], [1.0, 0.5, -0.2]) * rng.choice([0.0, 1.0])
    receiver = replace(RECEIVERS[kind], position_delay=late, velocity_delay=late)
    path = mixed(seconds, rng) if profile == "mixed" else profile
    log = simulate(path, grade, seconds, seed, vehicle=Vehicle(antenna=tuple(arm)), receiver=receiver)
    found = fuse(replace(log, grade=None))
    e = solution_errors(found.trajectory, log.reference)
    e = e.take((e.time > found.trajectory.time[0] + 60.0) & np.isfinite(e.nees))
    true = {"position": -late, "velocity": -late - 0.5 * receiver.velocity_window}
    clocks = {
        c: (d.value - true[c], d.sd or np.nan)
        for d in found.decisions
        for c in true
        if d.name == f"clock offset, {c}"
    }
    stated = np.sqrt(np.trace(e.covariance, axis1=1, axis2=2))
    told = (rms(x) for x in (e.along, e.cross, stated))
    return Drive(seed, kind, grade, float(np.mean(e.inside())), *told, clocks), found


def line(name: str, drives: Sequence[Drive]) -> str:
    """Shares and clocks of some drives."""
    inside = np.array([d.inside for d in drives])
    told = f"{name:10}{len(drives):4} {100 * inside.mean():6.1f} {100 * inside.min():6.1f}"
    for channel in ("position", "velocity"):
        off, sd = np.array([d.clocks[channel] for d in drives]).T
        z = np.sqrt(np.nanmean((off / sd) ** 2)) if np.isfinite(off / sd).any() else np.nan
        told += f"   {np.sqrt(np.mean(off**2)):6.3f} {np.sqrt(np.nanmean(sd**2)):6.3f} {z:5.2f}"
    return told


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--drives", type=int, default=40)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--profiles", default="urban,highway,mixed")
    parser.add_argument("--receivers", default=",".join(RECEIVERS))
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--each", action="store_true", help="a line a drive")
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.drives)
    print(f"{'':10}   n inside  worst   position's clock: off, sd, z; velocity's")
    for profile in given.profiles.split(","):
        job = partial(one, profile, kinds=given.receivers.split(","), seconds=given.seconds)
        with ProcessPoolExecutor(given.processes) as pool:
            drives = list(pool.map(job, seeds))
        if given.each:
            for d in drives:
                told = " ".join(f"{off:+.3f}±{sd:.3f}" for off, sd in d.clocks.values())
                error = f"{d.along:.2f} {d.cross:.2f} m ({d.stated:.2f})"
                print(f"  {d.seed} {d.receiver:9} {d.grade:10} {100 * d.inside:5.1f} % {error} {told}")
        for kind in RECEIVERS:
            if of := [d for d in drives if d.receiver == kind]:
                print(line(kind, of))
        print(line(profile, drives), flush=True)


def one(profile: str, seed: int, kinds: Sequence[str], seconds: float) -> Drive:
    """A drive without its solution."""
    return drawn(profile, seed, kinds, seconds)[0]


if __name__ == "__main__":
    main()
