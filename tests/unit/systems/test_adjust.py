import pytest

from gapless.errors import ConfigError
from gapless.systems.adjust import with_clock, without
from gapless.systems.library import load
from gapless.systems.recipe import System


def test_without_takes_out_and_says_so():
    left = without(System(), "odometer", "nonholonomic")
    assert left.sensors == ("position", "velocity")
    assert left.constraints == ("zero_velocity",)
    assert left.name == "constraints without odometer, nonholonomic"


def test_without_what_is_not_used_changes_nothing():
    ins = load("ins")
    assert without(ins, "nonholonomic") is ins
    assert without(ins) is ins


def test_without_the_unknown():
    with pytest.raises(ConfigError, match="zero_velocity, nonholonomic, position, velocity, odometer"):
        without(System(), "radar")


def test_clock_is_checked_as_in_a_recipe():
    told = with_clock(System(), "velocity", -0.6)
    assert (told.clock.velocity, told.clock.position) == (-0.6, "auto")
    for bad in (20.0, float("nan")):
        with pytest.raises(ConfigError, match="velocity"):
            with_clock(System(), "velocity", bad)
    with pytest.raises(ConfigError, match="position, velocity, odometer"):
        with_clock(System(), "radar", 0.0)
