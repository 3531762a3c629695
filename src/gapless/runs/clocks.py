"""What is believed of clock offsets that were found, and how it is told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from gapless.alignment.clock import Offset
from gapless.alignment.shift import Shift
from gapless.alignment.turns import far_off, hint, puzzling, strangers, turns
from gapless.alignment.uneven import Jitter
from gapless.errors import RecordingError
from gapless.trip.recording import Recording
from gapless.trip.solution import Decision

VAGUE = 0.1
"""An offset whose standard deviation is larger is a guess, and a note says so [s]."""
PRIOR = 0.3
"""Delays of receivers, and what parts the stamps of positions and velocities, as standard deviations [s]."""
ONE_CLOCK = 0.003
"""By how much stamps of one clock are apart, as a standard deviation [s]: the search is no better."""
OFTEN = 0.7
"""How often a receiver stamps its positions and velocities by one clock, before its log is looked at."""
SYNCHRONOUS = 0.4
"""How often a receiver's stamps are on the IMU's clock as they were logged."""
NOTED = 0.02
"""Stamps less uneven than this are as expected [s]."""
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
        raise _far(past, base)
    return base


def refuse_strangers(recording: Recording, given: Mapping[str, float]) -> None:
    """Refuse logs whose clocks have nothing to do with each other: turns that both tell of are not the same.

    Parameters
    ----------
    recording : Recording
        The whole of it: nothing else is decided by it.
    given : mapping of str to float
        Where a user gave an offset, nothing is refused.

    Raises
    ------
    RecordingError
    """
    if OTHER.keys() & given.keys():
        return
    told = turns(recording.imu, recording.gnss)
    if not puzzling(told) or far_off(told):
        return
    if away := hint(recording.imu, recording.gnss):
        raise _far(recording, away)
    if strangers(told):
        raise RecordingError(
            f"{recording.name}: the turns of the GNSS course and those of the gyros are not the same at any "
            "offset within ten minutes; put both on one clock, and check that they are of one drive"
        )


def _far(recording: Recording, base: float) -> RecordingError:
    way, cure = ("later", "subtract") if base < 0.0 else ("earlier", "add")
    leap = " (GPS time is 18 s ahead of UTC)" if abs(abs(base) - 18.0) < 1.0 else ""
    return RecordingError(
        f"{recording.name}: GNSS stamps are {abs(base):.1f} s {way} than the IMU's, by the turns that both "
        f"tell of; put both on one clock: {cure} that much{leap}"
    )


def believed(channel: str, clocks: Clocks) -> Offset:
    """An offset as it was found, drawn to what is likely by as much as the data leave open.

    Velocities tell their clock from accelerations, near the base; positions tell by how much theirs is
    another, and mostly it is not. An odometer has a clock of its own.

    Parameters
    ----------
    channel : str
        One that was looked for.
    clocks : Clocks

    Returns
    -------
    Offset
    """
    own = clocks.found[channel]
    near = clocks.base if channel in OTHER else 0.0
    if channel == "position" and "velocity" in clocks.given:
        gap, sd = together(own.value - clocks.given["velocity"], own.sd)
        return own._replace(value=clocks.given["velocity"] + gap, sd=sd)
    if channel == "position" and "velocity" in clocks.found:
        first = believed("velocity", clocks)
        raw = clocks.found["velocity"]
        gap, sd = together(own.value - raw.value, own.sd)
        return own._replace(value=first.value + gap, sd=math.hypot(first.sd, sd))
    if not math.isfinite(own.sd):
        return own._replace(value=near, sd=PRIOR if channel in OTHER else own.sd)
    value, sd = together(own.value - near, own.sd, SYNCHRONOUS if channel in OTHER and not near else 0.0)
    return own._replace(value=near + value, sd=sd)


def together(gap: float, sd: float, often: float = OFTEN) -> tuple[float, float]:
    """What parts two stamps: nothing, if they are of one clock, or what was found.

    Parameters
    ----------
    gap, sd : float
        Found, and its standard deviation [s]; inf where nothing was.
    often : float
        Probability that they are of one clock, before it was looked.

    Returns
    -------
    gap, sd : float
        Mean and deviation of the mixture of both, each as likely as it explains what was found.
    """
    if not math.isfinite(sd):
        return 0.0, math.sqrt(1.0 - often) * PRIOR
    means, variances, logs = [], [], []
    for share, prior in ((often, ONE_CLOCK), (1.0 - often, PRIOR)):
        total = prior**2 + sd**2
        means.append(gap * prior**2 / total)
        variances.append(prior**2 * sd**2 / total)
        logs.append(math.log(max(share, 1e-300)) - 0.5 * (math.log(total) + gap**2 / total))
    weights = [math.exp(one - max(logs)) for one in logs]
    weights = [w / sum(weights) for w in weights]
    mean = sum(w * m for w, m in zip(weights, means, strict=True))
    spread = sum(w * (v + (m - mean) ** 2) for w, m, v in zip(weights, means, variances, strict=True))
    return mean, math.sqrt(spread)


def doubt(clocks: Clocks) -> tuple[float, float]:
    """How far the receiver's stamps are not known.

    Parameters
    ----------
    clocks : Clocks

    Returns
    -------
    common, apart : float
        Standard deviations of what positions and velocities share, and of what parts them [s].
    """
    known = {c: believed(c, clocks) for c in OTHER if c in clocks.found}
    common = known["velocity"].sd if "velocity" in known else 0.0
    whole = known["position"].sd if "position" in known else 0.0
    if "velocity" not in known and "velocity" not in clocks.given:
        return whole, 0.0
    return common, math.sqrt(max(whole**2 - common**2, 0.0)) if "position" in known else common


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
    own = clocks.found.get(channel)
    turned = f"{base:+.2f} s by the turns that both tell of; " if base else ""
    if own is None:
        source, what = ("data", "no finer") if base else ("default", "stamps taken as logged")
        return Decision(name, base, "s", source, f"{turned}the motion says too little; {what}")
    taken = believed(channel, clocks)
    value, sd = round(taken.value, 4), taken.sd if np.isfinite(taken.sd) else None
    if not np.isfinite(own.sd):
        if channel == "position" and OTHER[channel] in clocks.found and taken.value != base:
            return Decision(name, value, "s", "data", f"{turned}that of the receiver's velocities", sd)
        source, what = ("data", "no finer") if base else ("default", "stamps taken as logged")
        return Decision(name, value, "s", source, f"{turned}the motion says too little; {what}", sd)
    evidence = (
        f"{turned}{own.epochs} readings against the inertial motion of {span:.0f} s; "
        f"misfit {100.0 * (1.0 - 1.0 / own.gain):.1f} % less than without"
    )
    if abs(own.value - taken.value) > 0.5 * own.sd or own.sd >= VAGUE:
        what = "weighed against " + (
            "the receiver's other stamps" if channel == "position" else "none at all"
        )
        evidence = f"found {own.value:+.3f} ± {own.sd:.3f} s, {what}; {evidence}"
    return Decision(name, value, "s", "data", evidence, sd)


def parting(shifts: Mapping[str, Shift]) -> tuple[float, float, float]:
    """Drift of a receiver's clock: that of its velocities, for positions are held against these.

    Parameters
    ----------
    shifts : mapping of str to Shift
        By channel.

    Returns
    -------
    drift, sd : float
        Seconds in a second; zero where positions part from velocities, for that is no clock. Deviations of
        least squares are doubled: simulated drives have them at up to twice as much.
    since : float
        The time for which offsets were found [s].
    """
    one = shifts.get("velocity", shifts.get("position"))
    if one is None:
        return 0.0, math.inf, 0.0
    other = shifts["position"] if "position" in shifts and "velocity" in shifts else None
    apart = other is not None and abs(other.drift) > max(0.5 * abs(one.drift), 4.0 * other.drift_sd)
    return (0.0 if apart else one.drift), 2.0 * one.drift_sd, one.middle


def drift_decision(drift: float, sd: float, span: float) -> Decision:
    """That the receiver's clock and the IMU's part.

    Parameters
    ----------
    drift, sd : float
        Seconds in a second.
    span : float
        Seconds that were looked at.

    Returns
    -------
    Decision
    """
    evidence = f"over {span:.0f} s the offset changes by {drift * span:+.3f} s; stamps are corrected by it"
    return Decision("clock drift", round(1e6 * drift, 1), "ppm", "data", evidence, 1e6 * sd)


def jitter_decisions(jitter: Jitter) -> list[Decision]:
    """How uneven stamps are, where it is clear.

    Parameters
    ----------
    jitter : Jitter

    Returns
    -------
    list of Decision
        None or one.
    """
    if not jitter.white and not jitter.lasting:
        return []
    evidence = (
        f"{jitter.readings} positions are off by {jitter.along:.3f} s of driving along the track and by "
        f"{jitter.across:.3f} across it; {jitter.white:.3f} s from one to the next, {jitter.lasting:.3f} s "
        "over some seconds"
    )
    whole = math.hypot(jitter.white, jitter.lasting)
    return [Decision("jitter of stamps", round(whole, 3), "s", "data", evidence)]


def clock_notes(clocks: Clocks, jitter: Jitter, drift: float) -> tuple[str, ...]:
    """What a user must read of clocks.

    Parameters
    ----------
    clocks : Clocks
    jitter : Jitter
    drift : float
        Of the receiver's clock [s/s]; 0 where none was found.

    Returns
    -------
    tuple of str
    """
    notes = []
    most = math.hypot(*doubt(clocks))
    if most >= VAGUE:
        notes.append(
            f"the receiver's clock is known to {most:.2f} s only; positions are stated as uncertain as "
            "the car drives far in that time; if it is known, say --clock position=... --clock velocity=..."
        )
    if drift:
        notes.append(
            f"the receiver's clock and the IMU's part by {1e6 * drift:.0f} ppm; its stamps are corrected"
        )
    uneven = math.hypot(jitter.white, jitter.lasting)
    if uneven > NOTED:
        notes.append(
            f"the receiver's stamps are uneven by {uneven:.3f} s, and that is stated; by the receiver's own "
            "time they would not be"
        )
    return tuple(notes)
