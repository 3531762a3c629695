"""What is believed of clock offsets that were found, and how it is told."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from gapless.alignment.clock import Offset
from gapless.solution import Decision

VAGUE = 0.1
"""An offset is not believed by itself where its standard deviation is larger [s]."""
ONE_CLOCK = 0.1
"""By how much the offsets of a receiver's positions and velocities differ, as a standard deviation [s]:
it has one clock, but may report means."""
OTHER = {"position": "velocity", "velocity": "position"}
"""Channels of one receiver."""


def believed(channel: str, found: Mapping[str, Offset], given: Mapping[str, float]) -> Offset:
    """An offset as it was found; if that is vague, weighed against the receiver's other channel, or zero.

    Parameters
    ----------
    channel : str
        One that is in `found`.
    found : mapping of str to Offset
    given : mapping of str to float
        Offsets that a user gave [s].

    Returns
    -------
    Offset
    """
    own, other = found[channel], OTHER.get(channel, "")
    if own.sd < VAGUE:
        return own
    if other in given:
        clock = given[other]
    elif other in found and found[other].sd < VAGUE:
        clock = found[other].value
    else:
        return own._replace(value=0.0)
    share = ONE_CLOCK**2 / (ONE_CLOCK**2 + own.sd**2)
    value = clock + share * (own.value - clock) if share else clock
    return own._replace(value=value, sd=ONE_CLOCK * math.sqrt(1.0 - share))


def clock_decision(
    channel: str, found: Mapping[str, Offset], given: Mapping[str, float], span: float
) -> Decision:
    """What was decided of a channel's clock, and why.

    Parameters
    ----------
    channel : str
    found : mapping of str to Offset
    given : mapping of str to float
        [s]
    span : float
        Seconds that were looked at.

    Returns
    -------
    Decision
    """
    name = f"clock offset, {channel}"
    if channel in given:
        return Decision(name, given[channel], "s", "user", "given in the configuration")
    taken = believed(channel, found, given) if channel in found else None
    if taken is None or not np.isfinite(taken.sd):
        return Decision(name, 0.0, "s", "default", "the motion says too little; stamps taken as logged")
    own = found[channel]
    evidence = (
        f"{own.epochs} readings against the inertial motion of {span:.0f} s; "
        f"misfit {100.0 * (1.0 - 1.0 / own.gain):.1f} % less than without"
    )
    if own.sd >= VAGUE:
        what = "not acted on" if taken.sd == own.sd else "weighed against the receiver's other stamps"
        evidence = f"found {own.value:+.3f} ± {own.sd:.2f} s, too vague by itself: {what}; {evidence}"
    return Decision(name, round(taken.value, 4), "s", "data", evidence, taken.sd)
