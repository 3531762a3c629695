"""One sentence that judges a run by what was noticed in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np

from gapless.runs.notices import PLACE
from gapless.trip.recording import Gnss, Trajectory
from gapless.trip.solution import Decision, Notice
from gapless.units import DEG

MOST: Final = 3
"""So many clauses make a sentence."""
MATTERS: Final = 0.5
"""What a clock leaves open of the way is spoken of from here on, where it is more than fixes state [m]."""
NAMES: Final = {"odometer": "the odometer", "nonholonomic": "the wheels' constraint"}
DRIVES: Final = 1.0
"""Typical is the speed of a car that drives [m/s]."""


def judge(
    notices: Iterable[Notice],
    decisions: Iterable[Decision],
    gnss: Gnss,
    trajectory: Trajectory,
    channels: Iterable[str],
) -> str:
    """What was noticed, and what it means for what is stated.

    Parameters
    ----------
    notices : iterable of Notice
        All of them, not grouped.
    decisions : iterable of Decision
        Their clock offsets, with deviations.
    gnss : Gnss
        Fixes, with what they state.
    trajectory : Trajectory
    channels : iterable of str
        That were heard, and constraints.

    Returns
    -------
    str
        "" where there is nothing to say.
    """
    told = tuple(notices)
    clauses, vague = list(_clauses(told))[:MOST], _vague(decisions, gnss, trajectory)
    if not clauses:
        return f"Vague: {vague}." if vague else ""
    kinds = {n.kind for n in told}
    word = "Inconsistent" if kinds == {"surprised"} else "Disturbed"
    text = f"{word}: {_listed(clauses)}; {_meaning(told, tuple(channels))}."
    return f"{text} {vague[0].upper()}{vague[1:]}." if vague else text


def _clauses(notices: tuple[Notice, ...]) -> Iterator[str]:
    """What happened, what matters most first."""
    silenced: dict[str, float] = {}
    for n in notices:
        if n.kind == "silenced":
            name = NAMES.get(n.channel, n.channel)
            silenced[name] = silenced.get(name, 0.0) + n.lasting
    if len(silenced) == 1:
        yield from (
            f"{channel} was not believed for {lasting:.0f} s" for channel, lasting in silenced.items()
        )
    elif silenced:
        yield _listed([f"{c} ({s:.0f} s)" for c, s in silenced.items()]) + " were not believed"
    if turned := [n.size for n in notices if n.kind in ("turned", "leaned")]:
        yield f"the box was turned by about {max(turned) / DEG:.0f} deg"
    if any(n.kind == "anew" for n in notices):
        yield "the filter had to begin anew"
    if moved := [n.size for n in notices if n.kind == "drifted"]:
        yield f"a gyro's zero moved by {max(moved) / DEG:.1f} deg/s"
    if any(n.kind == "felt" for n in notices):
        yield "a force was felt that wheels deny"
    if headings := [n.size for n in notices if n.kind == "heading"]:
        yield f"the heading was off by {max(headings) / DEG:.0f} deg"
    yield from _believed([n for n in notices if n.kind == "believed"])
    for n in notices:
        if n.kind == "surprised":
            name = NAMES.get(n.channel, n.channel)
            yield f"{name} disagrees with the filter by more than is stated for {n.lasting:.0f} s"


def _believed(notices: list[Notice]) -> Iterator[str]:
    """Who was right where the filter was not."""
    if moved := [n.size for n in notices if n.channel == "position" and n.size >= PLACE]:
        yield f"the fixes' place moved by {max(moved):.0f} m"
    rest = [n.channel for n in notices if n.channel != "position" or not moved]
    names = [*dict.fromkeys(NAMES.get(channel, channel) for channel in rest)]
    if names:
        yield f"{_listed(names)} {'were' if len(names) > 1 else 'was'} believed against the filter"


def _meaning(notices: tuple[Notice, ...], channels: tuple[str, ...]) -> str:
    """What a reader may still rely on."""
    mute = {n.channel for n in notices if n.kind == "silenced"}
    if "position" in mute:
        rest = ["inertial sensors"]
        rest += ["the odometer"] * ("odometer" in channels and "odometer" not in mute)
        rest += ["constraints"] * ("nonholonomic" in channels)
        return f"what is stated in that time rests on {_listed(rest)}"
    if {n.kind for n in notices} == {"leaned"}:
        return "its gyros felt it, and attitudes are those of the box as it sits"
    if any(n.kind not in ("silenced", "surprised", "leaned") for n in notices):
        return "until it was noticed, more was stated than was known"
    if mute:
        return "what is stated in that time rests on the other sensors"
    return "what is stated in that time is too sure"


def _vague(decisions: Iterable[Decision], gnss: Gnss, trajectory: Trajectory) -> str:
    """That stamps leave more open than fixes state; "" where they do not."""
    doubts = [d.sd for d in decisions if d.name == "clock offset, position" and d.sd is not None]
    if not doubts or not len(gnss) or not np.isfinite(doubts[0]):
        return ""
    speed = np.hypot(trajectory.v_n[:, 0], trajectory.v_n[:, 1])
    moving = speed[speed > DRIVES]
    stated = np.hypot(gnss.sd_position[:, 0], gnss.sd_position[:, 1])
    stated = stated[np.isfinite(stated)]
    if not len(moving) or not len(stated):
        return ""
    way, states = float(np.median(moving)) * doubts[0], float(np.median(stated))
    if way < max(MATTERS, states):
        return ""
    return (
        f"the receiver's clock is known to {doubts[0]:.2f} s only, in which the car drives {way:.1f} m as a "
        f"rule, while fixes state {states:.2g} m"
    )


def _listed(parts: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(parts[:-1]), parts[-1])))
