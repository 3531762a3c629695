"""The stage: what is rehearsed, what is adopted, and that nothing but the data decides."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.errors import ConfigError
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.rehearsal.judge import Choice
from gapless.rehearsal.stage import SETTLE, Plan, Rehearsing
from gapless.runs.conduct import navigator_for
from gapless.runs.decide import Decided
from gapless.scenarios import Outage, withhold
from gapless.simulate import CAR, simulate
from gapless.systems.adjust import changed, named
from gapless.systems.build import settings
from gapless.trip.events import ImuBlock

MOUNTING = (np.zeros(2), np.full(2, 0.02))
PLAN = Plan({"wheels": (0,)}, every=10.0, length=20.0)
OUTAGE = Outage(120.0, 140.0)


@pytest.fixture(scope="module")
def log():
    whole = simulate("urban", "consumer", 160.0, 5, rate=50.0, chassis=CAR)
    return replace(whole, gnss=withhold(whole.gnss, [OUTAGE], whole.start))


@pytest.fixture(scope="module")
def setup(log):
    """The bridge is trained after ten spectra, so that a short drive has something to rehearse."""
    return settings(changed(named("wheels"), {"bridge.parameters": {"least": 10}}, ""), log, {}, MOUNTING)


@pytest.fixture(scope="module")
def feed(log):
    return list(events(log, {}))


@pytest.fixture(scope="module")
def whole(setup, feed):
    return told(fresh(setup), feed)


def fresh(setup, plan=PLAN):
    return Rehearsing(Navigator(setup), plan)


def told(stage, feed):
    for event in feed:
        stage.step(event)
    return stage


def bits(stage):
    belief, rows = stage.navigator.belief, stage.journal
    spread = [v.tobytes() for v in rows.variances]
    written = rows.times, [x.tobytes() for x in rows.states], spread, rows.sources
    return belief.x.tobytes(), belief.P.tobytes(), written, stage.history, stage.choice, stage.chosen


def singles(feed):
    for event in feed:
        many = isinstance(event, ImuBlock)
        yield from (event.rows(k, k + 1) for k in range(len(event.time))) if many else [event]


def cut(feed, time):
    return next(k for k, e in enumerate(feed) if isinstance(e, ImuBlock) and e.time[-1] > time)


def test_rehearsals_begin_and_end_at_fixed_times(setup, whole):
    began = whole.journal.alignments[0][0] + SETTLE
    assert len(whole.history) >= 3
    for one in whole.history:
        assert (one.start - began) % 10.0 == pytest.approx(0.0, abs=1e-9)
        assert one.end == one.start + 20.0
        assert [(t.bridge, t.preset) for t in one.trials] == [("", ""), ("wheels", "")]
        assert all(t.worst > 0.0 and len(t.nees) >= 1 for t in one.trials)
    spoken = [t.worst != one.trials[0].worst for one in whole.history for t in one.trials[1:]]
    assert any(spoken), "the bridge never spoke"


def test_a_rehearsal_through_which_gnss_fell_silent_is_dropped(whole):
    """A fix of 119 s counts for 1.6 s; no rehearsal reaches into the silence after it."""
    assert all(one.end <= OUTAGE.start + 1.0 for one in whole.history)


def test_blocks_change_no_bits(setup, feed, whole):
    assert bits(told(fresh(setup), singles(feed))) == bits(whole)


@pytest.mark.parametrize("time", [30.0, 75.0, 101.3, 130.0])
def test_snapshot_and_restore(setup, feed, whole, time):
    k, stage = cut(feed, time), fresh(setup)
    told(stage, feed[:k])
    now, kept = bits(stage), stage.snapshot()
    told(stage, feed[k:])
    assert bits(stage) == bits(whole)
    stage.restore(kept)
    assert bits(stage) == now
    told(stage, feed[k:])
    assert bits(stage) == bits(whole)
    other = fresh(setup)
    other.restore(kept)  # its journal begins here, and all else is the same
    told(other, feed[k:])
    assert bits(other)[3:] == bits(whole)[3:]
    assert bits(other)[:2] == bits(whole)[:2]


def test_a_fork_runs_ahead_alone(setup, feed, whole):
    k = cut(feed, 101.3)
    stage = told(fresh(setup), feed[:k])
    now = bits(stage)
    fork = told(stage.fork(), feed[k:])
    assert bits(stage) == now
    assert bits(fork)[3:] == bits(whole)[3:]
    assert bits(fork)[:2] == bits(whole)[:2]


def test_the_budget_limits_the_trials(setup, feed):
    """Twelve trials go on credit, two in each rehearsal; then ten seconds at 0.01 pay for no more."""
    rich = told(fresh(setup, replace(PLAN, budget=4.0)), feed[: cut(feed, 119.0)])
    poor = told(fresh(setup, replace(PLAN, budget=0.01)), feed[: cut(feed, 119.0)])
    assert sum(len(one.trials) for one in poor.history) <= 12
    assert poor.history == rich.history[: len(poor.history)]
    assert len(poor.history) < len(rich.history) or sum(len(one.trials) for one in rich.history) <= 12


def test_no_live_sample_waits_for_a_whole_replay(setup, feed, whole, monkeypatch):
    """Two candidates of 20 s within five: eight times real time, and each sample its share of it."""
    most, shared, step = [0], [0], Navigator.step

    def counted(self, event):
        if not self.keeps_learning and isinstance(event, ImuBlock):
            shared[0] += len(event.time)
        step(self, event)

    monkeypatch.setattr(Navigator, "step", counted)
    stage = fresh(setup)
    for event in singles(feed):
        shared[0] = 0
        stage.step(event)
        most.append(shared[0])
    assert stage.history == whole.history
    assert sum(most) == sum(len(one.trials) for one in whole.history) * 20 * 50
    assert max(most) <= 2 * 20 / 5.0 + 1


def test_a_standing_car_rehearses_nothing():
    """This drive stops for half a minute: what lies mostly in the stop is left out, what does not is not."""
    log = simulate("urban", "consumer", 150.0, 6, rate=50.0, chassis=CAR)
    rich = replace(PLAN, budget=4.0)
    stage = told(fresh(settings(named("wheels"), log, {}, MOUNTING), rich), events(log, {}))
    rows, began = stage.journal.trajectory(), stage.journal.alignments[0][0] + SETTLE
    rehearsed = {round(one.start - began) for one in stage.history}
    speeds = dict[int, float]()
    for k in range(0, int(rows.time[-1] - began - 20.0), 10):
        inside = (rows.time >= began + k) & (rows.time <= began + k + 20.0)
        speeds[k] = np.linalg.norm(rows.v_n[inside, :2], axis=1).mean()
    assert min(speeds.values()) < 1.5
    assert rehearsed == {k for k, speed in speeds.items() if speed > 1.5}


def test_what_was_adopted_survives_a_late_reading(setup, feed):
    """A reading from before the adoption rewinds the navigator; the manner stays."""
    late = replace(setup, lateness=1.0)
    stage = told(fresh(late), feed[: cut(feed, 100.0)])
    manner = replace(setup.manner, voices=(), scale=3.0)
    stage.navigator.adopt(manner)
    fix = next(e for e in reversed(feed[: cut(feed, 100.0)]) if not isinstance(e, ImuBlock))
    state = stage.navigator._state
    stage.step(tuple(r._replace(time=stage.time - 0.3) for r in fix))
    assert stage.navigator._state is not state, "it did not go back"
    assert stage.navigator.dropped == 0
    assert stage.navigator._state.manner is manner


def test_what_was_chosen_speaks(setup, feed):
    """And is told of: who, since when, in how many rehearsals."""
    stage = told(fresh(setup), feed[: cut(feed, 119.0)])
    stage.choice = Choice("wheels", "", 2.0, stage.choice.bridges, ())
    stage._adopt()
    assert stage.navigator._state.manner.voices == (0,)
    assert stage.navigator._state.manner.scale == 2.0
    said = {d.name: d for d in stage.decisions(0.0)}
    assert said["bridge chosen"].value == "wheels"
    assert said["stated covariance in silence"].value == 2.0
    assert said["rehearsed, wheels"].evidence.endswith(f"in {len(stage.history)} rehearsals")


def auto(log, keys):
    decided = Decided({}, MOUNTING, 0.0, (), 100.0)
    return navigator_for(log, changed(named("auto"), keys, ""), decided, 10.0)


def test_a_preset_tunes_and_does_not_rebuild(log):
    loose = {"nonholonomic.lateral": 0.3}
    stage = auto(log, {"rehearsal.presets": {"loose": loose}})
    assert list(stage.plan.bridges) == ["wheels"]
    assert list(stage.plan.presets) == ["loose"]
    one_line = r"^rehearsal\.presets\.{} [^\n]*may tune[^\n]*$".format
    with pytest.raises(ConfigError, match=one_line("more")):
        auto(log, {"rehearsal.presets": {"more": {"filter.states": []}}})
    with pytest.raises(ConfigError, match=one_line("less")):
        auto(log, {"rehearsal.presets": {"less": {"constraints": ["zero_velocity"]}}})


def test_others_must_be_systems_with_a_bridge(log):
    with pytest.raises(ConfigError, match=r"^rehearsal\.others: constraints has no bridge; [^\n]*$"):
        auto(log, {"rehearsal.others": ["constraints"]})
    with pytest.raises(ConfigError, match=r"^rehearsal\.others: [^\n]*nobodys[^\n]*$"):
        auto(log, {"rehearsal.others": ["nobodys"]})
    both = auto(log, {"rehearsal.others": ["liu2019"]})
    assert both.plan.bridges == {"wheels": (0,), "liu2019": (1,), "wheels+liu2019": (0, 1)}
