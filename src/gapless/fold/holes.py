"""A hole of the IMU that is too long to be bridged."""

from __future__ import annotations

from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.fold.tape import Tape


def gap(state: State, settings: Settings, tape: Tape | None, begin: float) -> None:
    """Little is known of the motion; what is constant is kept.

    Navigation goes on in doubt of its heading, which is set aside while nothing is heard that has a
    direction. Then, until a course is heard, constraints that need one rest.

    Parameters
    ----------
    state : State
        Changed in place.
    settings : Settings
    tape : Tape or None
    begin : float
        When samples come again [s].
    """
    while state.pending and state.pending[0].time <= begin:
        state.pending.pop(0)
    state.hearing.forget()
    state.aligner = settings.aligner.copy()
    if state.aligned:
        state.lose_track(begin)
        for bridge in state.bridges:
            bridge.lost()
        for constraint in state.constraints.values():
            constraint.lost()
        if tape is not None:
            tape.missed(begin - state.clock)
    state.lately.forget()
    state.clock = begin
