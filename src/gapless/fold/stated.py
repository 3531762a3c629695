"""What is stated of a position beside the filter's covariance: what no update of it can tell."""

from __future__ import annotations

import numpy as np

from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.trip.recording import Array

HOLDS = 4.0
"""A 95 % ellipse (5.99) holds what is off by the root of its variance times this, with some room."""


def beside(state: State, settings: Settings) -> Array:
    """Covariance on top of the belief's: what fixes share, clocks and arms in doubt, a place that moved.

    Parameters
    ----------
    state : State
    settings : Settings

    Returns
    -------
    ndarray, shape (3, 3)
        North, east, down [m^2].
    """
    shared = state.wander.response + state.stamps.stated(settings.doubt)
    if settings.arm_doubt.any():
        c = state.belief.C_nb
        shared = shared + c @ settings.arm_doubt @ c.T
    off = state.hearing.offset
    if off.any():  # fixes that moved away and stay there: nobody knows yet which place is right
        shared = shared + np.outer(off, off) / HOLDS
    if state.source != "gnss" and state.manner.scale != 1.0:
        shared = shared + (state.manner.scale - 1.0) * state.belief.P[:3, :3]
    return shared
