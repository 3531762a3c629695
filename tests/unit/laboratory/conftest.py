from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from gapless.runs.decide import decide_before
from gapless.runs.fuse import fuse
from gapless.scenarios import plan
from gapless.simulate import Receiver, Vehicle, WheelSensor, simulate
from gapless.systems.library import load
from gapless.trip.recording import Recording
from gapless.units import DEG

CAR = Vehicle(imu=(1.2, 0.3, -0.6), antenna=(0.4, 0.1, -1.5), mounting=(0.0, 2.0 * DEG, -3.0 * DEG))


@cache
def drive(clock: str) -> Recording:
    """Four minutes; stamps late, so that fixes logged before an outage are replayed in it, or early."""
    late = {"late": 0.35, "early": -0.25}[clock]
    receiver = Receiver(rate=2.0, position_delay=late, velocity_delay=late + 0.1)
    wheels = WheelSensor(rate=5.0, delay=0.1, scale=0.01)
    return simulate("urban", "consumer", 240.0, 6, vehicle=CAR, receiver=receiver, wheels=wheels)


@pytest.fixture(params=["late", "early"])
def either(request):
    return drive(request.param)


@pytest.fixture
def late():
    return drive("late")


@pytest.fixture
def outages(late):
    return plan(["every=40,length=15,first=110"], late)


@pytest.fixture
def constraints():
    return load("constraints")


@dataclass(frozen=True)
class Given:
    """A source that is there already."""

    recording: Recording

    @property
    def name(self):
        return self.recording.name

    def open(self):
        return self.recording


@pytest.fixture
def honest(late, constraints):
    """A function that navigates with decisions taken once, from before the first outage."""
    decided = first_decisions()
    return lambda recording, outages: fuse(recording, constraints, outages, decided=decided)


@cache
def first_decisions():
    return decide_before(drive("late").slice(-np.inf, 110.0), load("constraints"), ())


@pytest.fixture
def given():
    return Given


@pytest.fixture
def same():
    """Whether two trajectories have the same bits."""

    def compare(a, b):
        names = ("time", "lla", "v_n", "euler", "sd", "horizontal", "source")
        return len(a) == len(b) and all(np.array_equal(getattr(a, n), getattr(b, n)) for n in names)

    return compare


@pytest.fixture
def drives():
    return drive
