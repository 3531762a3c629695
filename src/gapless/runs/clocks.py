"""What is believed of clock offsets that were found, and how it is told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from gapless.alignment.clock import Offset
from gapless.alignment.turns import far_off, turns
from gapless.errors import RecordingError
from gapless.trip.recording import Recording
from gapless.trip.solution import Decision

VAGUE = 0.1
"""An offset is not believed by itself where its standard deviation is larger [s]."""
ONE_CLOCK = 0.1
"""By how much the offsets of a receiver's positions and velocities differ, as a standard deviation [s]:
it has one clock, but may report means."""
MOST = 10.0
"""No receiver is later than this [s]; stamps that are, are wrong."""
OTHER = {"position": "velocity", "velocity": "position"}
"""Channels of one receiver."""


class Clocks(NamedTuple):
    """What is known of clocks.

    Parameters
    ----------
    given : mapping of str to float
        Offsets that a user gave [s].
    base : float
        Offset of the receiver by turns, to half a second, where it is more than one [s].
    found : mapping of str to Offset
    """

    given: Mapping[str, float]
    base: float
    found: Mapping[str, Offset]


def base_offset(past: Recording, given: Mapping[str, float]) -> float:
    """Offset of a receiver that is off by more than a second, from which a finer one is looked for.

    Parameters
    ----------
    past : Recording
    given : mapping of str to float
        Where a user gave one, nothing is looked for.

    Returns
    -------
    float
        [s]

    Raises
    ------
    RecordingError
        If its stamps are further off than any delay is.
    """
    if OTHER.keys() & given.keys():
        return 0.0
    base = far_off(turns(past.imu, past.gnss))
    if abs(base) > MOST:
        way, cure = ("later", "subtract") if base < 0.0 else ("earlier", "add")
        leap = " (GPS time is 18 s ahead of UTC)" if abs(abs(base) - 18.0) < 1.0 else ""
        raise RecordingError(
            f"{past.name}: GNSS stamps are {abs(base):.1f} s {way} than the IMU's, by the turns that both "
            f"tell of; put both on one clock: {cure} that much{leap}"
        )
    return base


def believed(channel: str, clocks: Clocks) -> Offset:
    """An offset as it was found; if that is vague, weighed against the receiver's other channel, or the base.

    Parameters
    ----------
    channel : str
        One that was looked for.
    clocks : Clocks

    Returns
    -------
    Offset
    """
    given, base, found = clocks
    own, other = found[channel], OTHER.get(channel, "")
    if own.sd < VAGUE:
        return own
    if other in given:
        clock = given[other]
    elif other in found and found[other].sd < VAGUE:
        clock = found[other].value
    else:
        return own._replace(value=base if channel in OTHER else 0.0)
    share = ONE_CLOCK**2 / (ONE_CLOCK**2 + own.sd**2)
    return own._replace(value=clock + share * (own.value - clock), sd=ONE_CLOCK * math.sqrt(1.0 - share))


def clock_decision(channel: str, clocks: Clocks, span: float) -> Decision:
    """What was decided of a channel's clock, and why.

    Parameters
    ----------
    channel : str
    clocks : Clocks
    span : float
        Seconds that were looked at.

    Returns
    -------
    Decision
    """
    name, base = f"clock offset, {channel}", clocks.base if channel in OTHER else 0.0
    if channel in clocks.given:
        return Decision(name, clocks.given[channel], "s", "user", "given in the configuration")
    taken = believed(channel, clocks) if channel in clocks.found else None
    turned = f"{base:+.2f} s by the turns that both tell of; " if base else ""
    if taken is None or not np.isfinite(taken.sd):
        source, what = ("data", "no finer") if base else ("default", "stamps taken as logged")
        return Decision(name, base, "s", source, f"{turned}the motion says too little; {what}")
    own = clocks.found[channel]
    evidence = (
        f"{turned}{own.epochs} readings against the inertial motion of {span:.0f} s; "
        f"misfit {100.0 * (1.0 - 1.0 / own.gain):.1f} % less than without"
    )
    if own.sd >= VAGUE:
        what = "not acted on" if taken.sd == own.sd else "weighed against the receiver's other stamps"
        evidence = f"found {own.value:+.3f} ± {own.sd:.2f} s, too vague by itself: {what}; {evidence}"
    return Decision(name, round(taken.value, 4), "s", "data", evidence, taken.sd)
