"""What is believed of clock offsets: sharp ones by themselves, vague ones with the other stamps."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from gapless.alignment.clock import Offset
from gapless.errors import RecordingError
from gapless.runs.clocks import ONE_CLOCK, VAGUE, Clocks, believed, clock_decision
from gapless.runs.decide import decide
from gapless.simulate import simulate
from gapless.systems.recipe import System

SHARP, OTHER = Offset(-0.15, 0.03, 1.5, 300), Offset(-0.5, 0.015, 2.0, 300)
DIM, SILENT = Offset(-0.35, 0.15, 1.04, 300), Offset(0.0, math.inf, 1.0, 0)


def clocks(found, given=None, base=0.0):
    return Clocks(given or {}, base, found)


def test_sharp_offset_is_taken_as_found():
    found = {"position": SHARP, "velocity": OTHER}
    assert believed("position", clocks(found)) is SHARP
    assert believed("velocity", clocks(found)) is OTHER


@pytest.mark.parametrize("given", [{}, {"velocity": -0.5}])
def test_vague_one_is_weighed_against_the_other(given):
    found = {"position": DIM} if given else {"position": DIM, "velocity": OTHER}
    taken = believed("position", clocks(found, given))
    # two normal densities multiplied: found, and the other channel's with the deviation of one clock
    weights = ONE_CLOCK**-2, DIM.sd**-2
    assert taken.value == pytest.approx((weights[0] * -0.5 + weights[1] * DIM.value) / sum(weights))
    assert taken.sd == pytest.approx(sum(weights) ** -0.5)
    assert taken.sd < VAGUE


def test_where_nothing_was_found_the_other_is_taken():
    taken = believed("position", clocks({"position": SILENT, "velocity": OTHER}))
    assert (taken.value, taken.sd) == (OTHER.value, ONE_CLOCK)


@pytest.mark.parametrize(
    ("channel", "found"),
    [
        ("position", {"position": DIM}),
        ("position", {"position": DIM, "velocity": DIM}),
        ("odometer", {"odometer": DIM, "velocity": OTHER}),  # a clock of its own
    ],
)
def test_vague_and_alone_is_zero(channel, found):
    assert believed(channel, clocks(found)).value == 0.0
    assert "too vague by itself: not acted on" in clock_decision(channel, clocks(found), 300.0).evidence


def test_decision_says_what_was_found_and_what_was_taken():
    told = clock_decision("position", clocks({"position": DIM, "velocity": OTHER}), 300.0)
    assert told.evidence.startswith("found -0.350 ± 0.15 s, too vague by itself: weighed against")
    assert told.value == pytest.approx(-0.454, abs=5e-4)  # as above, rounded
    assert clock_decision("position", clocks({"position": DIM}, {"position": 0.2}), 300.0).source == "user"
    assert clock_decision("velocity", clocks({"velocity": SILENT}), 300.0).source == "default"


def test_base_by_turns_is_all_there_is_where_the_finer_search_says_nothing():
    told = clock_decision("position", clocks({"position": SILENT}, base=-4.25), 300.0)
    assert (told.value, told.source) == (-4.25, "data")
    assert told.evidence.startswith("-4.25 s by the turns")
    assert believed("odometer", clocks({"odometer": DIM}, base=-4.25)).value == 0.0  # not the receiver's


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


def test_stamps_of_another_time_scale_are_refused(drive):
    with pytest.raises(
        RecordingError, match=r"18\.\d s later .*: subtract that much \(GPS time is 18 s ahead"
    ):
        decide(shifted(drive, 18.0), System())
    with pytest.raises(RecordingError, match=r"1[12]\.\d s earlier .*: add that much$"):
        decide(shifted(drive, -12.0), System())
