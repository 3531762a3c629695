"""Is the laboratory honest? Coverage of its intervals, power of its pairs, cost of its isolated outages.

    python benchmarks/honesty.py [--repeats 1000] [--recording FOLDER]

Prints how often the 95 % interval of the median holds the known median, of outages that lie apart and of
outages of which three in a row overlap; how often pairs show a difference of 10 %, and how often one where
there is none. With a recording: whether 30 isolated outages have the bits of 30 whole runs, and how much
faster they are.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path

import numpy as np

from gapless.evaluation.pairs import signed_rank, votes
from gapless.evaluation.resampling import FIGURES, Order, interval, order, resample


def schedule(n: int, neighbours: int) -> Order:
    """Outages of which so many in a row overlap; 1: they lie apart."""
    starts = 60.0 * np.arange(n)
    found = order(["drive"] * n, starts, starts + 30.0 * neighbours)
    assert found.reach == neighbours
    return found


def coverage(n: int, neighbours: int, repeats: int) -> float:
    """Share of repeats whose interval holds the median of log-normal errors that neighbours share."""
    rng, lie, hits = np.random.default_rng(n + neighbours), schedule(n, neighbours), 0
    for k in range(repeats):
        white = rng.standard_normal(n + neighbours - 1)
        errors = np.exp(np.convolve(white, np.full(neighbours, neighbours**-0.5), "valid"))
        _, low, high = interval(errors, resample(lie, k), FIGURES["median"])
        hits += low <= 1.0 <= high
    return hits / repeats


def detected(gain: float, neighbours: int, repeats: int) -> float:
    """Share of repeats in which 60 outages show a difference at 5 %; log ratios scatter by 0.25."""
    rng, lie = np.random.default_rng(neighbours), schedule(60, neighbours)
    weights = np.full(neighbours, neighbours**-0.5)
    found = 0
    for _ in range(repeats):
        white = rng.standard_normal(60 + neighbours - 1)
        logs = math.log(gain) + 0.25 * np.convolve(white, weights, "valid")
        found += signed_rank(votes(logs, lie)) < 0.05
    return found / repeats


def isolated(folder: Path, count: int = 30) -> None:
    """Forks against whole runs."""
    from gapless import io
    from gapless.runs.decide import decide_before
    from gapless.runs.forks import piece, run_with_forks
    from gapless.runs.fuse import fuse
    from gapless.runs.prepare import withhold_from
    from gapless.scenarios import plan
    from gapless.systems.library import load

    log, system = io.read(folder), load("constraints")
    texts = [f"every=180,length=60,first=240,shift={shift}" for shift in (0, 60, 120)]
    outages = tuple(sorted(o for text in texts for o in plan([text], log)))[:count]
    decided = decide_before(withhold_from(log, outages), system, outages)
    fuse(log, system, decided=decided)  # kernels are there before the clock runs
    begun = time.perf_counter()
    whole, forks = run_with_forks(log, system, (), outages, decided, 10.0)
    pieces = [piece(fork, log, whole, system, decided) for fork in forks]
    forked = time.perf_counter() - begun
    begun = time.perf_counter()
    runs = [fuse(log, system, [fork.outage], decided=decided).trajectory for fork in forks]
    ran = time.perf_counter() - begun
    rows = same = 0
    for part, run in zip(pieces, runs, strict=True):
        if len(part):
            run = run.take((run.time >= part.time[0]) & (run.time <= part.time[-1]))
            names = ("time", "lla", "v_n", "euler", "sd", "horizontal")
            rows += len(run)
            same += len(part) if all(np.array_equal(getattr(part, k), getattr(run, k)) for k in names) else 0
    empty = sum(not len(part) for part in pieces)
    print(f"{folder.name}: {len(pieces)} isolated outages, {empty} of them before the first alignment")
    print(f"  {same} of {rows} rows have the bits of whole runs; {ran / forked:.1f} times faster")


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeats", type=int, default=1000)
    parser.add_argument("--recording", type=Path)
    given = parser.parse_args()
    for neighbours in (1, 2, 3):
        told = "apart" if neighbours == 1 else f"{neighbours} in a row overlap"
        for n in (60, 200):
            share = coverage(n, neighbours, given.repeats)
            print(f"{n:4d} outages, {told}: the interval holds the median in {100.0 * share:.1f} %")
        power, false = (detected(gain, neighbours, given.repeats) for gain in (0.9, 1.0))
        shown = f"10 % better shown in {100.0 * power:.1f} %, falsely in {100.0 * false:.1f} %"
        print(f"  60 outages, {told}: {shown}")
    if given.recording:
        isolated(given.recording)


if __name__ == "__main__":
    main()
