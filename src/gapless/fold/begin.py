"""The navigator takes over an initial state, the first one or one after the IMU was silent."""

from __future__ import annotations

import numpy as np

from gapless import earth
from gapless.alignment.coarse import Start
from gapless.filters.consider import Wander
from gapless.fold.journal import Journal
from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.fold.tape import Tape
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief
from gapless.inertial.trail import Trail
from gapless.trip.motion import displace
from gapless.units import DEG


def begin(start: Start, state: State, settings: Settings, journal: Journal, tape: Tape | None) -> None:
    """Go on from a start; blocks that an earlier alignment left are kept.

    Parameters
    ----------
    start : Start
    state : State
        Changed in place.
    settings : Settings
    journal : Journal
    tape : Tape, optional
    """
    b, sd = state.belief, settings.initial_sd
    b.x[:3], b.x[3:6], b.x[6:10] = start.lla, start.v_n, start.q_nb
    b.error[:9] = 0.0
    state.hearing.forget()
    first = state.lost or not state.aligned
    if first:
        state.hearing.seat.forget()
        _first(start, state, settings)
    evidence = start.evidence
    if state.lost:
        _forget(state, settings)
        evidence += "; anew, for the filter was beyond what fixes put right"
    b.set_sd("position", 2.0 * start.sd_position + 1.0)
    b.set_sd("velocity", start.sd_velocity + 0.5)
    b.set_sd("attitude", np.array([1.0, 1.0, 0.0]) * sd["attitude"])
    b.course_heading(start.sd_heading)
    _from_antenna(b)
    b.memory[:] = 0.0
    b.memory[at.TIME] = state.clock
    if tape is not None:
        tape.forgot(everything=first, course=True)
    state.aligner, state.aligned, state.turned = None, True, None
    state.next_row = max(state.next_row, state.clock)
    journal.align(state.clock, evidence)


def _from_antenna(b: Belief) -> None:
    """A start has the antenna's position; where the arm is estimated, the box's is that far from it."""
    if "lever_arm" in b.layout:
        b.x[:3] = displace(b.x[None, :3], -(b.C_nb @ b.block("lever_arm"))[None])[0]
        b.hang()


def _first(start: Start, state: State, settings: Settings) -> None:
    """What is constant, as far as it is known before anything was seen."""
    b, sd = state.belief, settings.initial_sd
    b.x[10:], b.error[:] = 0.0, 0.0
    for name, value in settings.initial.items():
        b.block(name)[:] = value
    for name in settings.layout.blocks:
        b.set_sd(name, sd.get(name, 0.0))
    prior = np.asarray(sd["gyro_bias"])
    # the mean rate of a standstill holds the earth's: no news to a gyro that is known better
    if start.gyro_bias is not None and float(prior.max()) > 2.0 * earth.RATE:
        b.block("gyro_bias")[:] = start.gyro_bias
        b.set_sd("gyro_bias", np.minimum(prior, 0.1 * DEG))


def _forget(state: State, settings: Settings) -> None:
    """What a filter that was lost had learned on the way, of itself and of its sensors' noise."""
    state.belief.trail = Trail(state.belief.trail.length)
    state.adaptation = {kind: rule.copy() for kind, rule in settings.adaptation.items()}
    state.wander, state.noise, state.lost = Wander(settings.wander_time), state.manner.noise, False
    for bridge in state.bridges:
        bridge.lost()
