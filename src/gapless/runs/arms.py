"""Where the antenna is: what was told is held against the drive, what nobody told is looked for.

A fix that is good to centimetres says where the antenna is, and the box is metres away from there. In turns
the two go different ways: the inertial sensors feel the box's, the fixes show the antenna's. So with a
receiver that states less than the distance an antenna usually has, the arm is looked for in a pass of its
own once there are clocks, and the clocks once more with the arm: in a turn an antenna ahead and a stamp that
is late look alike. With any other receiver the arm hides behind the errors of its fixes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final, NamedTuple, Protocol, TypeVar

import numpy as np
from msgspec import structs

from gapless.alignment.uneven import Jitter
from gapless.filters.quantile import chi_square_quantile
from gapless.runs.past import again
from gapless.systems.arm import lever_arm, told_arm, with_arm
from gapless.systems.build import settings, stamps
from gapless.systems.learning import BridgeUse
from gapless.systems.recipe import Adaptation, RehearsalUse, System
from gapless.trip.recording import Array, Recording
from gapless.trip.solution import Decision

NAME = "antenna lever arm"
"""Of the decision."""
PRECISE = 0.3
"""Fixes show an arm where most state less than this [m]: a fraction of what an unknown antenna is off."""
SEEN = 0.5
"""An arm is found where its horizontal standard deviations come below this [m]."""
TAPE = 0.15
"""Standard deviation of an arm that somebody measured, held against a real drive [m]: after four minutes of
one the fixes put an antenna that is 5 cm from its box half a metre away, and stated half of that."""
CHANCE = 1e-4
"""An arm that was told is not believed where one so far off comes by chance more seldom."""
GUESS = 0.01
"""The same of zero, which is a guess where nobody told anything."""
SHORT = 240.0
"""Where less than this was driven before it is decided [s], turns may still show an arm that was not seen."""
LEAST = 0.1
"""Standard deviation that a found arm starts with at least [m]; else twice its own, for the filter will
hear the same fixes again."""
LATE = 0.02
"""By how much a clock is moved to see what becomes of the arm [s]."""
ROUNDS, SETTLED = 5, 0.05
"""So often clocks and arm are looked for in turn, or until the arm moves by less [m]: each round leaves about
a quarter of the error."""


SPEED: Final = 10.0
"""At which stamps that are uneven are held against an arm [m/s]: that of turns in a city."""


class Known(Protocol):
    """What a first pass found before."""

    @property
    def offsets(self) -> Mapping[str, float]:
        """Clock offset by channel [s]."""

    @property
    def mounting(self) -> tuple[Array, Array]:
        """Pitch and yaw of the car's forward axis in the box, and their standard deviations [rad]."""

    @property
    def density(self) -> float:
        """Of the log's vibration [rad/sqrt(s)]."""

    @property
    def span(self) -> float:
        """Seconds that could be navigated."""

    @property
    def clock_sd(self) -> float:
        """Standard deviation of the positions' clock offset [s]."""

    @property
    def jitter(self) -> Jitter:
        """By how much stamps are uneven."""


K = TypeVar("K", bound=Known)


class Found(NamedTuple):
    """Where the fixes of a pass put the antenna.

    Parameters
    ----------
    value : ndarray, shape (3,)
        From the IMU, FRD [m].
    covariance : ndarray, shape (3, 3)
        [m^2]
    span : float
        Seconds that were looked at.
    """

    value: Array
    covariance: Array
    span: float

    @property
    def sd(self) -> Array:
        """Standard deviations, shape (3,) [m]."""
        return np.asarray(np.sqrt(self.covariance.diagonal()))

    @property
    def seen(self) -> bool:
        """Whether the drive showed it."""
        return bool((self.sd[:2] < SEEN).all())

    def denies(self, told: Array | None) -> bool:
        """Whether it can hardly be what was told, or zero where nobody told anything.

        Parameters
        ----------
        told : ndarray, shape (3,), or None
            FRD [m].

        Returns
        -------
        bool
        """
        off, tape, chance = (self.value, 0.0, GUESS) if told is None else (self.value - told, TAPE, CHANCE)
        distance = off @ np.linalg.solve(self.covariance + tape**2 * np.eye(3), off)
        return self.seen and bool(distance > chi_square_quantile(1.0 - chance, 3))


