"""One observation into the belief: how surprising it is, how it counts, what it corrects."""

from __future__ import annotations

import math

import numpy as np

from gapless.filters.adaptation.base import Innovation, Verdict
from gapless.filters.adaptation.registry import kind_of
from gapless.filters.adaptation.relock import soft_bound
from gapless.filters.update import assess, correct
from gapless.fold.journal import Journal
from gapless.fold.settings import Settings
from gapless.fold.state import SOON, State
from gapless.fold.tape import Tape
from gapless.inertial import doubts
from gapless.inertial.belief import Belief, inject
from gapless.inertial.layout import ROW
from gapless.measurements.base import Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.witnesses.askew import pointed
from gapless.witnesses.jolt import about
from gapless.witnesses.testimony import Ruling

MISLED = 60.0
"""For so long after its last word a bridge is suspected where a filter turns out to be wrong [s]."""
FAR, OFTEN = 50.0, 4
"""A filter that fixes put right is not so far off [m] so soon again, unless its attitude or biases are out of
reach of any correction; so often, and nothing of it is believed."""
WITNESS = 1.0
"""For so long after it was believed an odometer is a witness of the speed [s]."""
REVERSED = 2.4
"""What is askew by more is a car that was taken to drive forwards while it reversed [rad]."""
FAST = 3.0
"""A course tells where a car points from this speed on [m/s]."""
DENSITIES = 5
"""How many of the noise parameters are densities; the rest are rates."""


def assimilate(
    state: State,
    settings: Settings,
    channel: str,
    time: float,
    o: Observation,
    journal: Journal,
    tape: Tape | None = None,
    reading: Reading | None = None,
) -> bool:
    """Adapt, correct, write down.

    Parameters
    ----------
    state : State
        Changed in place.
    settings : Settings
    channel : str
    time : float
        The observation holds for [s].
    o : Observation
    journal : Journal
    tape : Tape, optional
    reading : Reading, optional
        That it was made of; none for a constraint or a bridge's word.

    Returns
    -------
    bool
        False where it was rejected, as what is not finite always is, or its channel silenced.
    """
    b, n = state.belief, settings.layout.n
    nis, s, hp = assess(b.p, ROW, n, o.z, o.H, o.R)
    fits = nis <= soft_bound(o.z.size)
    if reading is not None:
        ruling, changed = _heard(state, settings, reading, o, nis, journal), False
    else:
        ruling, changed = _held(state, channel, time, o, fits, journal)
    if changed:
        nis, s, hp = assess(b.p, ROW, n, o.z, o.H, o.R)
    if ruling == "turn":
        _turn(state, o.z, journal, time)
    verdict = _judged(state, channel, time, o, s, nis, ruling)
    if verdict.widen and ruling == "use" and reading is not None:
        journal.heard(channel, time, "believe")
    if not math.isfinite(nis) and _numberless(b, o):
        _lose(state, settings)
    journal.innovation(channel, time, o.z, s, nis, _factor(verdict.r, o.R))
    _process(state, settings, verdict)
    if verdict.widen:
        _widen(state, settings, channel, time, o, ruling, journal)
    r = verdict.r
    if r is None:
        return False
    if verdict.widen:
        _, s, hp = assess(b.p, ROW, n, o.z, o.H, r)
    elif r is not o.R:
        s = s + (r - o.R)
    if tape is not None:
        tape.corrected(o.H, hp, s, o.z)
    dx = correct(b.p, ROW, n, o.z, o.H, r, s, hp, verdict.gain)
    if channel == "position":
        seen = _seen(b, o.H)
        if o.slow is not None:
            state.wander.hear(time, seen, r, o.slow)
        state.stamps.hear(time, seen.ravel(), len(seen), r, b.v_n, settings.doubt.lasting)
    state.hearing.corrected = state.hearing.corrected + dx
    if b.error.size:
        b.error[:n] += dx
    else:
        inject(b.x, dx)
        b.trail.shift(dx[3:6])
    return True


def _held(
    state: State, channel: str, time: float, o: Observation, fits: bool, journal: Journal
) -> tuple[Ruling, bool]:
    """What becomes of a constraint, or a bridge's word; whether the belief was changed by it."""
    hearing, b = state.hearing, state.belief
    if channel == "zero_velocity":
        known, seen = np.sqrt(b.P.diagonal()[9:12]), hearing.channels.seen(time)
        drift = hearing.rest.drifts(time, o.z[3:], known, seen)
        if drift is not None:
            doubts.drift(b, drift)
            journal.moved(time, "gyro", float(np.linalg.norm(drift)))
        return "use", drift is not None
    if channel == "nonholonomic":
        since, news = hearing.in_vain(channel, time, fits)
        if news and _slips(state, o.z, since, time, journal):
            return "use", True
        if since and not hearing.channels.seen(time):
            return "silence", False
    return "use", False


def _judged(
    state: State, channel: str, time: float, o: Observation, s: Array, nis: float, ruling: Ruling
) -> Verdict:
    """How an observation counts."""
    if ruling in ("believe", "turn"):
        return Verdict(o.R, widen=True)
    if ruling != "use" or not math.isfinite(nis):
        return Verdict(None)
    denied = channel == "velocity" and _denied(state, time, o.z)
    told = Innovation(channel, time, o.z, s, o.R, nis, denied)
    verdict = state.adaptation[kind_of(channel)].judge(told)
    if verdict.r is o.R and not verdict.widen:
        state.agreed[channel] = time
    return verdict


