"""The first pass: the past navigated again and again until clocks and mounting settle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from msgspec import structs

from gapless.alignment.clock import Curve, Offset, led, offset, path_curve, swinging, velocity_curve, way
from gapless.alignment.shift import Shift, shift, wandering
from gapless.alignment.uneven import Jitter, uneven
from gapless.fold.feed import DRIFT, SINCE, parted
from gapless.fold.journal import KNOCK, Journal, Knock
from gapless.fold.navigator import Navigator
from gapless.runs.clocks import (
    Clocks,
    base_offset,
    believed,
    clock_decision,
    drift_decision,
    jitter_decisions,
    parting,
)
from gapless.runs.past import ENOUGH, again
from gapless.sensors.vibration import gyro_density
from gapless.systems.arm import lever_arm
from gapless.systems.build import settings, stamps
from gapless.systems.learning import BridgeUse
from gapless.systems.recipe import Adaptation, RehearsalUse, System
from gapless.trip.recording import Array, Imu, Recording, Trajectory
from gapless.trip.solution import Decision
from gapless.units import DEG

CHANNELS = ("position", "velocity", "odometer")
JITTER = (0.3, 0.1, 0.05, 0.05, 0.05, 0.05)
"""How far stamps are trusted from pass to pass [s]: a clock still unknown must not bend the path."""


WINDOWS = (100.0, 200.0)
"""Windows in which a path is compared with positions [s]: long, for positions lag in their changes."""
LOOSE = 30.0
"""Standard deviation of positions in a first pass that has velocities [m]."""
SETTLED = 0.003
"""Passes end when no offset moves by more [s], or by more than half its standard deviation."""
PARTING = 4.0
"""Clocks part where their drift is so many deviations."""
SHARES = (0.3, 1.0)
"""Least and greatest share of a position's deviation that is taken to wander."""
TOLD = 0.8
"""How much the share that is found counts against the recipe's: ten minutes tell it to a fifth."""
HONEST = {"position": 1.3, "velocity": 1.6}
"""Deviations over those of least squares, as simulated drives have them: curves have errors of their own."""


class Mounting(NamedTuple):
    """Pitch and yaw of the car's forward axis in the box.

    Parameters
    ----------
    angles, sd : ndarray, shape (2,)
        [rad]
    """

    angles: Array
    sd: Array


