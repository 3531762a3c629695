"""Who has earned to speak: numbers worked out by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chi2

from gapless.rehearsal.judge import ELLIPSE, Rehearsed, Score, Trial, best, calibrated, choose, judged


def history(*worst, bridge="wheels", nees=()):
    """Rehearsals with the largest errors of nobody and of a bridge."""
    return [
        Rehearsed(20.0 * k, 20.0 * k + 60.0, (Trial("", "", a, nees), Trial(bridge, "", b, nees)))
        for k, (a, b) in enumerate(worst)
    ]


def test_a_score_worked_out_by_hand():
    score = judged("wheels", [-0.5, -0.7, -0.6, -0.9, -0.3, -0.6])
    # sum -3.6 over 6 + 5; squares about the mean 0.2 + 2 * 0.25 over 7, as of 6 / 3 independent ones
    assert score.mean == pytest.approx(-3.6 / 11.0)
    assert score.error == pytest.approx(math.sqrt(0.7 / 7.0 / 2.0))
    assert score.earned
    assert score.text == "0.72 times the error [0.58, 0.90] in 6 rehearsals"
    assert judged("wheels", []).text == "not rehearsed yet"


def test_the_gate_is_half_a_standard_error():
    """Three alike: sqrt(0.5 / 4) = 0.354."""
    assert not judged("a", [-0.176] * 3).earned
    assert judged("a", [-0.178] * 3).earned
    assert not judged("a", [0.354] * 3).earned


@given(st.integers(0, 50))
def test_nobody_earns_by_making_no_difference(n):
    score = judged("a", [0.0] * n)
    assert not score.earned
    assert score.mean == 0.0


@pytest.mark.parametrize("luck", [-0.1, -1.0, -3.0, -10.0])
@pytest.mark.parametrize("others", [0, 1, 2, 5, 20])
def test_one_lucky_rehearsal_is_not_enough(luck, others):
    assert not judged("a", [luck, *[0.0] * others]).earned


def test_two_that_agree_are_enough_if_the_gain_is_large():
    """Two alike have a standard error of sqrt(0.5 / 3) = 0.408."""
    assert judged("a", [-0.21] * 2).earned
    assert not judged("a", [-0.20] * 2).earned
    assert not judged("a", [-1.0, -0.04]).earned, "one was better, and one was a tie"
    assert judged("a", [-2.0, -1.0, 0.5]).earned
    assert not judged("a", [-2.0, -1.0, 0.5, 0.1]).earned, "as often worse as better"


def test_errors_of_centimetres_are_alike():
    """Both have the track's own 2 m an axis in them."""
    told = choose(history(*[(0.3, 0.01)] * 9), ["wheels"], ()).bridges[0]
    assert -0.05 < told.mean < 0.0
    assert not told.earned
    four = choose(history(*[(4.0, 2.0)] * 9), ["wheels"], ()).bridges[0].mean
    assert four == pytest.approx(9.0 * 0.5 * math.log((2.0**2 + 8.0) / (4.0**2 + 8.0)) / 14.0)


def test_the_best_of_those_that_have_earned_it():
    good, better, untried = (
        Score("a", 9, -0.2, 0.1, True),
        Score("b", 9, -0.4, 0.1, True),
        Score("c", 1, -0.9, 2.0, False),
    )
    assert best([good, better, untried]) == "b"
    assert best([untried]) == ""
    told = history(*[(10.0, 4.0)] * 6)
    assert choose(told, ["wheels", "other"], ()).bridge == "wheels"
    assert choose(told, ["other"], ()).bridge == ""
    assert choose(history(*[(10.0, 25.0)] * 6), ["wheels"], ()).bridge == ""
    assert choose((), ["wheels"], ["loose"])[:3] == ("", "", 1.0)


def test_a_preset_is_held_against_the_same_bridge_without_it():
    trials = Trial("", "", 10.0, ()), Trial("wheels", "", 5.0, ()), Trial("wheels", "loose", 6.0, ())
    told = [Rehearsed(20.0 * k, 20.0 * k + 60.0, trials) for k in range(6)]
    choice = choose(told, ["wheels"], ["loose"])
    assert choice[:2] == ("wheels", "")
    assert choice.presets[0].mean == pytest.approx(6.0 * 0.5 * math.log((36.0 + 8.0) / (25.0 + 8.0)) / 11.0)
    alone = [Rehearsed(r.start, r.end, (r.trials[0], r.trials[2])) for r in told]
    assert choose(alone, ["wheels"], ["loose"]).presets[0].trials == 0


def test_ellipses_that_were_too_small_are_stated_larger():
    assert chi2.ppf(0.95, 2) == pytest.approx(ELLIPSE, abs=5e-4)
    honest = tuple(chi2.ppf((np.arange(400) + 0.5) / 400, 2))
    assert calibrated(history(*[(9.0, 9.0)] * 8, nees=honest), "", "") == pytest.approx(1.0, abs=0.02)
    small = tuple(4.0 * x for x in honest)
    # eight rehearsals against twelve that were honest: 4 to the power 8 / 20
    assert calibrated(history(*[(9.0, 9.0)] * 8, nees=small), "wheels", "") == pytest.approx(
        4.0**0.4, rel=0.02
    )
    assert calibrated(history((9.0, 9.0), nees=tuple(0.1 * x for x in honest)), "", "") == 1.0
    assert calibrated([], "", "") == 1.0
    assert calibrated(history((9.0, 9.0), nees=small), "somebody", "") == 1.0


def test_few_rehearsals_of_a_preset_are_judged_with_the_bridge_s_others():
    tried = Trial("", "loose", 9.0, (100.0,))
    told = [Rehearsed(0.0, 60.0, (Trial("", "", 9.0, (ELLIPSE,) * 50), tried))] * 2
    # two of the preset are fewer than three: all four of nobody count, one value in 51 is large
    assert calibrated(told, "", "loose") == pytest.approx(1.0)
    # three are enough: 100 / 5.991 to the power 3 / 15
    assert calibrated(told + told[:1], "", "loose") == pytest.approx((100.0 / ELLIPSE) ** 0.2)
