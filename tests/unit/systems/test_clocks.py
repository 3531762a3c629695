"""What is believed of clock offsets: sharp ones by themselves, vague ones with the other stamps."""

from __future__ import annotations

import math

import pytest

from gapless.alignment.clock import Offset
from gapless.systems.clocks import ONE_CLOCK, VAGUE, believed, clock_decision

SHARP, OTHER = Offset(-0.15, 0.03, 1.5, 300), Offset(-0.5, 0.015, 2.0, 300)
DIM, SILENT = Offset(-0.35, 0.15, 1.04, 300), Offset(0.0, math.inf, 1.0, 0)


def test_sharp_offset_is_taken_as_found():
    found = {"position": SHARP, "velocity": OTHER}
    assert believed("position", found, {}) is SHARP
    assert believed("velocity", found, {}) is OTHER


@pytest.mark.parametrize("given", [{}, {"velocity": -0.5}])
def test_vague_one_is_weighed_against_the_other(given):
    found = {"position": DIM} if given else {"position": DIM, "velocity": OTHER}
    taken = believed("position", found, given)
    # two normal densities multiplied: found, and the other channel's with the deviation of one clock
    weights = ONE_CLOCK**-2, DIM.sd**-2
    assert taken.value == pytest.approx((weights[0] * -0.5 + weights[1] * DIM.value) / sum(weights))
    assert taken.sd == pytest.approx(sum(weights) ** -0.5)
    assert taken.sd < VAGUE


def test_where_nothing_was_found_the_other_is_taken():
    taken = believed("position", {"position": SILENT, "velocity": OTHER}, {})
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
    assert believed(channel, found, {}).value == 0.0
    assert "too vague by itself: not acted on" in clock_decision(channel, found, {}, 300.0).evidence


def test_decision_says_what_was_found_and_what_was_taken():
    told = clock_decision("position", {"position": DIM, "velocity": OTHER}, {}, 300.0)
    assert told.evidence.startswith("found -0.350 ± 0.15 s, too vague by itself: weighed against")
    assert told.value == pytest.approx(-0.454, abs=5e-4)  # as above, rounded
    assert clock_decision("position", {"position": DIM}, {"position": 0.2}, 300.0).source == "user"
    assert clock_decision("velocity", {"velocity": SILENT}, {}, 300.0).source == "default"