class FirstPass:
    """Navigates the past until its clock offsets settle."""

    def __init__(self, past: Recording, system: System) -> None:
        self.past, self.system = past, system
        self.given = given(system)
        self.base = base_offset(past, self.given)
        self.offsets = {"position": self.base, "velocity": self.base, "odometer": 0.0} | self.given
        self.found: dict[str, Offset] = {}
        self.shifts: dict[str, Shift] = {}
        self.jitter, self.drift_sd = Jitter(), 0.0
        self.held: tuple[Curve, Array, Array] | None = None
        self.mounting = given_mounting(system)
        self.span = 0.0
        self.learned = False
        self.density = gyro_density(past.imu)
        # an odometer's clock may drift: its offset is the mean over all there is
        self.enough = ENOUGH if past.odometer is None else np.inf

    def run(self) -> None:
        """Up to six passes; each starts from the offsets of the one before. More, if the clocks part."""
        for k, jitter in enumerate((*JITTER, *JITTER[2:])):
            navigator = self._navigate(jitter)
            if len(navigator.journal.times) < 150:  # half a minute
                return
            settled = self._learn(navigator)
            if (settled or k + 1 == len(JITTER)) and not self._part():
                return

    def _part(self) -> bool:
        """Whether the clocks were just found to part."""
        if self.given or not self.shifts:
            return False
        drift, self.drift_sd, since = parting(self.shifts)
        least = PARTING if DRIFT not in self.offsets else 1.0
        if abs(drift) < least * self.drift_sd or abs(drift) * self.span < SETTLED:
            return False
        since = self.offsets.get(SINCE, since)
        self.offsets |= {DRIFT: self.offsets.get(DRIFT, 0.0) + drift, SINCE: since}
        return True

    def _navigate(self, jitter: float) -> Navigator:
        use = self.system.gnss
        # positions at a wrong time would bend the path that is to time them; velocities hold it
        floor = LOOSE if self.past.gnss.has_velocity else use.position_floor
        gnss = structs.replace(use, jitter=jitter, position_floor=max(floor, use.position_floor))
        sensors = tuple(s for s in self.system.sensors if s != "odometer")  # it would vouch for itself
        coarse = structs.replace(self.system.filter, tick=0.2, moments="taylor")
        plain = structs.replace(
            self.system, adaptation=Adaptation(), bridge=BridgeUse(), rehearsal=RehearsalUse()
        )
        system = structs.replace(plain, gnss=gnss, filter=coarse, sensors=sensors)
        built = settings(system, self.past, self.offsets, given_mounting(system), self.density, coarse.tick)
        return again(self.past, built, stamps(system, self.offsets), self.enough)

    def _learn(self, navigator: Navigator) -> bool:
        """Take the estimates of a pass; whether they settled."""
        path, (blocks, sds) = navigator.journal.trajectory(), navigator.journal.blocks()
        self.span = float(path.time[-1] - path.time[0])
        self._learn_mounting(blocks, sds, _before_knocks(navigator.journal))
        settled, before = True, dict(self.offsets)
        self.found = self._estimates(path, blocks, as_at_first(self.past.imu, navigator.journal.knocks))
        for channel, estimate in self.found.items():
            self.offsets[channel] = believed(channel, self.clocks).value
            settled &= abs(self.offsets[channel] - before[channel]) < max(SETTLED, 0.5 * estimate.sd)
        return settled

    @property
    def clocks(self) -> Clocks:
        """What is known of clocks so far."""
        return Clocks(self.given, self.base, self.found)

    def _estimates(self, path: Trajectory, blocks: dict[str, Array], imu: Imu) -> dict[str, Offset]:
        gnss, odometer, base = self.past.gnss, self.past.odometer, self.base
        arm = lever_arm(self.system, self.past)
        time, found = gnss.time + base + parted(gnss.time, self.offsets), {}
        fixed = np.isfinite(gnss.lla).all(axis=1)
        heard = np.isfinite(gnss.v_n).all(axis=1)
        if heard.any():
            felt = velocity_curve(path, blocks["accel_bias"], imu)
            curve, v = swinging(felt, path, arm, 1), gnss.v_n[heard, :2]
            late = self.offsets["velocity"] - base
            if "velocity" not in self.given:
                coarse = offset(curve, time[heard], v, 1)
                found["velocity"] = self._fine("velocity", coarse, curve, time[heard], v, 1).later(base)
                late = found["velocity"].value - base if np.isfinite(found["velocity"].sd) else late
            along = led(felt, curve, time[heard] + late, v)
        else:
            along = path_curve(path)
        if "position" not in self.given and fixed.any():
            here, curve = way(gnss.lla[fixed]), swinging(along, path, arm, 0)
            windows = tuple(sorted({min(w, self.span) for w in WINDOWS}))
            coarse = offset(curve, time[fixed], here, 1, windows=windows, correlation=5.0)
            found["position"] = self._fine("position", coarse, curve, time[fixed], here, 0).later(base)
            if np.isfinite(found["position"].sd):
                held = time[fixed] + found["position"].value - base
                self.jitter = uneven(curve, held, here)
                self.held = curve, held, here
        if odometer is not None and "odometer" not in self.given:
            speed = np.hypot(path.v_n[:, 0], path.v_n[:, 1])[:, None]
            found["odometer"] = offset(Curve(path.time, speed), odometer.time, odometer.speed[:, None], 1)
        return found

    def _fine(
        self, channel: str, coarse: Offset, curve: Curve, time: Array, value: Array, degree: int
    ) -> Offset:
        """What generalised least squares make of a scanned offset; disagreement of passes is doubt too."""
        finer = shift(curve, time, value, coarse.value, degree, channel == "velocity")
        if finer is None or not np.isfinite(coarse.sd):
            return coarse
        before, self.shifts[channel] = self.shifts.get(channel), finer
        moved = 0.0 if before is None else finer.value - before.value
        if channel == "position":
            return coarse._replace(sd=HONEST[channel] * max(coarse.sd, finer.sd))
        return coarse._replace(value=finer.value, sd=float(np.hypot(HONEST[channel] * finer.sd, moved)))

    def _learn_mounting(self, blocks: dict[str, Array], sds: dict[str, Array], row: int) -> None:
        if "mounting" not in blocks or self._mounting_given():
            return
        sd = np.maximum(2.0 * sds["mounting"][row], 0.5 * DEG)
        prior = given_mounting(self.system)
        self.mounting = Mounting(blocks["mounting"][row].copy(), np.minimum(sd, prior.sd))
        self.learned = True

    def _mounting_given(self) -> bool:
        return self.system.mounting.pitch != "auto" and self.system.mounting.yaw != "auto"

    def clock_decisions(self) -> list[Decision]:
        """One decision for each channel that the recording has."""
        present = {"position": True, "velocity": self.past.gnss.has_velocity}
        present["odometer"] = self.past.odometer is not None
        chosen = [c for c in CHANNELS if present[c]]
        told = [clock_decision(c, self.clocks, self.span) for c in chosen]
        if drift := self.offsets.get(DRIFT, 0.0):
            told.append(drift_decision(drift, self.drift_sd, self.span))
        return [*told, *jitter_decisions(self.jitter)]

    @cached_property
    def errors(self) -> tuple[float, float]:
        """What of positions' errors is white, and what wanders [m]; NaN where velocities do not tell."""
        if self.held is None or "velocity" not in self.shifts:
            return np.nan, np.nan
        return wandering(*self.held, self.shifts["velocity"].white)

    @property
    def share(self) -> float | None:
        """Share of positions' stated deviations that wanders; None where it is not known or not asked for."""
        if not np.isfinite(self.errors[1]) or not self.system.gnss.wander:
            return None
        stated = np.maximum(self.past.gnss.sd_position[:, :2], self.system.gnss.position_floor)
        found = max(self.errors[1] / float(np.nanmedian(stated)), 0.1)
        return float(np.clip(found**TOLD * self.system.gnss.wander ** (1.0 - TOLD), *SHARES))

    def wander_decisions(self) -> list[Decision]:
        """How much of positions' errors wanders, where velocities tell it."""
        if self.share is None:
            return []
        white, wander = self.errors
        evidence = (
            f"held against {self.span:.0f} s of velocities, positions wander by {wander:.2f} m and scatter "
            f"by {white:.2f} m from second to second; weighed against {self.system.gnss.wander:g}"
        )
        name = "positions' wander, share of their deviation"
        return [Decision(name, round(self.share, 2), "", "data", evidence)]

    @property
    def clock_sd(self) -> float:
        """Standard deviation of the positions' clock offset [s]; 0 where it was given."""
        return believed("position", self.clocks).sd if "position" in self.found else 0.0

    def mounting_decisions(self) -> list[Decision]:
        """Pitch and yaw of the car's forward axis in the box."""
        if not ({"nonholonomic"} & set(self.system.constraints)):
            return []
        angles = tuple(round(float(a) / DEG, 3) for a in self.mounting.angles)
        sd = float(np.max(self.mounting.sd)) / DEG
        name = "mounting pitch and yaw, first estimate"
        if self._mounting_given():
            return [Decision(name, angles, "deg", "user", "given in the configuration", sd)]
        if not self.learned:
            return [Decision(name, angles, "deg", "default", "too little motion; a state from zero", sd)]
        evidence = f"where the car does not slip over {self.span:.0f} s; states of the filter from here on"
        return [Decision(name, angles, "deg", "data", evidence, sd)]


