"""What is stated of a position beside the filter's covariance: what no update of it can tell."""

from __future__ import annotations

from gapless.attitude import matrix
from gapless.filters.beside import add
from gapless.filters.stamp_doubt import swung
from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.trip.recording import Array


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
    b, stamps, doubt = state.belief, state.stamps, settings.doubt
    shared = swung(stamps.constant, stamps.moved, doubt.common, doubt.apart, doubt.wobble)
    add(shared, state.wander.response, matrix(b.q_nb), settings.arm_doubt, state.hearing.offset)
    if state.manner.scale != 1.0 and state.source != "gnss":
        shared += (state.manner.scale - 1.0) * b.P[:3, :3]
    return shared
