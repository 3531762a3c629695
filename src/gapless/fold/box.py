"""A box that was turned in the car: what it feels is taken to the axes in which it sat at first."""

from __future__ import annotations

import math

import numpy as np

from gapless.fold.journal import Journal
from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.inertial import doubts
from gapless.inertial import propagate as at
from gapless.inertial.layout import ROW
from gapless.trip.events import ImuBlock, Motion
from gapless.trip.recording import Array
from gapless.witnesses.jolt import upright
from gapless.witnesses.seat import LASTS


def in_box(block: ImuBlock, box: Array | None) -> ImuBlock:
    """Samples in the axes of the box as it sat at first.

    Parameters
    ----------
    block : ImuBlock
    box : ndarray, shape (3, 3), or None
        None where it was never moved.

    Returns
    -------
    ImuBlock
    """
    if box is None:
        return block
    # column by column: a matrix product's bits would depend on how many rows there are
    dtheta, dvel = (
        np.stack([v[:, 0] * r[0] + v[:, 1] * r[1] + v[:, 2] * r[2] for r in box], axis=1)
        for v in (block.dtheta, block.dvel)
    )
    return block._replace(dtheta=dtheta, dvel=dvel)


def before_box(state: State) -> Array:
    """What the last sample left behind, as the sensors felt it.

    Parameters
    ----------
    state : State

    Returns
    -------
    ndarray
        As `propagate` keeps it; not to be changed.
    """
    memory, box = state.belief.memory, state.box
    if box is None:
        return memory
    felt = memory.copy()
    for k in (at.PREV_THETA, at.PREV_VEL):
        felt[k : k + 3] = box.T @ memory[k : k + 3]
    return felt


def watch(state: State, settings: Settings, journal: Journal, motion: Motion) -> None:
    """Notice that the box was knocked over, and go on in its former axes.

    Parameters
    ----------
    state : State
        Changed in place.
    settings : Settings
    journal : Journal
    motion : Motion
        Of the tick that ends now.
    """
    b = state.belief
    tilt, c, force = upright(b.p, ROW, b.x, motion.rate, motion.force)
    jolt = state.hearing.jolts.feel(force, c, tilt, motion.dt, b.v_n)
    if jolt is not None and not state.lost:  # else it is the attitude that leans
        doubts.knocked(b, jolt.turn, jolt.since, jolt.gained, settings.ceiling)
        _moved(state, journal, jolt.turn, jolt.since, jolt.angle)
        return
    speed = math.hypot(*b.v_n[:2].tolist())
    turn = state.hearing.seat.moved(c, tilt, state.hearing.jolts.lean, speed, motion.rate)
    if turn is not None and not state.lost:
        doubts.reseated(b, turn, settings.ceiling)
        turned = math.acos(
            min(1.0, max(-1.0, 0.5 * (float(np.trace(turn)) - 1.0)))
        )  # roundings leave [-1, 1]
        _moved(state, journal, turn, LASTS * motion.dt, turned)


def _moved(state: State, journal: Journal, turn: Array, since: float, angle: float) -> None:
    """What it feels is taken to the axes of before, and what hung on it is doubted."""
    state.box = turn if state.box is None else turn @ state.box
    state.hearing.forget()
    state.hearing.channels.moved = state.clock
    for bridge in state.bridges:
        bridge.lost()
    journal.knock(state.clock - since, angle, state.box)