def given_mounting(system: System) -> Mounting:
    """What a recipe says of the mounting angles: zero and its deviations, where it leaves them open.

    Parameters
    ----------
    system : System

    Returns
    -------
    Mounting
    """
    m = system.mounting
    angles = np.array([0.0 if a == "auto" else a * DEG for a in (m.pitch, m.yaw)])
    return Mounting(angles, np.array([m.pitch_sd, m.yaw_sd]) * DEG)


def _before_knocks(journal: Journal) -> int:
    """The last row at which the box sat as it did at first."""
    knocks = [k.time for k in journal.knocks if abs(k.angle) > KNOCK]
    return int(np.searchsorted(journal.times, knocks[0])) - 1 if knocks else -1


def as_at_first(imu: Imu, knocks: Sequence[Knock]) -> Imu:
    """What the IMU felt, in the axes in which its box sat at first.

    Parameters
    ----------
    imu : Imu
    knocks : sequence of Knock

    Returns
    -------
    Imu
    """
    turned = imu
    for knock, then in pairwise([*knocks, None]):
        if knock is not None and knock.box is not None:
            k = slice(*np.searchsorted(imu.time, [knock.time, then.time if then else np.inf]))
            dtheta, dvel = turned.dtheta.copy(), turned.dvel.copy()
            dtheta[k], dvel[k] = imu.dtheta[k] @ knock.box.T, imu.dvel[k] @ knock.box.T
            turned = replace(turned, dtheta=dtheta, dvel=dvel)
    return turned


def given(system: System) -> dict[str, float]:
    """Clock offsets that a recipe states, by channel.

    Parameters
    ----------
    system : System

    Returns
    -------
    dict of str to float
        [s]
    """
    return {c: v for c in CHANNELS if (v := getattr(system.clock, c)) != "auto"}
