"""How soon the page of two million samples opens, and how large it is.

python benchmarks/page.py [SAMPLES]

A made-up solution of a simulated drive, 200 rows a second, with everything that a page shows: biases and
their standard deviations, innovations, a reference, an outage every ten minutes. Opened in headless
Chromium, of which GAPLESS_CHROMIUM may name one; a page counts as open when what is on the screen is drawn.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import gapless as gp
from gapless.evaluation import score
from gapless.reports import write_report
from gapless.trip.recording import Imu, Recording, Trajectory
from gapless.trip.solution import Decision, Innovations, Solution

RATE = 200.0
RUNS = 5
QUIET = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)
DRAWN = """() => new Promise(done =>
    requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now()))))"""


def made_up(samples: int) -> tuple[Solution, Recording]:
    """A solution of so many rows, and the recording that it might be of."""
    lap = gp.simulate_drive("urban", "consumer", duration=1800.0, seed=1)
    truth = lap.reference
    assert truth is not None
    t = np.arange(samples) / RATE
    rng = np.random.default_rng(1)
    # There and back again, as often as it takes: the drive is 1800 s.
    span = float(truth.time[-1] - truth.time[0])
    at = truth.time[0] + np.abs((t + span) % (2 * span) - span)

    def along(column: np.ndarray) -> np.ndarray:
        return np.column_stack([np.interp(at, truth.time, c) for c in column.T])

    outages = [(float(s), float(s) + 60.0) for s in range(300, int(t[-1]) - 60, 600)]
    age = np.zeros(samples)
    for a, b in outages:
        inside = (t >= a) & (t < b)
        age[inside] = t[inside] - a
    sd = np.abs(rng.standard_normal((samples, 9))) * 0.01 + 0.5 + 0.05 * age[:, None]
    lla = along(truth.lla) + 0.02 * age[:, None] * np.array([1.6e-7, 1.6e-7, 1.0])
    trajectory = Trajectory(
        t, lla, along(truth.v_n), along(np.unwrap(truth.euler, axis=0)), sd, np.zeros(samples),
        np.where(age > 0, "constraints", "gnss"),
    )  # fmt: skip
    states = {
        name: np.cumsum(rng.standard_normal((samples, 3)), 0) * 1e-6 for name in ("gyro_bias", "accel_bias")
    }
    innovations = {}
    for name, every in (("position", 200), ("velocity", 200), ("nonholonomic", 20)):
        rows = np.arange(0, samples, every)
        z = rng.standard_normal((len(rows), 2 if name == "nonholonomic" else 3))
        innovations[name] = Innovations(t[rows], z, np.ones_like(z), (z**2).sum(1), np.ones(len(rows)))
    states_sd = {name: np.full_like(values, 1e-4) for name, values in states.items()}
    solution = Solution(
        "two-million", "constraints", trajectory, states, states_sd, innovations,
        (Decision("grade", "consumer", "", "default", "none named"),), tuple(outages), 0.0,
    )  # fmt: skip
    imu = Imu.from_rates(t, np.zeros((samples, 3)), np.zeros((samples, 3)))
    every = slice(None, None, 20)
    unknown = np.full((samples, 9), np.nan)
    reference = Trajectory(
        t, along(truth.lla), trajectory.v_n, trajectory.euler, unknown, unknown[:, 0],
        np.full(samples, "reference"),
    ).take(every)  # fmt: skip
    return solution, Recording("two-million", imu, lap.gnss, None, reference)


def opened(path: Path) -> list[float]:
    """Seconds until the page is drawn, from nothing, several times."""
    from playwright.sync_api import sync_playwright

    browser_path = os.environ.get("GAPLESS_CHROMIUM") or shutil.which("chromium")
    found = []
    with sync_playwright() as running:
        browser = running.chromium.launch(executable_path=browser_path, args=list(QUIET), headless=True)
        for _ in range(RUNS):
            context = browser.new_context(viewport={"width": 1440, "height": 900})
            tab = context.new_page()
            tab.goto(path.as_uri())
            found.append(tab.evaluate(DRAWN) / 1000.0)  # since the navigation began
            context.close()
        browser.close()
    return found


def main() -> None:
    """Make the page, weigh it, open it."""
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else 2_000_000
    solution, recording = made_up(samples)
    scores = score(solution, recording)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "report.html"
        begun = time.perf_counter()
        write_report(solution, recording, scores, path)
        print(f"{samples} rows, {samples / RATE:.0f} s at {RATE:.0f} Hz, {len(solution.outages)} outages")
        print(f"written in {time.perf_counter() - begun:.1f} s, {path.stat().st_size / 1e6:.2f} MB")
        seconds = sorted(opened(path))
    print(
        f"open and drawn after {seconds[len(seconds) // 2]:.2f} s (median of {RUNS}), "
        f"{seconds[-1]:.2f} s at worst"
    )


if __name__ == "__main__":
    main()
