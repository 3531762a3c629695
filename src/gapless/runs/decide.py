"""What fusion must know before it starts, found in a first pass over the past, with its evidence."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from gapless.filters.stamp_doubt import SURE, Doubt
from gapless.fold.feed import DRIFT
from gapless.runs.arm import Arm
from gapless.runs.arms import settle
from gapless.runs.clocks import clock_notes, doubt, refuse_strangers
from gapless.runs.first_pass import FirstPass, Mounting, given
from gapless.runs.prepare import graded
from gapless.scenarios import Outage
from gapless.systems.build import budget
from gapless.systems.recipe import System
from gapless.trip.recording import Recording
from gapless.trip.solution import Decision
from gapless.units import DEG

DECISIONS_TAKEN_LATE = "decisions taken late"
"""Names the decision that tells that an outage had begun before anything could be decided."""


@dataclass(frozen=True)
class Decided:
    """Decisions, as numbers for the navigator and as lines for the user.

    Parameters
    ----------
    offsets : dict of str to float
        Clock offset by channel [s].
    mounting : Mounting
    gyro_density : float
        Of the log's vibration [rad/sqrt(s)].
    decisions : tuple of Decision
    span : float
        Seconds that the first pass could navigate; 0 where the past held too little.
    doubt : Doubt
        Of the receiver's stamps.
    notes : tuple of str
        Sentences that a user must read.
    jitter : float
        Of the receiver's stamps from reading to reading, where it is clear [s]; else 0.
    wander : float, optional
        Share of positions' stated deviations that wanders, where velocities tell it.
    arm : Arm, optional
        Where the antenna is; the recipe's word, else the recording's, if not given.
    """

    offsets: dict[str, float]
    mounting: Mounting
    gyro_density: float
    decisions: tuple[Decision, ...]
    span: float
    doubt: Doubt = SURE
    notes: tuple[str, ...] = ()
    jitter: float = 0.0
    wander: float | None = None
    arm: Arm | None = None

    def used(self, system: System) -> System:
        """The system with what was decided of its lever arm.

        Parameters
        ----------
        system : System

        Returns
        -------
        System
        """
        return system if self.arm is None else self.arm.used(system)


def decide(recording: Recording, system: System, horizon: float = np.inf) -> Decided:
    """Settle clocks and mounting from what was logged before a horizon.

    Parameters
    ----------
    recording : Recording
        GNSS epochs that are to be withheld already taken out.
    system : System
    horizon : float
        Nothing logged later is looked at [s on the IMU clock].

    Returns
    -------
    Decided
    """
    past = recording if horizon == np.inf else recording.slice(-np.inf, horizon)
    passes, arm = settle(past, system, partial(_first_pass, past))
    decisions = (
        arm.decision,
        noise_decision(system, passes.density, stated=recording.grade),
        *passes.clock_decisions(),
        *passes.wander_decisions(),
        *passes.mounting_decisions(),
    )
    clocks = passes.clocks
    return Decided(
        passes.offsets,
        passes.mounting,
        passes.density,
        decisions,
        passes.span,
        Doubt(*doubt(clocks), passes.jitter.lasting),
        clock_notes(clocks, passes.jitter, passes.offsets.get(DRIFT, 0.0)) if passes.span else (),
        passes.jitter.white,
        passes.share,
        arm,
    )


def decide_before(open_sky: Recording, system: System, outages: tuple[Outage, ...]) -> Decided:
    """Decide from what was logged before the first outage that interrupts navigation.

    An outage before there was half a minute of it (a car still parked) leaves nothing to decide from
    and nothing to bridge: the next one counts.

    Parameters
    ----------
    open_sky : Recording
        As `withhold_from` leaves it.
    system : System
    outages : tuple of Outage

    Returns
    -------
    Decided
    """
    system = graded(system, open_sky)
    refuse_strangers(open_sky, given(system))
    horizons = [open_sky.start + start for start in sorted(o.start for o in outages)] or [np.inf]
    for horizon in horizons:
        decided = decide(open_sky, system, horizon)
        if decided.span > 0.0:
            break
    if horizon > horizons[0]:
        late = Decision(
            DECISIONS_TAKEN_LATE,
            round(horizon - open_sky.start, 3),
            "s after the first sample",
            "data",
            "before the outages that began earlier there was too little motion to decide from",
        )
        decided = replace(decided, decisions=(*decided.decisions, late))
    return decided


def _first_pass(past: Recording, system: System) -> FirstPass:
    passes = FirstPass(past, system)
    passes.run()
    return passes


def noise_decision(system: System, density: float, stated: str | None = None) -> Decision:
    """Process noise of the gyros, the part of it that vibration decides.

    Parameters
    ----------
    system : System
    density : float
        What the log's gyros show of vibration [rad/sqrt(s)].
    stated : str, optional
        Grade that the recording states.

    Returns
    -------
    Decision
    """
    name, imu = "process noise, gyro", system.imu
    value = round(float(np.sqrt(budget(imu, density)["noise"][0])) / DEG, 4)
    unit = "deg/sqrt(s)"
    if imu.grade:
        source = "recording" if imu.grade == stated else "user"
        return Decision(name, value, unit, source, f"grade {imu.grade}")
    floor = f"{imu.gyro_noise:g} for consumer MEMS (biases up to 0.5 m/s^2 and 0.3 deg/s)"
    if density == 0.0 or imu.vibration == 0.0:
        return Decision(name, value, unit, "default", floor)
    share = f"{100.0 * imu.vibration:g} % of the {density / DEG:.3f} that the log shows from sample to sample"
    return Decision(name, value, unit, "data", f"{floor}, and {share}")
