"""An odometer that reads too little at any speed, on simulated drives: what becomes of it in silence."""

import numpy as np
import pytest

from gapless.evaluation import score
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.sensors import grade
from gapless.simulate import WheelSensor, simulate
from gapless.systems.adjust import changed, named

OUTAGES = tuple(Outage(s, s + 60.0) for s in (240.0, 360.0, 480.0))


def driven(offset, seed, **changes):
    """Solution and scores of a drive in town."""
    wheels = WheelSensor(scale=-0.005, offset=offset, noise=0.05)
    log = simulate("urban", grade("consumer"), 600.0, seed, wheels=wheels)
    system = changed(named("constraints"), {"clock.odometer": 0.0, **changes}, "test")
    solution = fuse(log, system, outages=OUTAGES)
    return solution, score(solution, log)


@pytest.mark.parametrize("seed", [3, 5])
def test_offset_and_scale_are_told_apart(seed):
    solution, _ = driven(-0.12, seed)
    for name, true in (("odometer_offset", 0.12), ("odometer_scale", 0.005)):
        found, sd = (float(s[name][-1, 0]) for s in (solution.states, solution.states_sd))
        # both within three of their deviations, which a drive has brought down to a third of what they were
        assert abs(found - true) < 3.0 * sd, name
        assert sd < {"odometer_offset": 0.1, "odometer_scale": 0.03}[name] / 3.0, (name, sd)


def test_an_offset_that_is_not_there_costs_nothing():
    with_it, without = (
        np.concatenate([[o.horizontal_max for o in driven(0.0, seed, **told)[1].outages] for seed in (3, 5)])
        for told in ({}, {"odometer.offset_sd": 0.0})
    )
    # a state more, so something is lost by chance; a tenth is what these few outages scatter by
    assert np.exp(np.mean(np.log(with_it / without))) < 1.1
