"""Outages by physics alone, on real recordings: the classical ladder.

    python benchmarks/outages.py [RECORDING ...] [--length 60]

Outages of the given length every 180 s (240 s for 120 s and more), first at 240 s, then the same
shifted by 60 and 120 s; each is scored by its largest horizontal error. Left out of the pool, and
counted: outages that begin before the first motion + 30 s, with too little truth, or with a hole in
the IMU's log. Recordings default to the folders in GAPLESS_RECORDINGS or ../shared/data.
"""

from __future__ import annotations

import argparse
import math
import os
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from gapless import io
from gapless.evaluation import score
from gapless.evaluation.statistics import Spread, spread
from gapless.scenarios import plan
from gapless.systems.fuse import fuse
from gapless.systems.recipe import System

GNSS = ("position", "velocity")
LADDER = {
    "ins": {"sensors": GNSS, "constraints": ()},
    "+ zero velocity": {"sensors": GNSS, "constraints": ("zero_velocity",)},
    "+ non-holonomic": {"sensors": GNSS, "constraints": ("zero_velocity", "nonholonomic")},
    "+ odometer": {},
}
APART = ("before motion + 30 s", "too little truth", "imu gap")


def errors(job: tuple[str, str, int, int]) -> list[tuple[float, bool]]:
    """Largest horizontal error of each outage of one run, and whether it counts."""
    path, step, length, shift = job
    recording = io.read(path)
    every = 240 if length >= 120 else 180
    outages = plan([f"every={every},length={length},first={240 + shift}"], recording.duration)
    if step == "+ odometer" and recording.odometer is None:
        return []
    solution = fuse(recording, _system(LADDER[step]), outages)
    found = score(solution, recording).outages
    return [(o.horizontal_max, not set(o.labels) & set(APART)) for o in found]


def _system(changes: dict[str, tuple[str, ...]]) -> System:
    from msgspec.structs import replace as change

    return change(System(), **changes)


def recordings(given: list[str]) -> list[str]:
    """Folders to run."""
    if given:
        return given
    root = Path(os.environ.get("GAPLESS_RECORDINGS", Path(__file__).parents[1] / "../shared/data"))
    found = sorted(str(p.parent) for p in root.glob("*/recording.toml"))
    if not found:
        raise SystemExit(f"no recordings in {root}; name their folders or set GAPLESS_RECORDINGS")
    return found


def line(name: str, step: str, s: Spread, left_out: int) -> str:
    """One row of the table."""
    figures = f"{s.median:7.1f} {s.p90:7.1f} {s.rms:7.1f} {s.worst:7.0f}"
    return f"{name:<14}{step:<17}{s.count:4d} {figures} {left_out:6d}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", nargs="*")
    parser.add_argument("--length", type=int, default=60)
    given = parser.parse_args()
    folders, begun = recordings(given.recordings), time.perf_counter()
    jobs = [(f, step, given.length, shift) for step in LADDER for f in folders for shift in (0, 60, 120)]
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        rows = list(pool.map(errors, jobs))
    print(f"outages of {given.length} s, largest horizontal error, m")
    print(f"{'recording':<14}{'system':<17}   n  median     P90     RMS   worst   left out")
    for step in LADDER:
        pooled: list[tuple[float, bool]] = []
        for folder in folders:
            own = [
                r for job, found in zip(jobs, rows, strict=True) if job[:2] == (folder, step) for r in found
            ]
            if own:
                print(line(Path(folder).name, step, *_counted(own)))
            pooled += own
        print(line("pooled", step, *_counted(pooled)))
    print(f"{len(jobs)} runs in {time.perf_counter() - begun:.0f} s")


def _counted(found: list[tuple[float, bool]]) -> tuple[Spread, int]:
    kept = [e for e, counts in found if counts and math.isfinite(e)]
    return spread(kept), len(found) - len(kept)


if __name__ == "__main__":
    main()
