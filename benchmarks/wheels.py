"""What hearing the wheels and rehearsing cost, as ratios in one run.

    python benchmarks/wheels.py [--duration 900] [RECORDING ...]

Drives are fused with `constraints`, `wheels` and `auto` in turns, each the best of five: time against that of
`constraints`, and the share of one core that what was added takes while the drive lasts. Then one reading:
the spectrum, and the likelihoods over six metres a second to either side.
"""

from __future__ import annotations

import argparse
import time
from functools import partial
from pathlib import Path

import numpy as np

from gapless.bridges.comb import Memory
from gapless.bridges.orders import WINDOW, spectrum
from gapless.laboratory.study import stored
from gapless.runs.fuse import fuse
from gapless.simulate import CAR, simulate
from gapless.systems.adjust import named

SYSTEMS = ("constraints", "wheels", "auto")


def best(*calls, repeats: int = 5) -> list[float]:
    """Least processor time of each of some calls [s]; they take turns, for machines have bad minutes."""
    taken = []
    for _ in range(repeats):
        for call in calls:
            begun = time.process_time()
            call()
            taken.append(time.process_time() - begun)
    return [min(taken[k :: len(calls)]) for k in range(len(calls))]


def reading() -> tuple[float, float]:
    """Seconds for a spectrum at 100 Hz, and for the likelihoods of 150 speeds."""
    rng = np.random.default_rng(1)
    rows = np.column_stack([np.arange(450) * 0.01, rng.standard_normal((450, 6))])
    times = np.arange(46) * 0.1
    args = rows, times, 10.0 + times, WINDOW, 47.0
    heard = spectrum(*args)
    memory = Memory.empty(heard.top)
    for _ in range(50):
        memory = memory.after(heard)
    comb, speeds = memory.comb(), np.arange(4.0, 16.0, 0.08)
    comb.evidence(heard, speeds)
    listening, weighing = best(
        lambda: [spectrum(*args) for _ in range(200)],
        lambda: [comb.evidence(heard, speeds) for _ in range(200)],
    )
    return listening / 200, weighing / 200


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", nargs="*", type=Path)
    parser.add_argument("--duration", type=float, default=900.0)
    given = parser.parse_args()
    logs = [source.open() for source in stored(given.recordings)] if given.recordings else []
    logs += [
        simulate("urban", "consumer", given.duration, 1, rate=rate, chassis=CAR) for rate in (100.0, 200.0)
    ]
    print(f"{'drive':24} {'Hz':>4} {'wheels':>8} {'auto':>8} {'share of a core':>16}")
    for log in logs:
        plain, *more = best(*(partial(fuse, log, named(name)) for name in SYSTEMS))
        share = (more[-1] - plain) / log.duration
        ratios = [taken / plain for taken in more]
        print(
            f"{log.name:24} {log.imu.rate:4.0f} {ratios[0]:7.2f}x {ratios[1]:7.2f}x {100.0 * share:14.2f} %"
        )
    listening, weighing = reading()
    share = 100.0 * (listening + weighing)
    print(
        f"a reading: spectrum {1e6 * listening:.0f} us, likelihoods {1e6 * weighing:.0f} us: "
        f"{share:.3f} % of a core at one a second, of a window of {WINDOW:g} s"
    )


if __name__ == "__main__":
    main()
