"""Denoising: how fast, and how much of the noise goes; whole records, and causal windows.

    python benchmarks/denoise.py [--duration 2400] [--seed 1]

Speed is given as ratios within one run: our decomposition against PyEMD's of the same signal (with
as many siftings, and with its own rule of when to stop), EMD-CIIT against the time that the record
lasts. What is gained is the mean over six channels of the SNR denoised less that of the raw signal,
on a simulated drive with the sensors of liu2019; against the error-free increments (its biases count
as noise, which no denoiser can take away) and against the same increments with their biases.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from PyEMD import EMD

from gapless.denoise import EmdCiit, Windowed
from gapless.denoise.compare import CHANNELS, Row, compare, whole_and_causal
from gapless.denoise.imu import denoised
from gapless.denoise.sifting import SIFTINGS, decompose
from gapless.sensors import grade
from gapless.simulate import simulate
from gapless.trip.recording import Imu

RATE = 100.0
SHORT = 30_000
"""Samples that PyEMD is given: its time grows faster than the number of samples."""
FACTORS = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
"""C of the thresholds to try."""


def seconds(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def drives(duration: float, seed: int) -> tuple[Imu, Imu, Imu]:
    """Measured by the sensors of liu2019, without any error, and without noise but with biases."""
    measured = grade("liu2019")
    grades = (measured, grade("perfect"), replace(measured, gyro_noise=0.0, accel_noise=0.0))
    imus = [simulate("urban", g, duration, seed, rate=RATE).imu for g in grades]
    return imus[0], imus[1], imus[2]


def decomposition() -> None:
    rng = np.random.default_rng(0)
    x = rng.normal(size=240_000) + 0.05 * np.cumsum(rng.normal(size=240_000))
    decompose(x[:1000])
    short, long = seconds(lambda: decompose(x[:SHORT])), seconds(lambda: decompose(x))
    same = seconds(lambda: EMD(FIXE=SIFTINGS, range_thr=0.0, total_power_thr=0.0)(x[:SHORT]))
    own = seconds(lambda: EMD()(x[:SHORT]))
    print(f"one decomposition: ours {short:.3f} s for {SHORT} samples, {long:.2f} s for 240000;")
    print(f"PyEMD, of the former, takes {same / short:.0f} times as long with as many siftings,")
    print(f"and {own / short:.0f} times by its own rule")


def speed(measured: Imu, duration: float) -> None:
    whole = seconds(lambda: denoised(measured, EmdCiit()))
    print(f"EMD-CIIT, whole record of {duration:g} s, 6 channels, all cores: {whole:.1f} s")
    causal, channels = Windowed(EmdCiit()), np.hstack([measured.dtheta, measured.dvel]).T * RATE
    took = seconds(lambda: [causal(x, RATE) for x in channels])
    print(f"EMD-CIIT, causal, 6 channels, one core: {duration / took:.0f} times real time")


def show(title: str, rows: list[Row]) -> None:
    print(f"\n{title}, dB\n{'':18s}" + "".join(f"{c:>8s}" for c in CHANNELS) + "    gain")
    for row in rows:
        print(f"{row.name:18s}" + "".join(f"{v:8.2f}" for v in row.snr) + f"{row.gain(rows[0]):8.2f}")
    gains = {row.name: row.gain(rows[0]) for row in rows}
    kept = [f"{n} {gains[f'{n}, causal'] / g:.2f}" for n, g in gains.items() if f"{n}, causal" in gains]
    if kept:
        print("share of the gain that the causal form keeps: " + ", ".join(kept))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--duration", type=float, default=2400.0, help="of the simulated drive [s]")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    decomposition()
    measured, truth, biased = drives(options.duration, options.seed)
    speed(measured, options.duration)
    each = whole_and_causal()
    show("SNR against the error-free signal", compare(truth, measured, each))
    show("SNR against the signal with its biases", compare(biased, measured, each))
    factors = {f"EMD-CIIT, C = {c:g}": EmdCiit(factor=c) for c in FACTORS}
    show("SNR against the signal with its biases", compare(biased, measured, factors))


if __name__ == "__main__":
    main()
