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
from typing import Final, Protocol, TypeVar

import numpy as np
from msgspec import structs

from gapless.alignment.uneven import Jitter
from gapless.runs.arm import Arm, Found, found_there, guessed, hidden, taken
from gapless.runs.past import again
from gapless.systems.arm import lever_arm, told_arm, with_arm
from gapless.systems.build import settings, stamps
from gapless.systems.learning import BridgeUse
from gapless.systems.recipe import Adaptation, RehearsalUse, System
from gapless.trip.recording import Array, Recording

PRECISE = 0.3
"""Fixes show an arm where most state less than this [m]: a fraction of what an unknown antenna is off."""
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
        return known, Arm(lever_arm(system, past), None, taken(system, past, None))
    if not _shows(past, known.jitter.lasting):
        return known, Arm(told, None, taken(system, past, None)) if told is not None else hidden(system)
    armed, then, found = _in_turn(past, system, first, known)
    found = _doubted(past, armed, then, found)
    if found is not None and found.denies(told):
        sd = np.minimum(np.maximum(2.0 * found.sd, LEAST), system.gnss.lever_arm_sd)
        return then, Arm(found.value, sd, found_there(system, past, found))
    if told is None:
        return known, guessed(system, known.span, found)
    return known, Arm(told, None, taken(system, past, found))


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
