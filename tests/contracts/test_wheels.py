"""Laws of the wheels and of rehearsal: prefix, resume, and silence untrained; on a car that can be heard."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.fold.feed import events
from gapless.runs.conduct import navigator_for
from gapless.runs.decide import Decided
from gapless.scenarios import Outage, withhold
from gapless.simulate import CAR, simulate
from gapless.systems.adjust import changed, named
from gapless.trip.events import ImuBlock

OUTAGES = (Outage(235.0, 250.0), Outage(285.0, 300.0))
DECIDED = Decided({}, (np.zeros(2), np.full(2, 0.02)), 0.0, (), 100.0)
QUICK = {"wheels": {}, "auto": {"rehearsal.length": 40.0, "rehearsal.every": 10.0}}


@pytest.fixture(scope="module")
def log():
    whole = simulate("urban", "consumer", 305.0, 3, rate=50.0, chassis=CAR)
    return replace(whole, gnss=withhold(whole.gnss, OUTAGES, whole.start))


def folded(navigator, feed):
    for event in feed:
        navigator.step(event)
    return navigator


def rows(navigator, end=np.inf):
    j = navigator.journal
    written = zip(j.times, j.states, j.variances, j.shared, j.sources, strict=True)
    return [(t, x.tobytes(), v.tobytes(), c.tobytes(), s) for t, x, v, c, s in written if t < end]


def fresh(log, name, **keys):
    return navigator_for(log, changed(named(name), QUICK[name] | keys, ""), DECIDED, 10.0)


@pytest.mark.parametrize("name", QUICK)
def test_prefix(log, name):
    whole = folded(fresh(log, name), events(log, {}))
    assert "bridge_speed" in whole.journal.channels, "it never spoke"
    for t in (110.03, 243.21, 270.0, 293.0):
        part = folded(fresh(log, name), events(log.slice(-np.inf, t), {}))
        assert rows(part) == rows(whole, part.time + 1e-9), t


@pytest.mark.parametrize("name", QUICK)
def test_spoilt_later_samples_change_nothing_before_them(log, name):
    """A block reaches ahead of what is said in its middle: nobody may look there."""
    feed = list(events(log, {}))
    k = next(k for k, e in enumerate(feed) if isinstance(e, ImuBlock) and e.time[-1] > 240.0)
    block = feed[k]
    assert block.time[-1] - block.time[0] > 10.0
    until = int(np.searchsorted(block.time, 242.0))
    late = np.arange(len(block.time)) >= until
    loud = block._replace(dvel=block.dvel + 0.5 * block.dt[:, None] * late[:, None])
    a, b = (folded(fresh(log, name), [*feed[:k], one]) for one in (block, loud))
    end = float(block.time[until - 1]) + 1e-9
    assert rows(a, end) == rows(b, end)
    assert rows(a) != rows(b)


@pytest.mark.parametrize("name", QUICK)
def test_resume(log, name):
    feed = list(events(log, {}))
    whole = folded(fresh(log, name), feed)
    for t in (100.0, 250.5):
        k = next(k for k, e in enumerate(feed) if isinstance(e, ImuBlock) and e.time[-1] > t)
        navigator = folded(fresh(log, name), feed[:k])
        kept = navigator.snapshot()
        folded(navigator, feed[k:])
        assert rows(navigator) == rows(whole)
        navigator.restore(kept)
        folded(navigator, feed[k:])
        assert rows(navigator) == rows(whole)
        other = fresh(log, name)
        other.restore(kept)
        folded(other, feed[k:])
        assert rows(other) == rows(whole)[-len(rows(other)) :]


@pytest.mark.parametrize("name", QUICK)
def test_untrained_says_nothing(log, name):
    """Fewer spectra than it takes: the run is that of constraints alone, bit for bit."""
    few = folded(fresh(log, name, **{"bridge.parameters": {"least": 1000}}), events(log, {}))
    alone = navigator_for(log, named("constraints"), DECIDED, 10.0)
    folded(alone, events(log, {}))
    assert "bridge_speed" not in few.journal.channels
    states = [(t, x) for t, x, *_ in rows(few)]
    assert states == [(t, x) for t, x, *_ in rows(alone)]
