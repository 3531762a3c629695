"""Real recordings without outages: clocks found, distance to the reference, attitude, two boxes in one car.

python benchmarks/open_sky.py [RECORDING ...]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from outages import recordings

from gapless import earth, io
from gapless.evaluation import score
from gapless.evaluation.interpolation import interpolate
from gapless.runs.fuse import fuse
from gapless.trip.solution import Solution


def offsets(solution: Solution) -> dict[str, float]:
    """Clock offset by channel [s]."""
    name = "clock offset, "
    return {
        d.name.removeprefix(name): float(d.value)  # type: ignore[arg-type]
        for d in solution.decisions
        if d.name.startswith(name)
    }


def agreement(one: Solution, other: Solution) -> float:
    """RMS horizontal distance of two boxes in one car, each on its own clock brought to GNSS time."""
    late, its = offsets(one)["position"], offsets(other)["position"]
    t = one.trajectory.time - late
    found = interpolate(other.trajectory, t + its)
    apart = earth.lla_to_ned(found.lla, one.trajectory.lla[0]) - earth.lla_to_ned(
        one.trajectory.lla, one.trajectory.lla[0]
    )
    return float(np.sqrt(np.nanmean(np.sum(apart[:, :2] ** 2, axis=1))))


def main() -> None:
    """Print a row a recording."""
    solutions = {}
    print(f"{'recording':<14} {'clock offsets, s':<50}RMSE m  fixes m   roll    pitch heading, deg")
    for folder in recordings([Path(name) for name in sys.argv[1:]]):
        recording = io.read(folder)
        solution = fuse(recording)
        solutions[Path(folder).name] = solution
        clocks = ", ".join(f"{name} {value:+.3f}" for name, value in offsets(solution).items())
        row = f"{Path(folder).name:<14} {clocks:<50}"
        if recording.reference is not None:
            scores = score(solution, recording)
            row += f"{scores.aided.horizontal_rmse:5.2f} {scores.fixes_rmse:8.2f}"
            a = scores.aided
            angles = np.degrees([a.roll_rmse, a.pitch_rmse, a.heading_rmse])
            if np.isfinite(angles).all():
                row += "".join(f"{angle:8.2f}" for angle in angles)
        print(row, flush=True)
    if {"beijing-e1", "beijing-e2"} <= set(solutions):
        apart = agreement(solutions["beijing-e1"], solutions["beijing-e2"])
        print(f"beijing-e1 and beijing-e2, one car, on GNSS time: {apart:.2f} m RMS apart horizontally")


if __name__ == "__main__":
    main()