class Arm(NamedTuple):
    """What was decided of a lever arm.

    Parameters
    ----------
    value : ndarray, shape (3,)
        FRD [m].
    sd : ndarray, shape (3,), or None
        What a state of the filter starts with [m]; None where the arm is taken as it is.
    decision : Decision
    doubt : ndarray, shape (3, 3)
        Of an arm that nobody told and no state looks for [m^2].
    """

    value: Array
    sd: Array | None
    decision: Decision
    doubt: Array = np.zeros((3, 3))

    def used(self, system: System) -> System:
        """The system that navigates with it.

        Parameters
        ----------
        system : System

        Returns
        -------
        System
        """
        if "lever_arm" in system.filter.states:
            return system
        return with_arm(system, self.value, self.sd)


def settle(past: Recording, system: System, first: Callable[[System], K]) -> tuple[K, Arm]:
    """Clocks and mounting by a first pass, and the lever arm beside them.

    Parameters
    ----------
    past : Recording
    system : System
    first : callable
        Makes the first pass of a system.

    Returns
    -------
    known : Known
        By the arm that is used.
    arm : Arm
    """
    told, known = told_arm(system, past), first(system)
    if known.span == 0.0 or "lever_arm" in system.filter.states or "position" not in system.sensors:
        return known, Arm(lever_arm(system, past), None, _taken(system, past, None))
    if not _shows(past, known.jitter.lasting):
        return known, Arm(told, None, _taken(system, past, None)) if told is not None else _hidden(system)
    armed, then, found = _in_turn(past, system, first, known)
    found = _doubted(past, armed, then, found)
    if found is not None and found.denies(told):
        sd = np.minimum(np.maximum(2.0 * found.sd, LEAST), system.gnss.lever_arm_sd)
        return then, Arm(found.value, sd, _found(system, past, found))
    if told is None:
        return known, _guessed(system, known, found)
    return known, Arm(told, None, _taken(system, past, found))


def _in_turn(
    past: Recording, system: System, first: Callable[[System], K], known: K
) -> tuple[System, K, Found | None]:
    """Clocks and arm in turn, as long as positions at a clock ask for another arm than it was had with.

    A wrong arm makes a clock vague, too: what that leaves open does not count before both have settled.
    """
    told, used, armed = told_arm(system, past), lever_arm(system, past), system
    found = _pass(past, armed, known, known.offsets)
    for _ in range(ROUNDS):
        if found is None or not found.denies(told):
            break
        moved, used = float(np.linalg.norm(found.value - used)), found.value
        if moved < SETTLED:
            break
        armed = with_arm(system, used)
        known = first(armed)
        found = _pass(past, armed, known, known.offsets)
    return armed, known, found


def _shows(past: Recording, uneven: float) -> bool:
    """Whether fixes are good enough to show an arm.

    Stamps that are uneven for seconds, by `uneven`, move fixes like an arm does.
    """
    gnss = past.gnss
    fixed = np.isfinite(gnss.lla).all(axis=1)
    if not fixed.any():
        return False
    stated = float(np.median(gnss.sd_position[fixed, :2].max(axis=1)))
    return math.hypot(stated, uneven * SPEED) < PRECISE


def _doubted(past: Recording, system: System, known: Known, found: Found | None) -> Found | None:
    """What fixes say of the arm, and how far they would say it at another clock that may be."""
    if found is None or not found.seen or not known.clock_sd:
        return found
    late = {**known.offsets, "position": known.offsets["position"] + LATE}
    other = _pass(past, system, known, late)
    if other is None:
        return found
    moved = (other.value - found.value) * min(known.clock_sd, 1.0) / LATE
    return found._replace(covariance=found.covariance + np.outer(moved, moved))


def _pass(past: Recording, system: System, known: Known, offsets: Mapping[str, float]) -> Found | None:
    """Navigate the past with the arm as a state, and fixes as good as they say."""
    free = _plain(with_arm(system, lever_arm(system, past), np.array(system.gnss.lever_arm_sd)))
    built = settings(free, past, offsets, known.mounting, known.density, free.filter.tick)
    navigator = again(past, built, stamps(free, offsets))
    times, belief = navigator.journal.times, navigator.belief
    if not times or not np.isfinite(belief.x).all():
        return None
    block = belief.layout.blocks["lever_arm"]
    return Found(belief.block("lever_arm").copy(), belief.P[block, block].copy(), times[-1] - times[0])


