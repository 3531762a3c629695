"""A lever arm that was told is held against the drive, one that nobody told is looked for."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from gapless.evaluation import score
from gapless.runs import arm
from gapless.runs.decide import decide
from gapless.runs.fuse import fuse
from gapless.simulate import Receiver, simulate
from gapless.simulate.motion import Vehicle
from gapless.systems.arm import told_arm, with_arm
from gapless.systems.recipe import Clock, System

ARM = np.array([2.4, -0.8, -1.1])
RTK = Receiver(
    rate=5.0,
    position_white=(0.01, 0.01, 0.02),
    position_correlated=(0.01, 0.01, 0.02),
    velocity=(0.02, 0.02, 0.04),
    fix=4,
)
TIMED = System(clock=Clock(position=0.0, velocity=0.0))
"""What clocks leave open is theirs."""


def drive(profile="urban", seconds=200.0, receiver=RTK, arm=ARM):
    made = simulate(profile, "consumer", seconds, 4, receiver=receiver, vehicle=Vehicle(antenna=tuple(arm)))
    return replace(made, grade=None)


@pytest.fixture(scope="module")
def city():
    return drive()


def decision(decided):
    return next(d for d in decided.decisions if d.name == "antenna lever arm")


def told(log, arm):
    return replace(log, lever_arm=arm)


def test_one_that_nobody_told_is_found_and_stays_a_state(city):
    log = told(city, None)
    solution = fuse(log, TIMED)
    arm, sd = solution.states["lever_arm"][-1], solution.states_sd["lever_arm"][-1]
    assert (sd[:2] < 0.1).all()
    assert (np.abs(arm - ARM) < 4.0 * sd).all(), (arm, sd)  # one drive: the bound of a largest, not a band
    said = decision(solution)
    assert said.value == tuple(round(float(a), 3) for a in arm)
    assert (said.source, said.evidence[:14]) == ("data", "none is stated")
    found = score(solution, log)
    assert found.aided.horizontal_rmse < 0.3  # 2.5 m if the arm were taken for zero
    assert found.aided.coverage > 0.9


def test_one_that_was_told_rightly_is_taken(city):
    decided = decide(city, TIMED)
    assert decided.used(TIMED).filter.states == TIMED.filter.states
    said = decision(decided)
    assert (said.value, said.source) == (tuple(ARM), "recording")
    assert "fixes in turns put it at" in said.evidence


@pytest.mark.parametrize("wrong", [ARM * [-1.0, -1.0, 1.0], np.zeros(3)], ids=["mirrored", "zero"])
def test_one_that_was_told_wrongly_is_named(city, wrong):
    """Zero that somebody told is a word like any other."""
    decided = decide(told(city, wrong), TIMED)
    said = decision(decided)
    assert said.source == "data"
    assert "mend what was told" in said.evidence
    assert np.abs(np.array(said.value) - ARM)[:2].max() < 0.3
    assert "lever_arm" in decided.used(TIMED).filter.states


def test_a_word_in_the_recipe_counts_like_the_recordings(city):
    mirrored = with_arm(TIMED, ARM * [-1.0, -1.0, 1.0])
    assert told_arm(mirrored, city)[0] == -ARM[0]
    assert "given in the configuration" in decision(decide(city, mirrored)).evidence


def test_what_the_road_does_not_show_is_doubted():
    """A straight motorway: the box is anywhere about the antenna, and that is stated."""
    log = told(drive("highway", 110.0), None)
    solution = fuse(log, TIMED)
    assert (solution.trajectory.sd[-1, :2] > 0.5).all()
    assert decision(solution).source == "default"
    assert score(solution, log).aided.coverage > 0.9


def test_a_long_road_that_shows_nothing_keeps_zero_and_says_how_far_it_may_be_off(monkeypatch):
    monkeypatch.setattr(arm, "SHORT", 0.0)
    log = told(drive("highway", 110.0), None)
    decided = decide(log, TIMED)
    assert "lever_arm" not in decided.used(TIMED).filter.states
    solution = fuse(log, TIMED, decided=decided)
    assert (solution.trajectory.sd[-1, :2] > 0.5).all()
    assert score(solution, log).aided.coverage > 0.9  # of an antenna 2.5 m away, where 1.5 m is a deviation


def test_a_receiver_of_metres_has_no_word_on_it():
    log = told(drive(receiver=Receiver(), seconds=100.0), None)
    decided = decide(log, System())
    assert "lever_arm" not in decided.used(System()).filter.states
    np.testing.assert_allclose(np.sqrt(decided.arm.doubt.diagonal()), System().gnss.lever_arm_sd)
    assert decision(decided).evidence.startswith("none is stated, and fixes are too coarse")


def test_a_recipe_that_looks_for_it_itself_is_left_alone(city):
    free = structs.replace(TIMED, filter=structs.replace(TIMED.filter, states=("lever_arm",)))
    assert decide(city, free).used(free) is free
