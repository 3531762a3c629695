"""Laws of bridges: prefix and resume for every paper's system, silence untrained, no harm if calibrated."""

from dataclasses import replace

import numpy as np
import pytest
from folding import belief, fold, heard, rows

from gapless import earth
from gapless.bridges.epochs import FEATURES
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.scenarios import Outage, withhold
from gapless.simulate import simulate
from gapless.systems.adjust import changed, named
from gapless.systems.build import settings
from gapless.systems.library import names

PAPERS = ("wang2018", "liu2019", "georges2015", "aslinezhad2020", "tan2015")
OUTAGES = (Outage(100.0, 125.0), Outage(170.0, 195.0))
MOUNTING = (np.zeros(2), np.full(2, 0.02))
QUICK = {
    "tan2015": {"learner.parameters": {"generations": 2, "population": 4, "cv": 2}},
    "aslinezhad2020": {"learner.parameters": {"max_iter": 30}},
}
"""The same code in fewer steps."""


@pytest.fixture(scope="module")
def log():
    whole = simulate("urban", "consumer", 205.0, 6)
    return replace(whole, gnss=withhold(whole.gnss, OUTAGES, whole.start))


def system(name):
    return changed(
        named(name), QUICK.get(name, {}) | {"denoise.method": "none", "filter.moments": "taylor"}, ""
    )


@pytest.mark.parametrize("name", PAPERS)
def test_prefix_and_resume(log, name):
    setup = settings(system(name), log, {}, MOUNTING)
    whole = fold(Navigator(setup), events(log, {}))
    said = {c for c in heard(whole) if c.startswith("bridge")}
    assert said, "it never spoke"
    assert {s for *_, s in rows(whole)} >= {"gnss", "bridge"}
    for t in (110.03, 150.0, 180.0):
        part = fold(Navigator(setup), events(log.slice(-np.inf, t), {}))
        assert rows(part) == rows(whole, end=part.time + 1e-9), t
    feed = list(events(log, {}))
    navigator = Navigator(setup)
    cut = next(k for k, e in enumerate(feed) if hasattr(e, "dtheta") and e.time[-1] > 100.0)
    fold(navigator, feed[:cut])
    kept = navigator.snapshot()
    fold(navigator, feed[cut:])
    assert belief(navigator) == belief(whole)
    navigator.restore(kept)
    fold(navigator, feed[cut:])
    assert rows(navigator) == rows(whole)
    assert belief(navigator) == belief(whole)


def test_untrained_says_nothing(log):
    """Fewer epochs than it takes: the run is the filter's alone, bit for bit."""
    few = changed(named("liu2019"), {"denoise.method": "none", "bridge.least": 250}, "")
    with_it = fold(Navigator(settings(few, log, {}, MOUNTING)), events(log, {}))
    alone = fold(Navigator(settings(named("liu2019-bridge-denoise"), log, {}, MOUNTING)), events(log, {}))
    assert rows(with_it) == rows(alone)


class _Random:
    """Learns nothing: answers with targets drawn at random from those that it was shown."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)

    def fit(self, x, y):
        self.targets = y
        return self

    def predict(self, x):
        return self.targets[self.rng.integers(len(self.targets), size=len(x))]


@pytest.mark.parametrize("name", ["liu2019", "wang2018"])
def test_a_calibrated_bridge_that_knows_nothing_does_no_harm(name):
    """Within 10 % of the same filter without it, the outages of several drives together."""
    keys = {"denoise.method": "none", "bridge.noise": "calibrated", "adaptation.gnss": ["gate"]}
    errors = {"with": [], "without": []}
    for seed in (1, 2, 3):
        whole = simulate("urban", "consumer", 420.0, seed)
        outages = (Outage(150.0, 190.0), Outage(250.0, 290.0), Outage(350.0, 390.0))
        log = replace(whole, gnss=withhold(whole.gnss, outages, whole.start))
        for kind, errors_of in errors.items():
            recipe = changed(named(name if kind == "with" else f"{name}-bridge"), keys, "")
            setup = settings(recipe, log, {}, MOUNTING)
            if kind == "with":
                (bridge,) = setup.bridges
                setup = replace(setup, bridges=(replace(bridge, learner=lambda: _Random(7)),))
            path = fold(Navigator(setup), events(log, {})).journal.trajectory()
            truth = whole.reference
            for o in outages:
                inside = (path.time > o.start) & (path.time <= o.until)
                at = np.searchsorted(truth.time, path.time[inside] - 1e-6)
                off = earth.lla_to_ned(path.lla[inside], path.lla[inside][0])
                off -= earth.lla_to_ned(truth.lla[at], path.lla[inside][0])
                errors_of.append(float(np.hypot(off[:, 0], off[:, 1]).max()))
    ratios = np.array(errors["with"]) / np.array(errors["without"])
    assert np.exp(np.log(ratios).mean()) < 1.1, ratios.round(2)


class _RunsAway:
    """Thirty times as much with each word, until no number can hold it."""

    def __init__(self):
        self.said = 0.0

    def fit(self, x, y):
        self.outputs = y.shape[1]
        return self

    def predict(self, x):
        assert np.isfinite(x).all()  # as scikit-learn asks
        self.said = min(30.0 * self.said, 1e300) if self.said else 1.0
        return np.full((len(x), self.outputs), self.said * 1e20 if self.said > 1e200 else self.said)


@pytest.mark.parametrize(
    ("name", "correction"),
    [("wang2018", "feedback"), ("georges2015", "feedback"), ("liu2019", "feedforward")],
)  # errors against GNSS, errors that feed on themselves, increments
def test_a_learner_that_runs_away_does_not_take_the_filter_along(log, name, correction):
    """Not to where no fix brings it back from: fixes follow the outage for 45 s."""
    setup = settings(changed(system(name), {"filter.correction": correction}, ""), log, {}, MOUNTING)
    (bridge,) = setup.bridges
    setup = replace(setup, bridges=(replace(bridge, learner=_RunsAway),))
    part = log.slice(-np.inf, 169.0)
    navigator = fold(Navigator(setup), events(part, {}))
    assert any(channel.startswith("bridge") for channel in heard(navigator))
    path = navigator.journal.trajectory()
    assert np.isfinite(path.lla).all()
    truth = log.reference.lla[np.searchsorted(log.reference.time, path.time[-1] - 1e-6)]
    assert np.abs(earth.lla_to_ned(path.lla[-1], truth)).max() < 10.0  # fixes are good to 3 m


@pytest.mark.parametrize("name", names())
def test_every_recipe_builds(name):
    log = simulate("urban", "consumer", 30.0, 1)
    recipe = named(name)
    assert recipe.name == name
    assert recipe.description
    setup = settings(recipe, log, {}, MOUNTING)
    assert len(setup.bridges) == (recipe.bridge.model != "none") + len(recipe.rehearsal.others)
    assert set(recipe.bridge.features) <= set(FEATURES)
