"""Both protocols give the bits of plain runs with the same decisions."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.evaluation import score, score_pieces
from gapless.laboratory.methods import Function
from gapless.laboratory.recipes import Recipe
from gapless.runs.decide import decide_before
from gapless.runs.forks import LEAD, first_touched
from gapless.runs.fuse import fuse
from gapless.runs.prepare import withhold_from
from gapless.scenarios import Effect, Outage, parse, plan
from gapless.systems.library import load


def test_passes_are_plain_runs(either, constraints, same):
    outages = plan(["110:125", "150:165,effect=noisy", "190:200,effect=spiked"], either)
    run = Recipe(constraints).passes(either, outages)
    assert same(run.solution.trajectory, fuse(either, constraints, outages).trajectory)
    assert [f.outage for f in run.forks] == list(outages)


@pytest.mark.parametrize(("clock", "system"), [("early", "ins"), ("late", "constraints")])
def test_isolated_outages_are_runs_from_the_start_with_that_outage_alone(clock, system, same, drives):
    """Overlapping outages of all kinds; late stamps mean that readings logged before are replayed in it."""
    either, recipe = drives(clock), load(system)
    texts = ["110:125", "118.3:140", "120:130,effect=noisy", "150:160,effect=spiked"]
    texts += ["155:165,effect=wrong", "150:170,effect=velocity", "180.05:200,effect=thinned:1"]
    outages = tuple(parse(text) for text in texts)
    run = Recipe(recipe).isolated(either, outages)
    assert sorted(o for o, _ in run.pieces) == sorted(outages)
    decided = decide_before(withhold_from(either, outages), recipe, outages)
    for outage, found in run.pieces:
        whole = fuse(either, recipe, [outage], decided=decided).trajectory
        part = whole.take((whole.time >= found.time[0]) & (whole.time <= found.time[-1]))
        assert found.time[0] <= either.start + outage.start - LEAD + 0.21  # s: a row, and a spiked fix before
        assert found.time[-1] >= either.start + outage.until + LEAD - 0.11
        assert same(found, part), str(outage)
    assert same(run.solution.trajectory, fuse(either, recipe, (), decided=decided).trajectory)


def test_scores_of_pieces_are_those_of_whole_runs(late, constraints, outages):
    run = Recipe(constraints).isolated(late, outages)
    _, scored = score_pieces(run.solution, run.pieces, late)
    decided = decide_before(withhold_from(late, outages), constraints, outages)
    for outage, (one, aged) in zip(outages, scored, strict=True):
        (expected,) = score(fuse(late, constraints, [outage], decided=decided), late).outages
        assert one.horizontal_max == expected.horizontal_max
        assert one.heading_rmse == expected.heading_rmse
        assert aged.horizontal.max() == one.horizontal_max
        assert 0.0 <= aged.time[0] < aged.time[-1] < outage.length


def test_a_function_runs_once_for_each_outage_alone(late, honest, outages):
    calls = []

    def run(recording, given):
        calls.append(given)
        return honest(recording, given)

    found = Function("mine", "", True, run).isolated(late, outages)
    assert calls == [*((o,) for o in outages), ()]
    assert [o for o, _ in found.pieces] == list(outages)


def test_a_fork_lies_before_all_that_its_outage_touches(late):
    time = late.gnss.time
    before = float(time[time < late.start + 110.0][-1])
    assert first_touched(late, Outage(110.0, 125.0)) == late.start + 110.0
    assert first_touched(late, parse("110:125,effect=spiked")) == before
    assert first_touched(late, Outage(110.0, 125.0, Effect("real"))) == late.start + 110.0


def test_decisions_are_shared_between_lengths_and_only_where_they_are_the_same(late, constraints):
    recipe = Recipe(constraints)
    for text in ("every=40,length=15,first=110", "every=80,length=40,first=110"):
        recipe.passes(late, plan([text], late))
    assert len(recipe._known) == 1
    recipe.passes(late, plan(["120:130"], late))
    assert len(recipe._known) == 2


def test_an_outage_from_before_any_decision_is_labelled(late, constraints, same):
    """The car has driven for ten seconds: the next outage's past decides, which lies after this one."""
    begun = float(fuse(late, constraints).trajectory.time[0]) - late.start
    outages = (Outage(begun + 10.0, begun + 15.0), Outage(150.0, 165.0))
    recipe = Recipe(constraints)
    run = recipe.passes(late, outages)
    assert same(run.solution.trajectory, fuse(late, constraints, outages).trajectory)
    labels = [o.labels for o in score(replace(run.solution), late).outages]
    assert "before decisions" in labels[0]
    assert labels[1] == ()
    assert np.isfinite(score(run.solution, late).outages[0].horizontal_max)