def _plain(system: System) -> System:
    """The system without what learns, adapts or hears wheels, at a first pass's pace."""
    pace = structs.replace(system.filter, tick=0.2, moments="taylor", correction="feedback")
    heard = tuple(s for s in system.sensors if s != "odometer")
    return structs.replace(
        system,
        filter=pace,
        sensors=heard,
        adaptation=Adaptation(),
        bridge=BridgeUse(),
        rehearsal=RehearsalUse(),
    )


def at_end(decision: Decision, states: Mapping[str, Array], sds: Mapping[str, Array]) -> Decision:
    """The decision with the arm as the filter had it at last, where it was a state.

    Parameters
    ----------
    decision : Decision
    states, sds : mapping of str to ndarray
        Blocks at the rows of a solution, and their standard deviations.

    Returns
    -------
    Decision
    """
    if decision.name != NAME or not len(states.get("lever_arm", ())):
        return decision
    return replace(decision, value=_tuple(states["lever_arm"][-1]), sd=float(sds["lever_arm"][-1].max()))


def _metres(values: Array) -> str:
    return ", ".join(f"{float(x):.2f}" for x in values)


def _word(system: System, past: Recording) -> tuple[str, str]:
    """Who told an arm, as a source and in words."""
    if system.gnss.lever_arm is not None:
        return "user", "given in the configuration"
    if past.lever_arm is not None:
        return "recording", "stated by the recording"
    return "default", "none is stated"


def _tuple(values: Array) -> tuple[float, ...]:
    return tuple(round(float(x), 3) for x in values)


def _taken(system: System, past: Recording, found: Found | None) -> Decision:
    source, evidence = _word(system, past)
    if source == "default":
        evidence += "; taken as zero"
    elif found is not None and found.seen:
        evidence += f"; fixes in turns put it at {_metres(found.value)} ± {_metres(found.sd)} m"
    return Decision(NAME, _tuple(lever_arm(system, past)), "m", source, evidence)


def _found(system: System, past: Recording, found: Found) -> Decision:
    told, (_, who) = told_arm(system, past), _word(system, past)
    there = f"± {_metres(found.sd)} m, in {found.span:.0f} s; a state of the filter from there on"
    evidence = f"{who}; fixes in turns put it there, {there}"
    if told is not None:
        evidence = (
            f"not {_metres(told)} m as {who}, for fixes in turns put it there, {there}; mend what was told"
        )
    return Decision(NAME, _tuple(found.value), "m", "data", evidence, float(found.sd.max()))


def _hidden(system: System) -> Arm:
    """Zero, which nobody told and fixes are too coarse to deny; its doubt is stated."""
    prior, zero = np.array(system.gnss.lever_arm_sd), np.zeros(3)
    evidence = (
        f"none is stated, and fixes are too coarse to show one: zero ± {_metres(prior)} m; its doubt is "
        "a part of what is stated; state antenna_lever_arm"
    )
    decision = Decision(NAME, _tuple(zero), "m", "default", evidence, float(prior.max()))
    return Arm(zero, None, decision, np.diag(prior**2))


def _guessed(system: System, known: Known, found: Found | None) -> Arm:
    """Zero, which nobody told and nothing denies, and how far it may be off."""
    prior, zero = np.array(system.gnss.lever_arm_sd), np.zeros(3)
    doubt, what = np.diag(prior**2), f"and the motion shows none: zero ± {_metres(prior)} m"
    seen = found is not None and found.seen
    if found is not None and found.seen:
        # axis by axis, and twice what it states: on a motorway a pass was off by 2.5 of its deviations
        doubt = np.diag(np.minimum((2.0 * found.sd) ** 2 + found.value**2, prior**2))
        what = f"and fixes in turns put it at {_metres(found.value)} ± {_metres(found.sd)} m, so zero may be"
    free = not seen and known.span < SHORT
    rest = "a state of the filter" if free else "a part of what is stated"
    evidence = f"none is stated, {what}; its doubt is {rest}; state antenna_lever_arm"
    most = float(np.sqrt(doubt.diagonal()).max())
    decision = Decision(NAME, _tuple(zero), "m", "default", evidence, most)
    return Arm(zero, prior, decision) if free else Arm(zero, None, decision, doubt)
