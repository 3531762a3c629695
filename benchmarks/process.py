"""The whole process: 46 MB of KF-GINS text in, results out, warm.

    python benchmarks/process.py

`gapless fuse IMU.txt GNSS.txt --no-report` against a floor: Python with NumPy, a C parser of thirty
lines and the C filter of `benchmarks/kernel.py` (covariance at every sample, as it comes; and at 20 Hz,
as ours), its output thinned to 10 Hz and saved as .npy. The floor checks nothing, mends nothing and
aligns with the answer in hand.
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
from kernel import FLAGS, LIMIT

ROWS, RATE, REPEATS = 360_000, 200.0, 5
GAPLESS = Path(sys.executable).with_name("gapless")
PARSER = r"""
#include <stdio.h>
#include <stdlib.h>
/* Whole file into memory, decimal numbers (no exponents) one after another; how many there were. */
long parse(const char *path, double *out, long most) {
  FILE *file = fopen(path, "rb");
  if (!file) return -1;
  fseek(file, 0, SEEK_END);
  long size = ftell(file), n = 0;
  rewind(file);
  char *text = malloc(size + 1), *at = text;
  if (fread(text, 1, size, file) != (size_t)size) return -1;
  fclose(file);
  text[size] = 0;
  while (n < most) {
    while (*at && *at <= ' ') at++;
    if (!*at) break;
    int minus = *at == '-';
    at += minus;
    unsigned long digits = 0;
    double scale = 1.0;
    for (; *at >= '0' && *at <= '9'; at++) digits = 10 * digits + (*at - '0');
    if (*at == '.')
      for (at++; *at >= '0' && *at <= '9'; at++, scale *= 10.0) digits = 10 * digits + (*at - '0');
    out[n++] = (minus ? -1.0 : 1.0) * (double)digits / scale;
  }
  free(text);
  return n;
}
"""


def write_recording(folder: Path) -> tuple[Path, Path]:
    """Half an hour in a city: IMU.txt at 200 Hz and GNSS.txt at 1 Hz with deviations."""
    from gapless.simulate.motion import increments, trajectory
    from gapless.simulate.path import Path as Route
    from gapless.simulate.profiles import profile

    rng = np.random.default_rng(0)
    segments = profile("urban")(ROWS / RATE, rng)
    route = Route.from_segments(segments, (0.7, 0.3, 100.0), heading=0.5, roll_gradient=0.005)
    imu = increments(route, RATE)
    dtheta = imu.dtheta + rng.normal(0.0, 1e-4 / RATE**0.5, imu.dtheta.shape) + 1e-4 / RATE
    dvel = imu.dvel + rng.normal(0.0, 1e-3 / RATE**0.5, imu.dvel.shape) + 1e-2 / RATE
    np.savetxt(folder / "IMU.txt", np.column_stack([1000.0 + imu.time, dtheta, dvel]), "%.15f")
    truth = trajectory(route, np.arange(1.0, ROWS / RATE))
    metres = rng.normal(0.0, 1.0, (len(truth.time), 3)) * [1.0, 1.0, 2.0]
    lla = truth.lla + metres / [6.37e6, 6.38e6 * np.cos(0.7), 1.0]
    v_n = truth.v_n + rng.normal(0.0, 0.1, truth.v_n.shape)
    sd = np.tile([1.0, 1.0, 2.0], (len(lla), 1))
    rows = [1000.0 + truth.time, np.degrees(lla[:, :2]), lla[:, 2], sd, v_n, np.full_like(v_n, 0.1)]
    np.savetxt(folder / "GNSS.txt", np.column_stack(rows), "%.12f")
    return folder / "IMU.txt", folder / "GNSS.txt"


def compile_floor(folder: Path) -> list[str]:
    """Command of the floor, its two libraries compiled."""
    (folder / "parse.c").write_text(PARSER)
    build = ["gcc", "-O3", "-shared", "-fPIC", "-o", str(folder / "parse.so"), str(folder / "parse.c")]
    subprocess.run(build, check=True)
    subprocess.run(["gcc", *FLAGS, "-o", str(folder / "ekf15.so"), str(LIMIT), "-lm"], check=True)
    return [sys.executable, __file__, str(folder)]


def run_floor(folder: Path, decimation: int) -> None:
    """In a process of its own: parse, filter, save."""
    double = ctypes.POINTER(ctypes.c_double)
    parse = ctypes.CDLL(str(folder / "parse.so")).parse
    parse.restype = ctypes.c_long

    def load(name: str, width: int) -> np.ndarray:
        path = folder / name
        table = np.empty(path.stat().st_size // 8)
        count = parse(os.fsencode(path), table.ctypes.data_as(double), ctypes.c_long(len(table)))
        return table[:count].reshape(-1, width)

    imu, fixes = load("IMU.txt", 7), load("GNSS.txt", 13)
    gnss = np.ascontiguousarray(fixes[:, [0, 1, 2, 3, 7, 8, 9]])
    gnss[:, 1:3] *= np.pi / 180.0
    noise = np.array([1e-4, 1e-3, 1e-4, 1e-2, 3600.0, 1.0, 0.1, 0.0, 0.0, 0.0, 1.0, 0.1, 0.01, 0.1])
    start = np.array([*gnss[0, 1:], 0.0, 0.0, 0.5])
    out, sd = np.empty((len(imu), 10)), np.empty((len(imu), 15))
    imu_, gnss_, noise_, start_, out_, sd_ = (
        a.ctypes.data_as(double) for a in (imu, gnss, noise, start, out, sd)
    )
    n, m, k = ctypes.c_long(len(imu)), ctypes.c_long(len(gnss)), decimation
    ctypes.CDLL(str(folder / "ekf15.so")).ekf15(n, imu_, m, gnss_, 1, noise_, start_, k, 1, out_, sd_)
    thin = int(RATE / 10.0)
    np.save(folder / "floor.npy", np.column_stack([out[::thin], sd[::thin, :9]]))


def measure(command: list[str]) -> tuple[float, float]:
    """Seconds and peak megabytes of one process; ends the benchmark if it fails."""
    with tempfile.TemporaryFile() as said:
        begin = time.perf_counter()
        process = subprocess.Popen(command, stdout=said, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            said.seek(0)
            sys.exit(f"{' '.join(command[:2])} failed:\n{said.read().decode()[-2000:]}")
    return seconds, usage.ru_maxrss / 1024.0


def main() -> None:
    if not GAPLESS.exists():
        sys.exit(f"no command at {GAPLESS}: install the package into this environment first")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        imu, gnss = write_recording(folder)
        print(
            f"{imu.stat().st_size / 1e6:.1f} MB of IMU text, {gnss.stat().st_size / 1e6:.1f} MB of GNSS text"
        )
        ours = [str(GAPLESS), "fuse", str(imu), str(gnss), "--no-report", "--out", str(folder / "out")]
        print(f"first run (kernels compiled if they were not): {measure(ours)[0]:.2f} s")
        commands = {"gapless fuse": ours}
        if LIMIT.exists():
            floor = compile_floor(folder)
            commands |= {"floor in C": [*floor, "1"], "floor in C, covariance at 20 Hz": [*floor, "10"]}
        else:
            print(f"no C filter at {LIMIT} (set GAPLESS_LIMIT to its folder): our own time only")
        runs: dict[str, list[tuple[float, float]]] = {}
        for _ in range(REPEATS):
            for name, command in commands.items():
                runs.setdefault(name, []).append(measure(command))
        medians = {name: statistics.median(seconds for seconds, _ in taken) for name, taken in runs.items()}
        for name, taken in runs.items():
            print(f"{name}: {medians[name]:.2f} s, peak {max(peak for _, peak in taken):.0f} MB")
        for name in list(medians)[1:]:
            print(f"ratio to the {name}: {medians['gapless fuse'] / medians[name]:.1f}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run_floor(Path(sys.argv[1]), int(sys.argv[2]))
    else:
        main()
