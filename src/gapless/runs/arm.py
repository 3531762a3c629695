"""What is said of a lever arm: told, found, denied, or in doubt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gapless.filters.quantile import chi_square_quantile
from gapless.systems.arm import lever_arm, told_arm, with_arm
from gapless.systems.recipe import System
from gapless.trip.recording import Array, Recording
from gapless.trip.solution import Decision

NAME = "antenna lever arm"
"""Of the decision."""
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


def taken(system: System, past: Recording, found: Found | None) -> Decision:
    """That it is taken as it was told, or as zero.

    Parameters
    ----------
    system : System
    past : Recording
    found : Found or None
        What the drive says of it.

    Returns
    -------
    Decision
    """
    source, evidence = _word(system, past)
    if source == "default":
        evidence += "; taken as zero"
    elif found is not None and found.seen:
        evidence += f"; fixes in turns put it at {_metres(found.value)} ± {_metres(found.sd)} m"
    return Decision(NAME, _tuple(lever_arm(system, past)), "m", source, evidence)


def found_there(system: System, past: Recording, found: Found) -> Decision:
    """That the drive puts it elsewhere.

    Parameters
    ----------
    system : System
    past : Recording
    found : Found

    Returns
    -------
    Decision
    """
    told, (_, who) = told_arm(system, past), _word(system, past)
    there = f"± {_metres(found.sd)} m, in {found.span:.0f} s; a state of the filter from there on"
    evidence = f"{who}; fixes in turns put it there, {there}"
    if told is not None:
        evidence = (
            f"not {_metres(told)} m as {who}, for fixes in turns put it there, {there}; mend what was told"
        )
    return Decision(NAME, _tuple(found.value), "m", "data", evidence, float(found.sd.max()))


def hidden(system: System) -> Arm:
    """Zero, which nobody told and fixes are too coarse to deny; its doubt is stated.

    Parameters
    ----------
    system : System

    Returns
    -------
    Arm
    """
    prior, zero = np.array(system.gnss.lever_arm_sd), np.zeros(3)
    evidence = (
        f"none is stated, and fixes are too coarse to show one: zero ± {_metres(prior)} m; its doubt is "
        "a part of what is stated; state antenna_lever_arm"
    )
    decision = Decision(NAME, _tuple(zero), "m", "default", evidence, float(prior.max()))
    return Arm(zero, None, decision, np.diag(prior**2))


def guessed(system: System, span: float, found: Found | None) -> Arm:
    """Zero, which nobody told and nothing denies, and how far it may be off.

    Parameters
    ----------
    system : System
    span : float
        Seconds of driving that were looked at.
    found : Found or None

    Returns
    -------
    Arm
    """
    prior, zero = np.array(system.gnss.lever_arm_sd), np.zeros(3)
    doubt, what = np.diag(prior**2), f"and the motion shows none: zero ± {_metres(prior)} m"
    seen = found is not None and found.seen
    if found is not None and found.seen:
        # axis by axis, and twice what it states: on a motorway a pass was off by 2.5 of its deviations
        doubt = np.diag(np.minimum((2.0 * found.sd) ** 2 + found.value**2, prior**2))
        what = f"and fixes in turns put it at {_metres(found.value)} ± {_metres(found.sd)} m, so zero may be"
    free = not seen and span < SHORT
    rest = "a state of the filter" if free else "a part of what is stated"
    evidence = f"none is stated, {what}; its doubt is {rest}; state antenna_lever_arm"
    most = float(np.sqrt(doubt.diagonal()).max())
    decision = Decision(NAME, _tuple(zero), "m", "default", evidence, most)
    return Arm(zero, prior, decision) if free else Arm(zero, None, decision, doubt)
