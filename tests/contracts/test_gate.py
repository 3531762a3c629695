"""The gate: a lone spike moves nothing, and no lie, however long, locks the truth out for good."""

from dataclasses import replace

import numpy as np
import pytest
from folding import CAR, fold, prepared, rows

from gapless import earth
from gapless.filters.adaptation.base import Innovation
from gapless.filters.adaptation.gate import Gate
from gapless.filters.adaptation.relock import SOFT
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.simulate import Receiver, WheelSensor, simulate
from gapless.trip.events import ImuBlock
from gapless.trip.motion import displace

START = 60.0
"""Driving, and well settled [s]."""


@pytest.fixture(scope="module", params=[1.0, 10.0])
def settled(request):
    """A navigator at START, and the log from there on."""
    log = simulate("urban", "consumer", 250.0, 4, vehicle=CAR, receiver=Receiver(rate=request.param))
    navigator = Navigator(prepared(log, "exact"))
    return fold(navigator, events(log.slice(-np.inf, START), {})), log.slice(START, np.inf)


def shifted(log, stretch, metres=(0.0, 0.0), speed=(0.0, 0.0)):
    """The log with the fixes of a stretch moved to the north and east."""
    g = log.gnss
    struck = ((g.time >= stretch[0]) & (g.time < stretch[1]))[:, None]
    lla = np.where(struck, displace(g.lla, np.tile([*metres, 0.0], (len(g), 1))), g.lla)
    return replace(log, gnss=replace(g, lla=lla, v_n=g.v_n + struck * np.array([*speed, 0.0])))


def after(navigator, log, until=np.inf):
    return fold(navigator.fork(), events(log.slice(-np.inf, until), {}))


@pytest.mark.parametrize("bearing", [0.3, 1.9, 4.4])
def test_a_lone_spike_moves_nothing(settled, bearing):
    """Sizes as receivers throw them, at one fix; against the same drive without that fix."""
    navigator, log = settled
    t = log.gnss.time[np.searchsorted(log.gnss.time, START + 3.5)]
    missing = replace(log, gnss=log.gnss.take(log.gnss.time != t))
    without = after(navigator, missing, t + 0.05).belief
    way = np.array([np.cos(bearing), np.sin(bearing)])
    for size in (20.0, 50.0, 130.0, 500.0):
        b = after(navigator, shifted(log, (t, t + 1e-3), metres=size * way), t + 0.05).belief
        assert np.linalg.norm(earth.lla_to_ned(b.lla, without.lla)) < 1.0, size
    for size in (10.0, 30.0, 120.0, 400.0):
        b = after(navigator, shifted(log, (t, t + 1e-3), speed=size * way), t + 0.05).belief
        assert np.linalg.norm(b.v_n - without.v_n) < 0.3, size


def apart(told, honest):
    """Horizontal distance of two navigators [m]."""
    return float(np.linalg.norm(earth.lla_to_ned(told.belief.lla, honest.belief.lla)[:2]))


LIES = {
    "far": {"metres": (80.0, -60.0)},
    "near": {"metres": (18.0, 12.0)},
    "farther": {"metres": (-2e4, 3e4)},
    "fast": {"speed": (12.0, 9.0)},
    "slow": {"speed": (1.5, -1.0)},
    "absurd": {"speed": (300.0, 200.0)},
}


@pytest.mark.parametrize("lie", LIES)
def test_no_lie_locks_the_truth_out(settled, lie):
    """Ten seconds of fixes that agree on something wrong; 15 s later the truth is back."""
    navigator, log = settled
    told = after(navigator, shifted(log, (START + 1.0, START + 11.0), **LIES[lie]), START + 26.0)
    assert apart(told, after(navigator, log, START + 26.0)) < 10.0


def test_fixes_that_agree_on_nothing_are_an_outage(settled):
    """Ten seconds of positions and velocities anywhere, then the truth: used from the first on."""
    navigator, log = settled
    g, rng = log.gnss, np.random.default_rng(8)
    wild = (g.time >= START + 1.0) & (g.time < START + 11.0)
    jump = wild[:, None] * rng.uniform(-1.0, 1.0, (len(g), 3)) * [300.0, 300.0, 0.0]
    struck = replace(g, lla=displace(g.lla, jump), v_n=g.v_n + jump)
    told = after(navigator, replace(log, gnss=struck), START + 13.0)
    assert apart(told, after(navigator, log, START + 13.0)) < 3.0


@pytest.mark.parametrize(
    ("channel", "displaced", "soon"),
    [("position", 12.0, 35.0), ("position", 25.0, 120.0), ("position", 3e3, 35.0), ("velocity", 2.0, 20.0)],
)
def test_a_filter_that_is_wrong_and_sure_gives_in(settled, channel, displaced, soon):
    """Moved away without being told, its deviations 0.4 m and 0.07 m/s: good fixes bring it back.

    Positions leap, for the filter, and leap is what a receiver that lies does, too: they are believed after
    `PATIENCE`, half a minute, however far it is. Velocities that follow the motion insist for some seconds.
    """
    navigator, log = settled
    lost = navigator.fork()
    if channel == "position":
        lost.belief.x[0] += displaced / 6.37e6
    else:
        lost.belief.x[3] += displaced
    fold(lost, events(log.slice(-np.inf, START + soon), {}))
    assert apart(lost, after(navigator, log, START + soon)) < 10.0


