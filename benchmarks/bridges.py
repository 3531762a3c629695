"""What bridging costs: a minute without GNSS, navigated in real time, training and all.

    python benchmarks/bridges.py [SYSTEM ...] [--length 60] [--repeat 5]

A simulated drive; each system runs through the outage at its end as fast as it can, and of several runs the
fastest counts. Printed, in seconds: the same system without its bridge; with it, but for its learner's fits;
those fits; all of it. Then how many times faster than real time all of it is, and how many if the fits are
left out, as where a learner comes from a file.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np

from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.runs.prepare import withhold_from
from gapless.scenarios import Outage
from gapless.simulate import simulate
from gapless.systems.adjust import named
from gapless.systems.build import settings

PAPERS = ("wang2018", "liu2019-denoise", "georges2015", "aslinezhad2020", "tan2015")
START = 400.0


class Timed:
    """A learner's factory whose learners add up the time that they learn."""

    def __init__(self, make):
        self.make, self.seconds = make, 0.0

    def __call__(self):
        learner = self.make()
        fit = learner.fit

        def timed(x, y):
            begun = time.perf_counter()
            fit(x, y)
            self.seconds += time.perf_counter() - begun

        learner.fit = timed
        return learner


def through(log, name: str, length: float) -> tuple[float, float]:
    """Seconds through the outage, and of them those spent on training."""
    outage = Outage(START, START + length)
    fed = withhold_from(log, (outage,))
    setup = settings(named(name), fed, {}, (np.zeros(2), np.full(2, 0.02)))
    timed = [Timed(bridge.learner) for bridge in setup.bridges]
    bridges = tuple(replace(b, learner=t) for b, t in zip(setup.bridges, timed, strict=True))
    navigator = Navigator(replace(setup, bridges=bridges))
    for event in events(fed, {}, -np.inf, START):
        navigator.step(event)
    rest = list(events(fed, {}, START, START + length))
    begun, trained = time.perf_counter(), sum(t.seconds for t in timed)
    for event in rest:
        navigator.step(event)
    return time.perf_counter() - begun, sum(t.seconds for t in timed) - trained


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("systems", nargs="*", default=PAPERS)
    parser.add_argument("--length", type=float, default=60.0)
    parser.add_argument("--repeat", type=int, default=5)
    given = parser.parse_args()
    log = simulate("urban", "consumer", START + given.length + 10.0, 1)
    titles = ("no bridge", "bridge", "training", "all", "real time: all", "without training")
    print(f"{'system':16} " + " ".join(f"{title:>{max(9, len(title))}}" for title in titles))
    for name in given.systems:
        alone, _ = min(through(log, f"{name}-bridge", given.length) for _ in range(given.repeat))
        whole, training = min(through(log, name, given.length) for _ in range(given.repeat))
        rest = whole - training
        seconds = " ".join(f"{value:8.3f}s" for value in (alone, rest, training, whole))
        print(f"{name:16} {seconds} {given.length / whole:13.0f}x {given.length / rest:15.0f}x", flush=True)


if __name__ == "__main__":
    main()
