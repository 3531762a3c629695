"""Cubature moments against Taylor's: what the covariance costs, as ratios of one run.

    python benchmarks/cubature.py

The two kernels take turns over the same increments, and medians over the turns are compared; then what the
further states cost either of them.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from kernel import ACCEL, ACCEL_BIAS, GYRO, GYRO_BIAS, RATE, START, TAU, drive

from gapless.inertial.cubature import propagate_points
from gapless.inertial.layout import ROW, Layout
from gapless.inertial.propagate import MEMORY_SIZE, propagate

SAMPLES, TURNS = 20_000, 9
BLOCKS = {"15 states": (), "27 states": ("gyro_scale", "accel_scale", "gravity", "lever_arm")}


def run(function: Callable[..., int], imu: np.ndarray, extras: tuple[str, ...], period: float) -> float:
    """Seconds of one run."""
    layout = Layout(extras)
    x, p = np.zeros(layout.n + 1), np.zeros((ROW, ROW))
    x[:6], x[6] = START, 1.0
    p[range(layout.n), range(layout.n)] = 1e-4
    noise = np.array([GYRO**2, ACCEL**2, *(2.0 / TAU * s**2 for s in (GYRO_BIAS, ACCEL_BIAS)), 0.0, 0.0, 0.0])
    columns = (
        np.ascontiguousarray(c) for c in (imu[:, 0], np.full(SAMPLES, 1.0 / RATE), imu[:, 1:4], imu[:, 4:7])
    )
    scratch, memory = np.zeros((2, ROW * ROW)), np.zeros(MEMORY_SIZE)
    state = (x, memory, layout.width, p.ravel(), scratch, np.zeros(0), layout.offsets, noise)
    begin = time.perf_counter()
    function(*state, *columns, 0, SAMPLES, period, 1e9, False)
    return time.perf_counter() - begin


def main() -> None:
    imu = drive()[:SAMPLES]
    for function in (propagate, propagate_points):
        run(function, imu, (), 0.05)
    base = 0.0
    for name, extras in BLOCKS.items():
        for period, text in ((0.05, "20 Hz"), (0.0, "every sample")):
            taylor, cubature = [], []
            for _ in range(TURNS):
                taylor.append(run(propagate, imu, extras, period))
                cubature.append(run(propagate_points, imu, extras, period))
            one, other = (statistics.median(t) / SAMPLES * 1e6 for t in (taylor, cubature))
            base = base or one
            points = 2 * Layout(extras).n
            print(
                f"{name}, covariance at {text:12s}: Taylor {one:5.2f} us a sample ({one / base:5.2f} of the "
                f"first), cubature of {points} points {other:6.2f} us, {other / one:4.1f} times"
            )


if __name__ == "__main__":
    main()
