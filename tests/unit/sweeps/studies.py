"""What the tests of sweeps share."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pyarrow.parquet as pq

import gapless as gp
from gapless.sweeps.run import Run
from gapless.sweeps.sources import Simulated

SOURCES = str(Path(gp.__file__).parents[1])
ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join([SOURCES, *sys.path])}
"""For processes that must find the same gapless, and the modules beside a test."""


def run(seed=1, profile="urban", scenario=("65:90",), system="constraints", **rest):
    """100 s, of which the first 30 at rest; an outage counts from 60 s on."""
    return Run(Simulated(profile, "consumer", 100.0), scenario, gp.load_system(system), seed=seed, **rest)


def study(folder, seeds=20, name="tiny", **keys):
    """A study file of as many runs as there are seeds, times two systems."""
    lines = [f'name = "{name}"', 'systems = ["ins", "constraints"]', 'scenarios = ["65:90"]']
    lines += [f"{key} = {value}" for key, value in keys.items()]
    lines += ["[simulated]", f"seeds = {{ count = {seeds} }}", "duration = 100"]
    path = folder / f"{name}.toml"
    path.write_text("\n".join(lines), "utf-8")
    return path


def uninterrupted(path, out):
    """The same study without anything that could go wrong: one thread of this process."""
    with ThreadPoolExecutor(1) as executor:
        return gp.sweep(path, out, executor)


def rows(out):
    """Every run and outage, to the last bit; text, since NaN is not equal to itself."""
    return [repr(gp.read_sweep(str(out), table).to_pylist()) for table in ("runs", "outages")]


def stored(out):
    """Keys in the parts themselves, whatever reading would make of repeated ones."""
    parts = Path(out).glob("study=*/part-*.parquet")
    return [key for part in parts for key in pq.ParquetFile(part).read(["key"])["key"].to_pylist()]
