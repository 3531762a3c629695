"""The 27 states of tan2015, and all 32 there are: honest, finite, and each told how well it was seen."""

import numpy as np
import pytest

from gapless import earth
from gapless.inertial.layout import EXTRAS, ROW, Layout
from gapless.reports.summary import summarise
from gapless.reports.tables import states as states_table
from gapless.reports.terminal import summary_lines
from gapless.runs.fuse import fuse
from gapless.runs.smooth import smooth
from gapless.simulate import Receiver, Vehicle, WheelSensor, simulate
from gapless.systems.library import parse
from gapless.trip.solution import observability

RTK = Receiver(
    position_white=(0.02, 0.02, 0.04), position_correlated=(0.0, 0.0, 0.0), velocity=(0.1, 0.1, 0.1)
)
ARM = np.array([0.6, -0.4, -1.1])
RECIPE = """
constraints = []
sensors = ["position", "velocity"]
[imu]
grade = "span-cpt"
[filter]
states = ["gyro_scale", "accel_scale", "gravity", "lever_arm"]
[gnss]
lever_arm = [0.0, 0.0, 0.0]
wander = 0.0
jitter = 0.0
position_correlation = 0.0
velocity_correlation = 0.0
[clock]
position = 0.0
velocity = 0.0
"""


@pytest.fixture(scope="module")
def drive():
    car = Vehicle(antenna=tuple(ARM))
    return simulate("urban", "span-cpt", 400.0, 5, vehicle=car, receiver=RTK, wheels=WheelSensor())


@pytest.fixture(scope="module")
def solution(drive):
    return fuse(drive, parse(RECIPE, "tan2015.toml"))


def test_27_states_are_honest(drive, solution):
    """A lever arm that the recipe takes for zero is found, within what is stated of it."""
    arm, sd = solution.states["lever_arm"][-1], solution.states_sd["lever_arm"][-1]
    box = np.asarray(drive.lever_arm)
    assert np.linalg.norm(box) > 1.0
    assert (np.abs(arm - box) < 4.0 * sd).all(), (arm, box, sd)
    t, truth = solution.trajectory, drive.reference
    k = np.searchsorted(truth.time, t.time[600:] - 1e-6)
    error = np.array([earth.lla_to_ned(a, b) for a, b in zip(t.lla[600:], truth.lla[k], strict=True)])
    # one drive, alike over minutes: four deviations is the bound of the largest, not a 95 % band
    assert (np.abs(error) < 4.0 * t.sd[600:, :3]).all()


def test_every_state_says_how_far_it_fell(solution):
    rows = observability(solution)
    assert len(rows) == 27
    left = {(o.block, o.axis): o.ratio for o in rows}
    assert all(0.0 < o.ratio < 1.01 for o in rows if o.block not in ("position", "attitude"))
    for o in rows:
        assert o.ratio == o.end / o.start
    # what any drive with turns shows
    assert max(left["gyro_bias", 0], left["gyro_bias", 1], left["accel_bias", 0], left["lever_arm", 0]) < 0.1
    # gravity hides behind the accelerometers' bias: a disturbance of 0.5 um/s^2 is not seen
    assert min(left["gravity", axis] for axis in range(3)) > 0.8


def test_a_smoother_is_compared_with_where_its_filter_began(drive, solution):
    short = drive.slice(-np.inf, 150.0)
    begun = {(o.block, o.axis): o.start for o in observability(solution)}
    rows = observability(smooth(short, parse(RECIPE, "tan2015.toml")))
    assert len(rows) == 27
    # covariance steps twice as long, a first row a tick after alignment
    assert all(o.start == pytest.approx(begun[o.block, o.axis], rel=0.05) for o in rows)


def test_summary_page_and_terminal_tell_it(solution):
    summary = summarise(solution)
    assert len(summary["observability"]) == 27
    assert "Deviation left" in states_table(summary)
    text = " ".join(" ".join(summary_lines(summary)).split())
    assert text.count("sd down to") == 6
    summary.pop("observability")  # an older summary
    assert "sd down to" not in "\n".join(summary_lines(summary))
    assert "Gyro bias" in states_table(summary)


def test_all_32_states_run(drive):
    text = RECIPE.replace("constraints = []\n", "").replace(
        '"velocity"]\n[imu]', '"velocity", "odometer"]\n[imu]'
    )
    found = fuse(drive, parse(text, "all.toml"))
    assert set(found.states) >= set(EXTRAS)
    assert len(observability(found)) == Layout(tuple(EXTRAS)).n == 32 == ROW
    for values in (*found.states.values(), *found.states_sd.values(), found.trajectory.sd):
        assert np.isfinite(values).all()


def test_a_block_that_is_off_takes_no_column():
    """What a kernel runs over is the states that there are, rounded up to whole vectors."""
    assert [Layout(tuple(EXTRAS)[:k]).width for k in (0, 1, 2, 3, 4)] == [16, 24, 24, 24, 32]
    assert (Layout().offsets == -1).all()
