"""The same drives as other loggers would have recorded them: what each disturbance costs in outages of 60 s.

    python benchmarks/disturbed.py [RECORDING ...] [--systems constraints,auto]

Each recording is changed in one way only, a part of each. Truth is what it was. Outages begin every 180 s
from 240 s on; the largest horizontal error of each, and how many end in their 95 % ellipse.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from outages import recordings
from scipy.spatial.transform import Rotation

from gapless.evaluation import score
from gapless.laboratory.pool import in_order
from gapless.laboratory.study import Source, stored
from gapless.runs.fuse import fuse
from gapless.scenarios import plan
from gapless.systems.adjust import named
from gapless.trip.recording import Imu, Recording
from gapless.units import DEG

Change = Callable[[Recording], Recording]


def turned(roll: float, pitch: float, yaw: float, log: Recording) -> Recording:
    """The box sits askew by so many degrees."""
    m = Rotation.from_euler("ZYX", [yaw, pitch, roll], degrees=True).as_matrix()
    return replace(log, imu=replace(log.imu, dtheta=log.imu.dtheta @ m.T, dvel=log.imu.dvel @ m.T))


def felt(gyro: Sequence[float], accel: Sequence[float], drift: Sequence[float], log: Recording) -> Recording:
    """Biases [deg/s, m/s^2], and a gyro drift [deg/s in 1000 s]."""
    imu, since = log.imu, (log.imu.time - log.imu.time[0]) / 1000.0
    rate = (np.asarray(gyro) + since[:, None] * np.asarray(drift)) * DEG
    dvel = imu.dvel + np.asarray(accel) * imu.dt[:, None]
    return replace(log, imu=replace(imu, dtheta=imu.dtheta + rate * imu.dt[:, None], dvel=dvel))


def scaled(log: Recording) -> Recording:
    """Gyros and accelerometers read one per cent too much or too little."""
    off = np.array([1.01, 0.99, 1.01])
    return replace(log, imu=replace(log.imu, dtheta=log.imu.dtheta * off, dvel=log.imu.dvel / off))


def halved(log: Recording) -> Recording:
    """Two samples of the IMU in one, down to 50 Hz."""
    imu = log.imu
    if imu.rate < 70.0:
        return log
    n = len(imu) // 2 * 2
    pairs = (x[:n:2] + x[1:n:2] for x in (imu.dt, imu.dtheta, imu.dvel))
    return replace(log, imu=Imu(imu.time[1:n:2], *pairs))


def thinned(log: Recording) -> Recording:
    """A fix a second."""
    step = max(1, round(1.0 / float(np.median(np.diff(log.gnss.time)))))
    return replace(log, gnss=log.gnss.take(slice(None, None, step)))


def mute(log: Recording) -> Recording:
    """No velocities."""
    return replace(log, gnss=replace(log.gnss, v_n=np.full_like(log.gnss.v_n, np.nan)))


def late(seconds: float, log: Recording) -> Recording:
    """The receiver's clock is off, and with it a reference that is on it."""
    changed = replace(log, gnss=replace(log.gnss, time=log.gnss.time + seconds))
    truth = log.reference
    if truth is None or log.reference_clock != "gnss":
        return changed
    return replace(changed, reference=replace(truth, time=truth.time + seconds))


CHANGES: dict[str, Change] = {
    "as logged": lambda log: log,
    "box turned by 10, -8, 15 deg": partial(turned, 10.0, -8.0, 15.0),
    "box turned by 5, -20, 40 deg": partial(turned, 5.0, -20.0, 40.0),
    "biases of 0.3-0.5 deg/s, 0.2-0.4 m/s2": partial(felt, (0.3, -0.5, 0.4), (0.3, -0.2, 0.4), (0.0,) * 3),
    "gyros drift by 0.1-0.2 deg/s in 1000 s": partial(felt, (0.0,) * 3, (0.0,) * 3, (0.2, -0.1, 0.15)),
    "scales off by 1 %": scaled,
    "IMU at 50 Hz": halved,
    "fixes at 1 Hz": thinned,
    "fixes without velocity": mute,
    "GNSS stamps 0.5 s late": partial(late, 0.5),
    "GNSS stamps 3 s early": partial(late, -3.0),
}


class Job(NamedTuple):
    """One recording, changed, with one system."""

    source: Source
    change: str
    system: str


def errors(job: Job) -> list[tuple[float, bool]]:
    """Largest error of each outage that counts [m], and whether it ends in its 95 % ellipse."""
    log = job.source.open()
    changed = CHANGES[job.change](log)
    outages = plan(["every=180,length=60,first=240"], changed.duration)
    scores = score(fuse(replace(changed, reference=None), named(job.system), outages), changed)
    return [(o.horizontal_max, o.inside_95_end > 0.5) for o in scores.outages if not o.labels]


def main() -> None:
    """Print a line for each change and system."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", nargs="*", type=Path)
    parser.add_argument("--systems", default="constraints,auto")
    given = parser.parse_args()
    sources, systems = stored(recordings(given.recordings)), given.systems.split(",")
    jobs = [Job(source, c, s) for c in CHANGES for s in systems for source in sources]
    found = in_order(errors, jobs, 2)
    print(f"{'':40}{'system':14}{'n':>4}{'mean':>7}{'median':>8}{'P90':>7}{'worst':>7}{'inside':>8}   m")
    for change in CHANGES:
        for system in systems:
            told = [one for _ in sources for one in next(found)]
            e = np.array([error for error, _ in told])
            mean = np.exp(np.log(np.maximum(e, 0.5)).mean())
            inside = f"{sum(within for _, within in told)}/{len(told)}"
            print(
                f"{change:40}{system:14}{len(e):4}{mean:7.1f}{np.median(e):8.1f}{np.percentile(e, 90.0):7.1f}"
                f"{e.max():7.1f}{inside:>8}",
                flush=True,
            )


if __name__ == "__main__":
    main()