def test_a_filter_that_is_beyond_correction_begins_anew(settled):
    """Upside down, with a gyro bias of half a turn in six seconds, and sure of both; fixes go on."""
    navigator, log = settled
    wrecked = navigator.fork()
    wrecked._past.entries.clear()  # what it remembers is sound
    wrecked.belief.x[6:10] = [0.0, 0.6, 0.8, 0.0]
    wrecked.belief.x[10:13] = 0.5
    fold(wrecked, events(log, {}))
    honest = after(navigator, log)
    assert len(wrecked.journal.alignments) == len(honest.journal.alignments) + 1
    assert "anew" in wrecked.journal.alignments[-1][1]
    assert apart(wrecked, honest) < 1.0  # as if nothing had been


@pytest.mark.parametrize("where", ["x", "p"])
def test_a_filter_without_a_number_begins_anew(settled, where):
    navigator, log = settled
    wrecked = navigator.fork()
    getattr(wrecked.belief, where)[4] = np.nan
    fold(wrecked, events(log, {}))
    assert apart(wrecked, after(navigator, log)) < 1.0


@pytest.mark.parametrize("lie", ["far", "farther", "fast"])
def test_one_lie_is_no_reason_to_begin_anew(settled, lie):
    navigator, log = settled
    told = after(navigator, shifted(log, (START + 1.0, START + 11.0), **LIES[lie]))
    assert len(told.journal.alignments) == len(after(navigator, log).journal.alignments)


def told(channel, time, z, nis, m):
    """An innovation of that surprise, with R = 1."""
    return Innovation(channel, time, z, 2.0 * np.eye(m), np.eye(m), nis)


def test_r_is_never_made_smaller():
    rng, gate = np.random.default_rng(0), Gate()
    sizes = {"position": 3, "velocity": 3, "odometer": 1, "nonholonomic": 2, "zero_velocity": 6}
    for k in range(3000):
        nis = 10.0 ** rng.uniform(-3.0, 9.0)
        channel = str(rng.choice(list(sizes)))
        m = sizes[channel]
        verdict = gate.judge(told(channel, 0.1 * k, rng.normal(0.0, 10.0, m), nis, m))
        assert verdict.r is None or (verdict.r >= np.eye(m)).all()
        assert (verdict.r is not None and (verdict.r == np.eye(m)).all()) or nis > SOFT[m]


def driven(speed, lasting):
    """How far a drive with an odometer is led astray by velocities that are wrong along the way."""
    log = simulate(
        "urban", "consumer", 130.0, 4, vehicle=CAR, receiver=Receiver(rate=1.0), wheels=WheelSensor(rate=10.0)
    )
    g = log.gnss
    moving = np.hypot(*g.v_n[:, :2].T)
    begin = g.time[(g.time > START) & (moving > 8.0)][0]
    struck = (g.time >= begin) & (g.time < begin + lasting)
    along = g.v_n * np.array([1.0, 1.0, 0.0]) / np.maximum(moving, 1.0)[:, None]
    unsure = np.where(
        struck[:, None], 30.0, g.sd_position
    )  # a receiver that errs in speed is not sure of its place
    bad = replace(log, gnss=replace(g, v_n=g.v_n + speed * struck[:, None] * along, sd_position=unsure))
    until, setup = begin + lasting + 1.5, prepared(log, "exact")
    told, honest = (
        fold(Navigator(setup), events(one.slice(-np.inf, until), {"odometer": 0.0})) for one in (bad, log)
    )
    return apart(told, honest)


def test_wheels_that_are_believed_deny_a_speed_that_a_receiver_makes_up():
    """Eight seconds of 6 m/s too much, as an urban receiver gave them, its place unknown to 30 m: 48 m."""
    assert driven(6.0, 8.0) < 5.0


def test_what_is_denied_must_last():
    """Of a run of velocities that agree, the first are believed after 5 s, or after 20 s where denied."""
    for denied, seconds in ((False, 5), (True, 20)):
        gate = Gate()
        gate.judge(told("velocity", 0.0, np.zeros(3), 1.0, 3))
        said = [
            gate.judge(told("velocity", 0.5 * k, np.full(3, 5.0), 1e3, 3)._replace(denied=denied)).widen
            for k in range(1, 60)
        ]
        assert said.index(True) == 2 * seconds


def test_a_poisoned_observation_is_refused():
    assert Gate().judge(told("position", 0.0, np.full(3, np.nan), np.nan, 3)).r is None


def test_a_copy_remembers_and_forgets_alone():
    gate = Gate()
    gate.judge(told("position", 0.0, np.zeros(3), 1.0, 3))
    twin = gate.copy()
    for t in range(1, 5):
        twin.judge(told("position", float(t), np.full(3, 50.0), 1e4, 3))
    assert gate.relock.runs == {}
    assert twin.relock.runs["position"].length == 4


def test_forks_hear_only_their_own(settled):
    """(So the tests above compare what they say they compare.)"""
    navigator, log = settled
    assert rows(after(navigator, log)) == rows(after(navigator, log))
    assert any(isinstance(e, ImuBlock) for e in events(log, {}))
