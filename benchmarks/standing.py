"""How often a car that stands is taken for one that drives: by its comb alone, and with how loud it is.

    python benchmarks/standing.py [RECORDING ...]

The wheels are learned on the whole recording. Then every window in which its receiver shows no speed is
heard by a filter that takes the car to be doing something else: how many of them give a speed, without the
loudness and with it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from outages import recordings

from gapless.bridges.combs import Combs
from gapless.bridges.loudness import SILENT
from gapless.bridges.orders import LONGEST, TOP, Spectrum, spectrum, window
from gapless.bridges.peak import peak
from gapless.bridges.wheels import Wheels
from gapless.laboratory.study import stored
from gapless.runs.fuse import fuse
from gapless.systems.adjust import named
from gapless.trip.recording import Recording

BELIEVED = ((0.8, 1.9), (1.6, 1.2), (3.2, 0.6), (5.0, 2.0))
"""Speed and its standard deviation [m/s]."""


def standing(log: Recording) -> Iterator[tuple[float, np.ndarray]]:
    """End and samples of each window, a second apart, around which no fix shows more than 0.1 m/s."""
    imu, speed = log.imu, np.linalg.norm(log.gnss.v_n, axis=1)
    felt = np.column_stack([imu.time, imu.dtheta / imu.dt[:, None], imu.dvel / imu.dt[:, None]])
    for end in np.arange(imu.time[0] + LONGEST + 2.0, imu.time[-1] - 2.0, 1.0):
        near = (log.gnss.time > end - LONGEST - 1.0) & (log.gnss.time < end + 1.0)
        rows = felt[(imu.time > end - LONGEST - 0.4) & (imu.time < end + 0.1)]
        whole = len(rows) and np.diff(rows[:, 0], prepend=end - LONGEST - 0.4, append=end + 0.1).max() < 0.2
        if whole and near.sum() >= 4 and speed[near].max() <= 0.1:
            yield end, rows


def heard(log: Recording, speed: float) -> list[Spectrum]:
    """The spectra of the windows, at a steady speed."""
    top = min(0.5 / float(np.median(np.diff(log.imu.time))) - 3.0, TOP)
    ago, steady = np.linspace(-LONGEST - 0.2, 0.0, 165), np.full(165, speed)
    length = window(ago, steady)
    return [spectrum(rows, end + ago, steady, length, top) for end, rows in standing(log)]


def main() -> None:
    """Print a line for each recording and speed."""
    print(f"{'':16}{'believed, m/s':>16}{'windows':>9}{'comb alone':>12}{'with loudness':>15}")
    for source in stored(recordings([Path(name) for name in sys.argv[1:]])):
        log = source.open()
        solution = fuse(log, named("wheels"))
        combs, trust = Combs.of(solution.learned[0]), Wheels({}).trust
        for speed, sd in BELIEVED:
            comb, windows = combs.at(speed), heard(log, speed)
            alone = sum(peak(replace(comb, levels=SILENT), w, sd, trust) is not None for w in windows)
            with_it = sum(peak(comb, w, sd, trust) is not None for w in windows)
            print(f"{log.name:16}{speed:9.1f} ± {sd:.1f} {len(windows):9}{alone:12}{with_it:15}")


if __name__ == "__main__":
    main()
