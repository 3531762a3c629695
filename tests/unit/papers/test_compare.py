"""Ratios, verdicts and orders, from samples that are made up."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_papers import TABLE, experiment

from gapless.evaluation.resampling import Interval
from gapless.papers.compare import NO, NOT_RUN, OPEN, YES, beside, claims_of, mean, rankings, ratios, verdict
from gapless.papers.experiment import Results
from gapless.papers.jobs import Sample
from gapless.papers.published import Claim

KEYS = ("position_east_rmse", "position_north_rmse", "horizontal_max")


def results(values, **changes):
    """`values`: by method, an error a drive."""
    samples = [
        Sample("town", f"seed {k}", method, "15 s", 110.0, 125.0, dict.fromkeys(KEYS, float(v)))
        for method, errors in values.items()
        for k, v in enumerate(errors)
    ]
    return Results(experiment(**changes), 10, samples)


DRAWN = np.random.default_rng(1).uniform(1.0, 3.0, 30)


def test_a_constant_ratio_is_found_exactly():
    found = ratios(results({"INS": DRAWN, "car": 0.4 * DRAWN}))
    one = next(r for r in found if r.claim.worse == "INS" and r.claim.key == KEYS[0])
    assert one.claim.ratio == pytest.approx(0.5)  # 2.0 / 4.0 in the table
    assert one.ours == pytest.approx((0.4, 0.4, 0.4))
    assert one.size == pytest.approx(0.8)
    assert (one.count, one.verdict) == (30, YES)


def test_the_other_order_is_said_and_a_method_that_is_not_there_too():
    found = ratios(results({"INS": DRAWN, "car": 2.0 * DRAWN}))
    assert {r.verdict for r in found if r.claim.worse == "INS"} == {NO}
    assert {r.verdict for r in found if r.claim.worse == "dream"} == {NOT_RUN}


def test_few_drives_and_equal_errors_stay_open():
    few = ratios(results({"INS": DRAWN[:5], "car": 0.4 * DRAWN[:5]}))
    assert {r.verdict for r in few if r.claim.worse == "INS"} == {OPEN}
    noise = np.exp(np.random.default_rng(2).normal(0.0, 0.5, 30))
    equal = ratios(results({"INS": DRAWN, "car": DRAWN * noise / np.exp(np.log(noise).mean())}))
    assert {r.verdict for r in equal if r.claim.worse == "INS"} == {OPEN}


def test_only_drives_that_both_have_count():
    made = results({"INS": DRAWN, "car": 0.4 * DRAWN[:20]})
    assert next(r for r in ratios(made) if r.claim.worse == "INS").count == 20


@given(st.floats(0.01, 100.0), st.floats(0.01, 100.0), st.floats(0.01, 100.0))
def test_verdict_is_that_of_the_interval(theirs, a, b):
    lo, hi = sorted((a, b))
    said = verdict(theirs, Interval(math.sqrt(lo * hi), lo, hi))
    if lo <= 1.0 <= hi:
        assert said == OPEN
    else:
        assert said == (YES if (hi < 1.0) == (theirs < 1.0) else NO)


def test_claims_of_a_table_are_ratios_to_its_subject():
    found = list(claims_of(experiment()))
    assert [(c.worse, c.key, c.ratio) for c in found] == [
        ("INS", KEYS[0], 0.5), ("INS", KEYS[1], 0.5), ("dream", KEYS[0], 2.0), ("dream", KEYS[1], 1.5),
    ]  # fmt: skip
    told = Claim("text", "15 s", "car", "INS", KEYS[2], 0.5)
    assert list(claims_of(experiment(claims=(told,))))[-1] is told


def test_orders_leave_out_what_was_not_run():
    (east, _) = rankings(results({"INS": DRAWN, "car": 2.0 * DRAWN}))
    assert (east.table, east.where, east.column) == (TABLE.label, "15 s", "pE")
    assert east.theirs == ("dream", "car", "INS")
    assert east.ours == ("INS", "car")
    assert not east.same
    assert all(r.same for r in rankings(results({"INS": DRAWN, "car": 0.5 * DRAWN})))


def test_mean_and_its_interval_cover():
    """95 % intervals of 200 experiments of 30 drives hold the mean in 88 to 98 % of them.

    The percentile bootstrap of 30 draws is a little narrow; three sigma of a share of 200 is 5 %.
    """
    rng = np.random.default_rng(3)
    held = 0
    for _ in range(200):
        one = mean(results({"INS": rng.uniform(1.0, 3.0, 30)}).samples, KEYS[0])
        held += one.lo <= 2.0 <= one.hi
    assert 176 <= held <= 196


def test_the_same_seeds_under_another_assumption():
    aside = results({"INS": 1.5 * DRAWN[:10]})
    aside.samples = [replace(s, start=200.0, end=215.0) for s in aside.samples]  # the outage comes later
    count, ratio = beside(aside, results({"INS": DRAWN}), "INS", "15 s", KEYS[2])
    assert count == 10
    assert ratio.value == pytest.approx(1.5)
