"""Throughput of a sweep, and how it grows from one worker to two.

    python benchmarks/sweep.py [--runs 2000] [--duration 600] [--jobs 1 2]

Simulates so many urban drives, each with 60 s outages every 180 s, and navigates them with the system
`constraints`; simulating and scoring are in the time. The rows must be the same whoever did the runs.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

import gapless as gp

STUDY = """
name = "throughput"
[simulated]
duration = {duration}
seeds = {{ count = {runs} }}
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--duration", type=float, default=600.0)
    parser.add_argument("--jobs", type=int, nargs="+", default=[1, 2])
    chosen = parser.parse_args()
    with TemporaryDirectory(prefix="gapless-") as name:
        folder = Path(name)
        study = folder / "study.toml"
        study.write_text(STUDY.format(duration=chosen.duration, runs=chosen.runs), "utf-8")
        first, expected = 0.0, ""
        for jobs in chosen.jobs:
            out = folder / f"jobs-{jobs}"
            tally = gp.sweep(study, out, jobs=jobs)
            first = first or tally.throughput
            rows = repr(gp.read_sweep(out).to_pylist())
            assert rows == (expected or rows), "other workers, other rows"
            expected = rows
            print(
                f"{jobs} worker(s): {tally.done} done, {tally.refused} refused, {tally.failed} failed, "
                f"{tally.driven / 3600.0:.1f} drive-hours in {tally.elapsed:.1f} s: "
                f"{tally.throughput:.2f} drive-hours per minute, "
                f"{tally.throughput / first:.2f} times the first",
                flush=True,
            )


if __name__ == "__main__":
    main()
