"""Systems that cheat are found out; one that answers with truth and noise gets what it deserves."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.errors import LaboratoryError
from gapless.fold.feed import events
from gapless.laboratory import recipes
from gapless.laboratory.bench import bench
from gapless.laboratory.jobs import Job, execute
from gapless.laboratory.methods import Function
from gapless.laboratory.recipes import Recipe
from gapless.laboratory.study import scenario
from gapless.reports import summarise
from gapless.runs import forks
from gapless.runs.decide import decide
from gapless.runs.fuse import fuse
from gapless.scenarios import plan
from gapless.simulate import WheelSensor, simulate
from gapless.trip.motion import displace
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Solution

PLAN = "every=40,length=15,first=110"


def put(recording, given, *systems, protocols=("passes", "isolated"), text=PLAN):
    return execute(Job(given(recording), systems, (scenario(text),), protocols, summarise))


def test_an_honest_recipe_is_let_through(either, given, constraints):
    outcome = put(either, given, Recipe(constraints))
    assert outcome.checks == {"constraints": "held in 6 outages"}
    assert len(outcome.outages) == 6


@pytest.mark.parametrize("effect", ["noisy", "thinned:0.5", "velocity", "spiked", "wrong"])
def test_degraded_fixes_that_arrived_may_be_used(late, given, constraints, effect):
    outcome = put(late, given, Recipe(constraints), text=f"{PLAN},effect={effect}")
    assert outcome.checks == {"constraints": "held in 6 outages"}
    ends = {row["end"] - row["start"] for row in outcome.outages}
    assert ends == {{"spiked": 20.0, "wrong": 25.0}.get(effect, 15.0)}


def test_rows_at_which_a_reading_cuts_a_sample_are_no_peek(given, constraints):
    """Eight IMU samples a second and a wheel sensor between them: rows lie where its readings cut samples."""
    wheels = WheelSensor(rate=10.0, delay=-0.263)
    log = simulate("urban", "tactical", 200.0, 6, rate=8.0, wheels=wheels)
    rows = fuse(log, constraints, plan([PLAN], log)).trajectory
    assert np.mean(np.isin(rows.time, log.imu.time)) < 0.9
    outcome = put(log, given, Recipe(constraints))
    assert outcome.checks == {"constraints": "held in 4 outages"}


def test_an_honest_function_is_let_through(late, given, honest):
    mine = Function("mine", "", True, honest)
    assert put(late, given, mine, protocols=("passes",)).checks == {"mine": "held in 3 outages"}


def one_row_ahead(run):
    """Each row tells what the next one knows: a tenth of a second of the future."""

    def peek(recording, outages):
        found = run(recording, outages)
        t = found.trajectory
        ahead = np.minimum(np.arange(len(t)) + 1, len(t) - 1)
        return replace(found, trajectory=replace(t, lla=t.lla[ahead], v_n=t.v_n[ahead]))

    return peek


@pytest.mark.parametrize("protocol", ["passes", "isolated"])
def test_a_function_that_is_one_row_ahead_is_refused_by_name(late, given, honest, protocol):
    peeker = Function("peeker", "", True, one_row_ahead(honest))
    with pytest.raises(LaboratoryError) as caught:
        put(late, given, peeker, protocols=(protocol,))
    assert "peeker reads the future: on urban-consumer-6, in outage 110:125" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_function_that_keeps_the_withheld_fixes_is_refused(late, given, constraints):
    keeper = Function("keeper", "", True, lambda recording, outages: fuse(recording, constraints))
    with pytest.raises(LaboratoryError, match="keeper reads the future"):
        put(late, given, keeper, protocols=("passes",))


def test_a_function_that_smooths_is_refused_unless_it_says_so(late, given, honest):
    run = one_row_ahead(honest)
    outcome = put(late, given, Function("smooth", "", False, run), protocols=("passes",))
    assert outcome.checks == {"smooth": "declared not causal; not checked"}
    assert len(outcome.outages) == 3


def imu_one_sample_ahead(recording, *rest):
    """A feed in which every IMU sample says what the next one measured."""
    imu = recording.imu
    ahead = np.minimum(np.arange(len(imu)) + 1, len(imu) - 1)
    imu = replace(imu, dtheta=imu.dtheta[ahead], dvel=imu.dvel[ahead])
    return events(replace(recording, imu=imu), *rest)


@pytest.mark.parametrize("protocol", ["passes", "isolated"])
def test_a_feed_that_is_one_imu_sample_ahead_is_refused(late, given, constraints, protocol, monkeypatch):
    monkeypatch.setattr(recipes, "events", imu_one_sample_ahead)
    monkeypatch.setattr(forks, "events", imu_one_sample_ahead)
    with pytest.raises(LaboratoryError, match="constraints reads the future"):
        put(late, given, Recipe(constraints), protocols=(protocol,))


def fix_that_knows_the_next(recording, *rest):
    """A feed that weighs each fix by how long it is until the next one."""
    gnss = recording.gnss
    until = np.diff(gnss.time, append=np.inf)
    sd = gnss.sd_velocity * np.where(until > 1.0, 3.0, 1.0)[:, None]
    return events(replace(recording, gnss=replace(gnss, sd_velocity=sd)), *rest)


def test_a_feed_that_knows_when_the_next_fix_comes_is_refused(late, given, constraints, monkeypatch):
    """Within a degraded outage: the last of the thinned fixes is weighed by what follows it."""
    monkeypatch.setattr(recipes, "events", fix_that_knows_the_next)
    monkeypatch.setattr(forks, "events", fix_that_knows_the_next)
    with pytest.raises(LaboratoryError, match="constraints reads the future"):
        put(late, given, Recipe(constraints), text="every=40,length=15,first=110,effect=thinned:0.5")


@pytest.mark.parametrize("protocol", ["passes", "isolated"])
def test_decisions_taken_from_the_whole_recording_are_refused(
    late, given, constraints, protocol, monkeypatch
):
    monkeypatch.setattr(recipes, "decide_before", lambda log, system, outages: decide(log, system))
    with pytest.raises(LaboratoryError, match="constraints reads the future"):
        put(late, given, Recipe(constraints), protocols=(protocol,))


def test_no_system_is_handed_the_reference(late, given, honest):
    seen = []

    def run(recording, outages):
        seen.append(recording.reference)
        return honest(recording, outages)

    put(late, given, Function("mine", "", False, run))
    assert set(seen) == {None}


SD = 3.0
"""Of the noise that is planted [m]."""


def truth_and_noise(reference, stated=SD):
    """The truth with white noise of 3 m north and east, stated as it is or not; prefix-stable."""

    def run(recording, outages):
        n = int(np.searchsorted(reference.time, recording.imu.time[-1], side="right"))
        noise = np.random.default_rng(5).standard_normal((len(reference), 3))[:n] * [SD, SD, 0.0]
        t = reference.take(slice(0, n))
        sd = np.full((n, 9), stated)
        found = Trajectory(t.time, displace(t.lla, noise), t.v_n, t.euler, sd, np.zeros(n), np.full(n, "ins"))
        spans = tuple((o.start, o.until) for o in outages)
        return Solution(recording.name, "truth", found, {}, {}, {}, (), spans, recording.start)

    return run


def test_truth_and_noise_scores_as_it_should(late, given):
    method = Function("oracle", "", True, truth_and_noise(late.reference))
    rows = put(late, given, method, protocols=("passes",)).outages
    n = sum(row["truth_epochs"] for row in rows)
    assert n == 450
    mean = {
        name: sum(row[name] * row["truth_epochs"] for row in rows) / n
        for name in ("coverage_50", "coverage_95", "coverage_99", "nees")
    }
    # white epochs: four deviations of a share are 4 sqrt(p (1 - p) / n), of a mean NEES 4 x 2 / sqrt(n)
    for name, p in (("coverage_50", 0.5), ("coverage_95", 0.95), ("coverage_99", 0.99)):
        assert mean[name] == pytest.approx(p, abs=4 * np.sqrt(p * (1 - p) / n))
    assert mean["nees"] == pytest.approx(2.0, abs=8 / np.sqrt(n))
    rms = np.sqrt(sum(row["horizontal_rmse"] ** 2 * row["truth_epochs"] for row in rows) / n)
    assert rms == pytest.approx(SD * np.sqrt(2.0), rel=4 / (2 * np.sqrt(n)))
    for row in rows:
        assert row["velocity_max"] == pytest.approx(0.0, abs=1e-9)
        # Rayleigh: the largest of m is near sd sqrt(2 ln m), and within 0.6 to 1.5 of it here
        expected = SD * np.sqrt(2.0 * np.log(row["truth_epochs"]))
        assert 0.6 * expected < row["horizontal_max"] < 1.5 * expected
        assert row["inside_95_end"] in (0.0, 1.0)


def test_a_system_that_brags_is_shown_to(late, given):
    """The same noise, stated as a third of it: the 95 % ellipse then holds 1 - exp(-ln(20) / 9) = 28 %."""
    method = Function("bragger", "", True, truth_and_noise(late.reference, SD / 3.0))
    rows = put(late, given, method, protocols=("passes",)).outages
    n = sum(row["truth_epochs"] for row in rows)
    found = sum(row["coverage_95"] * row["truth_epochs"] for row in rows) / n
    expected = 1.0 - 20.0 ** (-1.0 / 9.0)
    assert found == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / n))


def test_pairs_of_one_system_with_itself_differ_in_nothing(late, given, honest):
    one, twin = (Function(name, "", False, honest) for name in ("one", "twin"))
    results = bench([given(late)], [one, twin], [scenario(PLAN)], ["passes"], summarise)
    (pair,) = results.pairs
    assert (pair["median_ratio"], pair["better"], pair["worst_ratio"]) == (1.0, 0.0, 1.0)
    assert np.isnan(pair["p"])
