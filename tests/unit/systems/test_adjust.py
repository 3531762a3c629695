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


def test_named_takes_out_and_puts_in():
    system = named("wang2018-bridge+constraints")
    assert system.name == "wang2018-bridge+constraints"
    assert system.bridge.model == "none"
    assert system.constraints == System().constraints
    assert system.adaptation.gnss == named("wang2018").adaptation.gnss
    assert named("wang2018-elm").learner.name == "elm"
    assert named("liu2019-elm-denoise").denoise.method == "none"
    assert named("tan2015+calibrated").bridge.noise == "calibrated"


@pytest.mark.parametrize("text", ["wang2018-wheels", "nobody", "ins+wheels", "-bridge", "+constraints"])
def test_named_says_what_there_is(text):
    with pytest.raises(ConfigError, match="choose from"):
        named(text)
