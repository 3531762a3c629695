"""Outages by physics alone, on real recordings: the classical ladder.

    python benchmarks/outages.py [RECORDING ...] [--length 60]

`gapless bench` with recipes that add one constraint after the other. Recordings default to the folders in
GAPLESS_RECORDINGS or ../shared/data.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from gapless.laboratory.bench import bench
from gapless.laboratory.recipes import Recipe
from gapless.laboratory.render import as_text
from gapless.laboratory.study import PASSES, ladder, stored
from gapless.laboratory.tables import tables
from gapless.reports import summarise
from gapless.systems.recipe import System

GNSS = ("position", "velocity")
LADDER = (
    System(name="ins", sensors=GNSS, constraints=()),
    System(name="+ zero velocity", sensors=GNSS, constraints=("zero_velocity",)),
    System(name="+ non-holonomic", sensors=GNSS),
    System(name="+ odometer"),
)


def recordings(given: Sequence[Path]) -> Sequence[Path]:
    """Folders to run."""
    for path in given:
        if not (path / "recording.toml").is_file():
            raise SystemExit(f"{path}: no recording.toml in there; name the folder of a recording")
    if given:
        return given
    root = Path(os.environ.get("GAPLESS_RECORDINGS", Path(__file__).parents[1] / "../shared/data"))
    found = sorted(path.parent for path in root.glob("*/recording.toml"))
    if not found:
        raise SystemExit(f"no recordings in {root}; name their folders or set GAPLESS_RECORDINGS")
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", nargs="*", type=Path)
    parser.add_argument("--length", type=float, default=60.0)
    given = parser.parse_args()
    scenarios = ladder([given.length], 180.0, (0.0, 60.0, 120.0), 240.0)
    methods = [Recipe(system) for system in LADDER]
    results = bench(
        stored(recordings(given.recordings)), methods, scenarios, [PASSES], summarise, processes=2
    )
    print(as_text(tables(results)))
    print(f"{len(results.runs)} runs in {results.seconds:.0f} s")


if __name__ == "__main__":
    main()
