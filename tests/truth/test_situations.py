"""What people report of navigation that was fooled: each is held to a largest error and a share inside.

Situations and bounds are those of `benchmarks/situations.py`, which says where the bounds are from. At least
70 % of the rows are inside, not 95, since rows of one drive go together.
"""

import importlib
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"

with pytest.MonkeyPatch.context() as path:
    path.syspath_prepend(str(BENCHMARKS))
    situations = importlib.import_module("situations")


@pytest.mark.parametrize("name", situations.SITUATIONS)
def test_situation_holds(name):
    for one in situations.seen(situations.SITUATIONS[name]):
        told = f"{one.window.start:g} to {one.window.end:g} s: {one.largest:.1f} m, {one.share:.0%} inside"
        assert one.largest <= one.window.metres, told
        assert one.share >= one.window.share, told
