"""How often the truth lies in the ellipses that are stated: by age of the outage, and by recording.

    gapless bench LOG... --systems constraints,auto --length 60 --out DIR
    python benchmarks/ellipses.py DIR... [--systems constraints,auto]

Shares of the epochs in 50, 95 and 99 % ellipses, pooled and by age; then, by recording, the share of outages
whose last epoch lies in the 95 % one. Epochs of an outage are anything but independent, ends of different
outages nearly are: so it is of these that a binomial interval is given (Clopper and Pearson, 95 %).
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from scipy.stats import beta, chi2

LEVELS = (0.50, 0.95, 0.99)
AGES = (0.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0)
KEY = ["recording", "system", "protocol", "scenario", "start"]


def interval(k: int, n: int) -> tuple[float, float]:
    """95 % interval of a share of which k of n were seen."""
    low = beta.ppf(0.025, k, n - k + 1) if k else 0.0
    high = beta.ppf(0.975, k + 1, n - k) if k < n else 1.0
    return float(low), float(high)


def shares(nees) -> str:
    """Shares within the ellipses, in per cent."""
    return " ".join(f"{100.0 * np.mean(nees <= chi2.ppf(p, 2)):7.1f}" for p in LEVELS)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--systems", default="constraints,auto")
    given = parser.parse_args()
    for folder in given.folders:
        outages = pq.read_table(folder / "outages.parquet").to_pandas()
        outages = outages[outages["labels"].str.len() == 0]
        epochs = pq.read_table(folder / "ages.parquet").to_pandas().merge(outages[KEY], on=KEY)
        epochs = epochs[np.isfinite(epochs["nees"])]
        for system in given.systems.split(","):
            mine, ends = epochs[epochs["system"] == system], outages[outages["system"] == system]
            print(f"\n{folder}, {system}: {len(ends)} outages; epochs in 50, 95, 99 % ellipses [%]")
            print(f"{'all':14}{len(mine):7} {shares(mine['nees'])}")
            for a, b in itertools.pairwise(AGES):
                part = mine[(mine["age"] >= a) & (mine["age"] < b)]
                if len(part):
                    print(f"{a:4.0f} to {b:4.0f} s {len(part):7} {shares(part['nees'])}")
            print("outages that end in their 95 % ellipse [%]")
            for name, part in [("pooled", ends), *ends.groupby("recording")]:
                k, n = int((part["inside_95_end"] > 0.5).sum()), len(part)
                low, high = interval(k, n)
                print(f"{name:14}{k:4} of {n:3} {100.0 * k / n:6.1f} [{100.0 * low:.0f}, {100.0 * high:.0f}]")


if __name__ == "__main__":
    main()
