"""What bridging costs: a minute without GNSS, navigated in real time, training and all.

    python benchmarks/bridges.py [SYSTEM ...] [--length 60]

A simulated drive; a copy of each system at the outage's onset runs through it as fast as it can. Printed:
seconds that the copy took without its bridge and with it, training apart, and how many times faster than
real time that is.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np

from gapless.feed import events
from gapless.navigator import Navigator
from gapless.scenarios import Outage
from gapless.simulate import simulate
from gapless.systems.adjust import named
from gapless.systems.build import settings
from gapless.systems.fuse import withhold_from

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
    begun = time.perf_counter()
    for event in rest:
        navigator.step(event)
    return time.perf_counter() - begun, sum(t.seconds for t in timed)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("systems", nargs="*", default=PAPERS)
    parser.add_argument("--length", type=float, default=60.0)
    given = parser.parse_args()
    log = simulate("urban", "consumer", START + given.length + 10.0, 1)
    through(log, "ins", given.length)
    print(
        f"{'system':22} {'alone':>8} {'bridged':>8} {'training':>9} {'real time':>10} {'with training':>14}"
    )
    for name in given.systems:
        alone, _ = through(log, f"{name}-bridge", given.length)
        whole, training = through(log, name, given.length)
        fast, faster = given.length / whole, given.length / (whole - training)
        row = f"{alone:7.3f}s {whole - training:7.3f}s {training:8.3f}s {faster:9.0f}x {fast:12.0f}x"
        print(f"{name:22} {row}", flush=True)


if __name__ == "__main__":
    main()
