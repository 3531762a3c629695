"""The compiled kernel against a hand-tuned C filter: same increments, same run, no fixes.

    python benchmarks/kernel.py

The C source (`ekf15.c`) is a measuring stick that lives outside this repository: in the folder
named by GAPLESS_LIMIT, or else in `../shared/limit`. It runs in a process of its own, because a
library built with -ffast-math switches the whole process to flush-to-zero. The two take turns, a
short run each, and the medians over all turns are compared.
"""

from __future__ import annotations

import ctypes
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
LIMIT = Path(os.environ.get("GAPLESS_LIMIT", ROOT.parent / "shared" / "limit")) / "ekf15.c"
FLAGS = ["-O3", "-march=native", "-ffast-math", "-mprefer-vector-width=512", "-shared", "-fPIC"]
SAMPLES, RATE, TURNS = 72_000, 200.0, 25
GYRO, ACCEL, GYRO_BIAS, ACCEL_BIAS, TAU = 1e-4, 1e-2, 1e-6, 1e-4, 3600.0
"""Random walks [rad/sqrt s, m/s/sqrt s], bias deviations [rad/s, m/s^2], correlation time [s]."""
START = (0.7, 0.3, 100.0, 10.0, 0.0, 0.0)
"""Latitude, longitude [rad], height [m], velocity [m/s]."""
COMBINATIONS = (
    ("none", (), 0.0, 1),
    ("none", (), 0.05, 10),
    ("mounting, axle", ("mounting", "axle"), 0.0, 0),
)
"""Optional states, covariance period [s], the same in samples for C (0: C has no such states)."""


def drive() -> np.ndarray:
    """Time, angle and velocity increments of a level, noisy, slowly swaying vehicle; (n, 7)."""
    rng = np.random.default_rng(0)
    time_ = np.arange(1, SAMPLES + 1) / RATE
    dtheta = rng.normal(0.0, 1e-4, (SAMPLES, 3))
    dtheta[:, 2] += 0.2 * np.sin(0.3 * time_) / RATE
    dvel = rng.normal(0.0, 1e-2, (SAMPLES, 3))
    dvel[:, 2] -= 9.8 / RATE
    return np.column_stack([time_, dtheta, dvel])


def serve_c(library: str) -> None:
    """In a process of its own: one run of the C filter for each line read, its seconds printed."""
    imu = np.ascontiguousarray(drive())
    double = ctypes.POINTER(ctypes.c_double)
    run = ctypes.CDLL(library).ekf15
    noise = [GYRO, ACCEL, GYRO_BIAS, ACCEL_BIAS, TAU, 1.0, 0.1, 0.0, 0.0, 0.0, 1.0, 0.1, 0.01, 0.1]
    tables = [np.array(noise), np.array([*START, 0.0, 0.0, 0.0]), np.zeros((SAMPLES, 10))]
    data, parameters, start, out = (a.ctypes.data_as(double) for a in (imu, *tables))
    for line in sys.stdin:
        every, begin = ctypes.c_int(int(line)), time.perf_counter()
        run(ctypes.c_long(SAMPLES), data, ctypes.c_long(0), data, 0, parameters, start, every, 0, out, None)
        print(time.perf_counter() - begin, flush=True)


def run_ours(imu: np.ndarray, extras: tuple[str, ...], period: float) -> float:
    """Seconds of one run of our kernel."""
    from gapless.inertial.layout import ROW, Layout
    from gapless.inertial.propagate import MEMORY_SIZE, propagate

    layout = Layout(extras)
    x, p = np.zeros(16 + layout.n - 15), np.zeros((ROW, ROW))
    x[:6], x[6] = START, 1.0
    p[range(layout.n), range(layout.n)] = 0.01
    drift = [2.0 / TAU * s**2 for s in (GYRO_BIAS, ACCEL_BIAS)]
    noise = np.array([GYRO**2, ACCEL**2, *drift, 0.0, 1.0 / TAU, 1.0 / TAU])
    time_, dtheta, dvel = (np.ascontiguousarray(c) for c in (imu[:, 0], imu[:, 1:4], imu[:, 4:7]))
    dt, memory, scratch = np.full(SAMPLES, 1.0 / RATE), np.zeros(MEMORY_SIZE), np.zeros((2, ROW * ROW))
    state = (x, memory, layout.width, p.ravel(), scratch, np.zeros(0), layout.offsets, noise)
    begin = time.perf_counter()
    propagate(*state, time_, dt, dtheta, dvel, 0, SAMPLES, period, 1e9, False)
    return time.perf_counter() - begin


def start_c(folder: str) -> subprocess.Popen[str] | None:
    """Compile and start the C filter, or say why there is none."""
    if not LIMIT.exists():
        print(f"no C filter at {LIMIT} (set GAPLESS_LIMIT to its folder): our own speed only")
        return None
    library = str(Path(folder) / "libekf15.so")
    subprocess.run(["gcc", *FLAGS, "-o", library, str(LIMIT), "-lm"], check=True)
    command = [sys.executable, __file__, library]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def run_c(process: subprocess.Popen[str], every: int) -> float:
    """Seconds of one run of the C filter."""
    assert process.stdin is not None
    assert process.stdout is not None
    print(every, file=process.stdin, flush=True)
    return float(process.stdout.readline())


def main() -> None:
    imu = drive()
    begin = time.perf_counter()
    run_ours(imu, (), 0.0)
    print(f"import, compilation or cache, first run: {time.perf_counter() - begin:.2f} s")
    with tempfile.TemporaryDirectory() as folder:
        c = start_c(folder)
        for name, extras, period, every in COMBINATIONS:
            ours, theirs = [], []
            for _ in range(TURNS):
                ours.append(run_ours(imu, extras, period))
                if c is not None and every:
                    theirs.append(run_c(c, every))
            median = statistics.median(ours)
            rate = f"{1.0 / period:.0f} Hz" if period else "every sample"
            text = f"optional states {name:15s} covariance {rate:13s} ours {SAMPLES / median / 1e6:5.2f} M/s"
            if theirs:
                limit = statistics.median(theirs)
                text += f"  C {SAMPLES / limit / 1e6:5.2f} M/s  ratio {limit / median:4.0%}"
                text += f" (of the fastest runs {min(theirs) / min(ours):4.0%})"
            print(text)
        if c is not None:
            c.communicate()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        serve_c(sys.argv[1])
    else:
        main()
