"""What is believed of clock offsets, how far it is doubted, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gapless.alignment.clock import Offset
from gapless.alignment.uneven import Jitter
from gapless.errors import RecordingError
from gapless.runs.clocks import (
    ONE_CLOCK,
    PRIOR,
    Clocks,
    believed,
    clock_decision,
    clock_notes,
    doubt,
    jitter_decisions,
    together,
)
from gapless.runs.decide import decide, decide_before
from gapless.simulate import Receiver, simulate
from gapless.systems.recipe import System

SHARP, OTHER = Offset(-0.15, 0.03, 1.5, 300), Offset(-0.5, 0.015, 2.0, 300)
DIM, SILENT = Offset(-0.35, 0.15, 1.04, 300), Offset(0.0, math.inf, 1.0, 0)
RTK = Receiver(
    rate=5.0,
    position_white=(0.01, 0.01, 0.02),
    position_correlated=(0.01, 0.01, 0.02),
    velocity=(0.02, 0.02, 0.04),
    fix=4,
)


def clocks(found, given=None, base=0.0):
    return Clocks(given or {}, base, found)


def test_sharp_offsets_are_taken_as_found():
    found = {"position": SHARP, "velocity": OTHER}
    # the prior of 0.3 s moves an offset by its variance over that: 0.25 and 1 % of it
    assert believed("velocity", clocks(found)).value == pytest.approx(-0.5, abs=0.003)
    assert believed("position", clocks(found)).value == pytest.approx(-0.15, abs=0.01)
    assert believed("position", clocks(found)).sd >= believed("velocity", clocks(found)).sd


@pytest.mark.parametrize("given", [{}, {"velocity": -0.5}])
def test_vague_one_is_drawn_to_the_other(given):
    found = {"position": DIM} if given else {"position": DIM, "velocity": OTHER}
    taken = believed("position", clocks(found, given))
    assert -0.5 <= taken.value < -0.45  # found 0.15 off it, by one deviation
    assert taken.sd < DIM.sd


def test_where_nothing_was_found_the_other_is_taken():
    taken = believed("position", clocks({"position": SILENT, "velocity": OTHER}))
    assert taken.value == pytest.approx(OTHER.value, abs=0.003)
    assert taken.sd > 0.1


def test_one_clock_unless_the_data_say_otherwise():
    gap, sd = together(0.004, 0.005)
    assert abs(gap) < 0.002
    assert sd < 0.006
    gap, sd = together(0.45, 0.02)
    assert gap == pytest.approx(0.45, rel=0.01)  # drawn to zero by (0.02 / 0.3)^2
    assert sd == pytest.approx(0.02, rel=0.01)
    assert together(0.0, math.inf)[1] <= PRIOR


@pytest.mark.parametrize("sd", [0.005, 0.02, 0.1])
def test_what_is_stated_of_a_mixture_is_its_error(sd):
    rng = np.random.default_rng(1)
    one = rng.random(4000) < 0.7
    true = np.where(one, ONE_CLOCK, PRIOR) * rng.standard_normal(4000)
    taken = np.array([together(float(x), sd) for x in true + sd * rng.standard_normal(4000)])
    # mean square of 4000 errors over their variances, whose tails are those of a mixture
    assert np.mean((taken[:, 0] - true) ** 2) == pytest.approx(np.mean(taken[:, 1] ** 2), rel=0.1)


def test_doubt_is_parted_in_what_is_common_and_what_is_not():
    common, apart = doubt(clocks({"position": SHARP, "velocity": OTHER}))
    assert common == pytest.approx(OTHER.sd, rel=0.05)
    assert math.hypot(common, apart) == pytest.approx(
        believed("position", clocks({"position": SHARP, "velocity": OTHER})).sd
    )
    assert doubt(clocks({}, {"position": 0.0, "velocity": 0.0})) == (0.0, 0.0)
    assert doubt(clocks({"position": DIM}))[1] == 0.0


def test_decision_says_what_was_found_and_what_was_taken():
    told = clock_decision("position", clocks({"position": DIM, "velocity": OTHER}), 300.0)
    assert told.evidence.startswith("found -0.350 ± 0.150 s, weighed against the receiver's other stamps")
    assert clock_decision("position", clocks({"position": DIM}, {"position": 0.2}), 300.0).source == "user"
    assert clock_decision("velocity", clocks({"velocity": SILENT}), 300.0).source == "default"


def test_base_by_turns_is_all_there_is_where_the_finer_search_says_nothing():
    told = clock_decision("position", clocks({"position": SILENT}, base=-4.25), 300.0)
    assert (told.value, told.source) == (-4.25, "data")
    assert told.evidence.startswith("-4.25 s by the turns")


def test_notes_tell_of_vague_clocks_drift_and_jitter():
    assert clock_notes(clocks({"position": SHARP, "velocity": OTHER}), Jitter(), 0.0) == ()
    vague, part, rough = clock_notes(clocks({"position": DIM}), Jitter(0.04, 0.03, 0.05, 0.01, 300), 3e-4)
    assert "known to 0.1" in vague
    assert "300 ppm" in part
    assert "uneven by 0.050 s" in rough
    assert jitter_decisions(Jitter()) == []


def rtk(seconds=300.0, late=None):
    """A drive in the city with RTK; stamps later by a function of the time."""
    log = replace(simulate("urban", "consumer", seconds, 5, rate=50.0, receiver=RTK), grade=None)
    return (
        log
        if late is None
        else replace(log, gnss=replace(log.gnss, time=log.gnss.time + late(log.gnss.time)))
    )


def named(decisions, name):
    return [d for d in decisions if d.name == name]


def test_stamps_in_step_are_found_to_some_milliseconds():
    found = decide(rtk(), System())
    # twice what 3 ms of doubt are: RTK of 0.02 m/s and 1 m/s^2 over some hundred seconds
    assert abs(found.offsets["position"]) < 0.01
    assert found.doubt.common < 0.01
    assert found.notes == ()


def test_drift_is_found_and_said():
    found = decide(rtk(400.0, lambda t: 300e-6 * t), System())
    (drift,) = named(found.decisions, "clock drift")
    assert drift.value == pytest.approx(-300.0, abs=60.0)  # three of its deviations over 400 s
    assert any("ppm" in note for note in found.notes)


def test_jitter_is_found_and_said():
    rng = np.random.default_rng(2)
    found = decide(rtk(late=lambda t: rng.uniform(0.02, 0.16, len(t))), System())
    assert found.jitter == pytest.approx(0.14 / math.sqrt(12.0), rel=0.35)  # median deviations of a uniform
    assert named(found.decisions, "jitter of stamps")
    assert found.offsets["position"] == pytest.approx(-0.09, abs=0.02)


@pytest.fixture(scope="module")
def drive():
    return simulate("urban", "consumer", 300.0, 4, rate=50.0)


def shifted(drive, seconds):
    return replace(drive, gnss=replace(drive.gnss, time=drive.gnss.time + seconds))


@pytest.mark.parametrize("seconds", [-7.0, 4.3])
def test_stamps_that_are_seconds_off_are_found_as_finely_as_others(drive, seconds):
    sound, late = (decide(shifted(drive, s), System()).offsets for s in (0.0, seconds))
    for channel in ("position", "velocity"):
        # passes end when an offset moves by less than two of its standard deviations, some 0.015 s each
        assert late[channel] == pytest.approx(sound[channel] - seconds, abs=0.04)


@pytest.mark.parametrize("seconds", [60.0, -100.0])
def test_clocks_that_are_minutes_apart_are_refused_and_named(drive, seconds):
    way = "subtract" if seconds > 0.0 else "add"
    with pytest.raises(RecordingError, match=rf"are {abs(seconds) // 10:.0f}\d\.\d s|are 59\.\d s") as told:
        decide_before(shifted(drive, seconds), System(), ())
    assert way in str(told.value)


def test_two_drives_are_not_one():
    one, other = (simulate("urban", "consumer", 420.0, seed, rate=50.0) for seed in (4, 9))
    with pytest.raises(RecordingError, match="not the same at any offset"):
        decide_before(replace(one, gnss=other.gnss), System(), ())


def test_a_straight_drive_is_not_refused():
    log = simulate("highway", "consumer", 300.0, 4, rate=50.0)
    decide_before(shifted(log, 60.0), System(), ())


def test_stamps_of_another_time_scale_are_refused(drive):
    with pytest.raises(
        RecordingError, match=r"18\.\d s later .*: subtract that much \(GPS time is 18 s ahead"
    ):
        decide(shifted(drive, 18.0), System())
    with pytest.raises(RecordingError, match=r"1[12]\.\d s earlier .*: add that much$"):
        decide(shifted(drive, -12.0), System())
