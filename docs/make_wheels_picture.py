"""The pictures of the page on wheels: spectra over hertz beside spectra over cycles per metre.

    python docs/make_wheels_picture.py

Simulates a car with tyres that shake it, takes the same windows as they are and warped to a constant
speed, and writes `docs/images/wheels-window.svg` (one window) and `docs/images/wheels-drive.svg` (all
of the drive). Needs the extra `figures`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from gapless.bridges.orders import LOWEST, ORDERS, PAD, STEP, WIDTH, WINDOW, warp, whiten
from gapless.simulate import CAR, simulate

IMAGES = Path(__file__).parent / "images"
POINTS = 512
DECIBEL = 10.0 / np.log(10.0)
INK, BEFORE, AFTER = "#1f2933", "#d64545", "#0b69a3"


def spectra(samples: Any, time: Any, speed: Any, end: float) -> tuple[Any, Any, float]:
    """Spectra, mean of six channels, of a window as it is and warped, and its mean speed."""
    part = samples[(samples[:, 0] > end - WINDOW - 0.4) & (samples[:, 0] < end + 0.4)]
    inside = (time >= end - WINDOW - 0.2) & (time <= end + 0.2)
    t, v = time[inside], speed[inside]
    found = []
    for course in (np.full(len(v), v.mean()), v):
        x = warp(part, t, course, end - WINDOW, end, POINTS)
        f = np.fft.rfft(x, PAD * POINTS, axis=1)
        found.append(whiten(np.abs(f) ** 2).mean(axis=0))
    return found[0], found[1], float(v[(t >= end - WINDOW)].mean())


def panels(path: Path, left: Any, right: Any, titles: tuple[str, str], marks: tuple[Any, Any]) -> None:
    """Two curves beside each other, as a small SVG."""
    mpl.use("svg")
    from matplotlib import pyplot as plt

    mpl.rcParams |= {"svg.hashsalt": "gapless", "svg.fonttype": "none", "path.simplify_threshold": 0.4}
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 3.0), sharey=True, layout="constrained")
    parts = zip(axes, (left, right), titles, marks, (BEFORE, AFTER), ("Hz", "cycles/m"), strict=True)
    for ax, (x, y), title, at, hue, unit in parts:
        for one in at:
            ax.axvline(one, color=INK, alpha=0.25, lw=0.8)
        ax.plot(np.round(x, 3), np.round(DECIBEL * y, 2), color=hue, lw=1.1)
        ax.set_xlim(x[0], x[-1])
        ax.set_title(title, fontsize=10, loc="left", color=INK)
        ax.set_xlabel(unit)
        ax.spines[["top", "right"]].set_visible(False)
    axes[0].set_ylabel("dB above what is around")
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def main() -> None:
    """Write both pictures."""
    drive = simulate("urban", "consumer", 500.0, 3, chassis=CAR)
    imu, truth = drive.imu, drive.reference
    assert truth is not None
    samples = np.column_stack(
        [imu.time - 0.5 * imu.dt, imu.dtheta / imu.dt[:, None], imu.dvel / imu.dt[:, None]]
    )
    speed = np.maximum(np.linalg.norm(truth.v_n, axis=1), 1e-3)
    around = CAR.wheels[0].circumference
    orders = LOWEST + STEP * np.arange(ORDERS)
    over = np.arange(400) * WIDTH
    windows = []
    for end in np.arange(truth.time[0] + 10.0, truth.time[-1] - 2.0, 1.0):
        inside = (truth.time > end - WINDOW - 0.3) & (truth.time < end + 0.3)
        if speed[inside].min() > 3.5:
            windows.append((float(np.ptp(speed[inside])), *spectra(samples, truth.time, speed, end)))
    hertz = np.mean([w[1][: len(over)] for w in windows], axis=0)
    warped = [np.interp(orders * w[3], np.arange(len(w[2])) * WIDTH, w[2]) for w in windows]
    harmonics = np.arange(1, int(orders[-1] * around) + 1) / around
    one = max((w for w in windows if w[0] > 2.0), key=lambda w: w[3])
    top = over / one[3] <= orders[-1]
    panels(
        IMAGES / "wheels-window.svg",
        (over[top], one[1][: len(over)][top]),
        (over[top] / one[3], one[2][: len(over)][top]),
        (f"4 s in which the speed changes by {one[0]:.1f} m/s", "the same 4 s, warped to constant speed"),
        ((), harmonics),
    )
    panels(
        IMAGES / "wheels-drive.svg",
        (over, hertz),
        (orders, np.mean(warped, axis=0)),
        (f"mean of {len(windows)} windows, over hertz", "the same, warped, over cycles per metre"),
        ((), harmonics),
    )


if __name__ == "__main__":
    main()
