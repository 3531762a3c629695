"""What a recipe and a recording make of a navigator."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec.structs import replace as other

from gapless.errors import AlignmentError, ConfigError
from gapless.runs.decide import decide
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.sensors import grade
from gapless.simulate import WheelSensor, simulate
from gapless.systems.build import budget, settings, states
from gapless.systems.recipe import Clock, Filter, GnssUse, Imu, Mounting, System
from gapless.units import DEG

LOG = simulate("urban", "consumer", 90.0, 1, wheels=WheelSensor())
NONE = (np.zeros(2), np.full(2, 0.1))


def test_blocks_are_those_that_are_needed_and_each_once():
    bare = replace(LOG, odometer=None)
    assert states(System(), bare) == ("gyro_scale", "mounting", "axle")
    assert states(System(), LOG) == ("gyro_scale", "mounting", "axle", "odometer_scale", "odometer_offset")
    assert states(System(constraints=()), bare) == ("gyro_scale",)
    asked = System(filter=Filter(states=("mounting", "gravity")))
    assert sorted(states(asked, bare)) == ["axle", "gravity", "mounting"]


def test_a_recipe_is_in_degrees_and_a_filter_in_radians():
    noise = budget(Imu(gyro_noise=0.1, accel_noise=0.02, gyro_walk=0.01, accel_walk=0.003, turn=0.004))[
        "noise"
    ]
    expected = [(0.1 * DEG) ** 2, 0.02**2, (0.01 * DEG) ** 2, 0.003**2, 0.004**2, 0.0, 0.0]
    np.testing.assert_allclose(noise, expected, rtol=1e-14)


def test_a_grade_brings_its_own_noise():
    g, found = grade("liu2019"), budget(Imu(grade="liu2019", gyro_noise=5.0))
    np.testing.assert_allclose(found["noise"][:2], [g.gyro_noise**2, g.accel_noise**2])
    # A random walk that gains in a correlation time what the Gauss-Markov process has, twice.
    assert found["noise"][2] * g.gyro_instability_tau == pytest.approx(2.0 * g.gyro_instability**2)
    assert found["gyro_bias_sd"] == pytest.approx(np.hypot(g.gyro_bias_sd, g.gyro_instability))
    with pytest.raises(ConfigError, match="tactical"):
        budget(Imu(grade="tactcal"))


def test_late_readings_are_waited_for_and_early_ones_cost_nothing():
    assert settings(System(), LOG, {"position": 0.2, "velocity": 0.0}, NONE).lateness == 0.0
    assert 0.6 < settings(System(), LOG, {"position": -0.15, "velocity": -0.6}, NONE).lateness < 0.7


def test_a_velocity_that_is_a_mean_holds_for_its_epochs_end():
    """Found as an equivalent instant, the middle of the epoch."""
    setup = settings(System(gnss=GnssUse(velocity_averaging=1.0)), LOG, {"velocity": -0.6}, NONE)
    assert setup.trail >= 1.0


def test_what_is_given_is_taken():
    system = System(clock=Clock(0.1, -0.2, 0.3), mounting=Mounting(2.0, -3.0, 0.5, 0.5))
    decided = decide(LOG, system)
    assert {c: decided.offsets[c] for c in ("position", "velocity", "odometer")} == {
        "position": 0.1,
        "velocity": -0.2,
        "odometer": 0.3,
    }
    np.testing.assert_allclose(decided.mounting.angles, np.array([2.0, -3.0]) * DEG)
    assert {d.source for d in decided.decisions if "clock" in d.name or "mounting" in d.name} == {"user"}


def test_nothing_after_the_horizon_is_looked_at():
    spoilt = LOG.gnss.take(LOG.gnss.time < 60.0)
    a, b = decide(LOG, System(), 60.0), decide(replace(LOG, gnss=spoilt), System(), 60.0)
    assert a.offsets == b.offsets
    assert np.array_equal(a.mounting.angles, b.mounting.angles)


def test_a_car_that_never_moves_is_said_to():
    with pytest.raises(AlignmentError, match=r"min_speed") as caught:
        fuse(simulate("static", "consumer", 40.0, 1))
    assert "\n" not in str(caught.value)


def test_reference_is_never_used_to_navigate():
    plain = fuse(LOG, System()).trajectory
    blind = fuse(replace(LOG, reference=None), System()).trajectory
    for name in ("time", "lla", "v_n", "euler", "sd"):
        assert np.array_equal(getattr(plain, name), getattr(blind, name))


def test_rows_come_as_often_as_asked():
    for rate in (1.0, 5.0, 10.0):
        time = fuse(LOG, other(System(), clock=Clock(0.0, 0.0, 0.0)), rate=rate).trajectory.time
        assert np.median(np.diff(time)) == pytest.approx(1.0 / rate, rel=0.02)


def test_an_outage_is_in_the_solution_and_its_rows_are_not_from_gnss():
    found = fuse(LOG, outages=[Outage(60.0, 80.0)])
    assert found.outages == ((60.0, 80.0),)
    t = found.trajectory
    inside = (t.time > LOG.start + 62.0) & (t.time < LOG.start + 79.9)
    assert "gnss" not in set(t.source[inside])
    assert t.sd[inside][-1, 0] > t.sd[inside][0, 0]