def _numberless(b: Belief, o: Observation) -> bool:
    """Whether it is not what was read that is no number, but the belief."""
    return not np.isfinite(b.x).all() or bool(np.isfinite(o.z).all() and np.isfinite(o.R).all())


def _widen(
    state: State,
    settings: Settings,
    channel: str,
    time: float,
    o: Observation,
    ruling: Ruling,
    journal: Journal,
) -> None:
    """Doubt the filter where it is what was wrong."""
    b, channels = state.belief, state.hearing.channels
    if ruling == "believe" and channel == "odometer" and not (state.lost or channels.seen(time)):
        _felt_wrongly(state, o.z, channels.of[channel].insisted, time, journal)
    b.widen(o.H, o.z)
    if channel == "position":
        _find_astray(state, settings, time, o.z)
    misled = time - state.heard.get("bridge", -math.inf) < MISLED
    if channel == "velocity" and (misled or ruling != "use"):
        doubts.doubt(b, float(np.hypot(*o.z[:2])), settings.ceiling)


def _heard(
    state: State, settings: Settings, reading: Reading, o: Observation, nis: float, journal: Journal
) -> Ruling:
    """What witnesses rule; a channel that falls silent, or is heard again, is written down."""
    bound = soft_bound(o.z.size)
    ruling = state.hearing.hear(reading, o, nis, bound, state.belief)
    journal.heard(reading.channel, reading.time, ruling)
    if state.hearing.channels.beside_the_road(reading.time):
        _lose(state, settings)
        return "believe"
    return ruling


def _slips(state: State, z: Array, since: float, time: float, journal: Journal) -> bool:
    """Doubt how the box sits in the car; or, where nobody sees the car move, all that it felt of late.

    There, a constraint alone is not believed: nobody knows whether the car slips or the box was moved.
    """
    if state.hearing.channels.seen(time):
        journal.knock(time, doubts.remount(state.belief, z), state.box)
        return True
    if state.hearing.channels.rolls_otherwise(time):
        _felt_wrongly(state, z, since, time, journal)
        state.hearing.channels.acquit("odometer")
        return True
    return False


def _felt_wrongly(state: State, z: Array, since: float, time: float, journal: Journal) -> None:
    """What is left to tell of the motion denies what was felt: a force was none."""
    off = float(np.linalg.norm(z))
    journal.moved(time, "force", off / since)
    doubts.tipped(state.belief, off, since)


def _turn(state: State, z: Array, journal: Journal, time: float) -> None:
    """Put right what is askew: the box, where the car points along its course, or else the heading."""
    b, angle = state.belief, state.hearing.turned
    v, c = b.v_n[:2] + z[:2], b.C_nb
    yaw = float(b.block("mounting")[1]) if "mounting" in b.layout else 0.0
    ahead = math.atan2(c[1, 0], c[0, 0]) + yaw
    if abs(angle) < REVERSED and math.hypot(*v) > FAST and pointed(math.atan2(v[1], v[0]), ahead, angle):
        turn = about(c[2], angle)
        state.box = turn if state.box is None else turn @ state.box
        journal.knock(time, angle, state.box)
        state.hearing.channels.moved = time
        angle = 0.0
    else:
        journal.moved(time, "heading", angle)
    doubts.turn(b, angle)


def _find_astray(state: State, settings: Settings, time: float, z: Array) -> None:
    """Notice that a filter which was put right goes far astray again and again: then it is lost."""
    if math.hypot(*z) > FAR:
        state.astray = (*(t for t in state.astray if time - t < SOON), time)
    if len(state.astray) >= OFTEN:
        _lose(state, settings)


def _lose(state: State, settings: Settings) -> None:
    """Wait for a start, which begins anew."""
    if not state.lost:
        state.aligner, state.astray, state.lost = settings.aligner.copy(), (), True
        state.box = None


def _denied(state: State, time: float, z: Array) -> bool:
    """Whether it is mostly a change of speed, and an odometer that was just believed does not see it."""
    if time - state.agreed.get("odometer", -math.inf) > WITNESS:
        return False
    v = state.belief.v_n[:2]
    off = math.hypot(*(v + z[:2])) - math.hypot(*v)
    return abs(off) > 0.5 * math.hypot(*z[:2])


def _seen(belief: Belief, h: Array) -> Array:
    """Covariance of what an observation looks at, H P H', as `Wander.hear` takes it.

    Of a position that is the antenna's. The first three states stand for it only where the antenna is at the
    box: a lever arm of metres adds the attitude's part, and one that is a state its own.
    """
    return np.ascontiguousarray(h @ belief.P @ h.T)


def _factor(counted: Array | None, stated: Array) -> float:
    """By how much R was inflated, for the journal: the mean over its variances."""
    if counted is None:
        return math.inf
    return 1.0 if counted is stated else float((counted.diagonal() / stated.diagonal()).mean())


def _process(state: State, settings: Settings, verdict: Verdict) -> None:
    """What a rule does to the way to the next epoch."""
    state.fade *= verdict.fade
    if verdict.noise is not None:
        state.noise = state.manner.noise.copy()
        state.noise[:DENSITIES] *= verdict.noise
