"""Drives of cars whose wheels can be heard, and how far a system strays in their outages."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from gapless.bridges.comb import Memory
from gapless.bridges.combs import Combs
from gapless.bridges.orders import LOWEST, ORDERS, STEP
from gapless.bridges.wheels import Wheels
from gapless.evaluation import score
from gapless.fold.feed import events
from gapless.fold.settings import Settings
from gapless.runs.conduct import as_built, navigator_for
from gapless.runs.decide import Decided
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate import CAR, Chassis, simulate
from gapless.systems.adjust import named
from gapless.systems.recipe import System
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution

FLOOR = 2.0
"""Largest errors below this are alike, as for the judge [m]."""
OUTAGES = tuple(Outage(t, t + 60.0) for t in (330.0, 440.0, 550.0, 660.0, 770.0))
"""A minute each, with fifty seconds between them; rehearsals have five minutes before the first."""


@cache
def car(seed: int = 3, chassis: Chassis = CAR, rate: float = 100.0) -> Recording:
    """An urban drive."""
    return simulate("urban", "consumer", 840.0, seed, rate=rate, chassis=chassis)


def deaf(chassis: Chassis = CAR) -> Chassis:
    """The same car with wheels that nobody can hear."""
    return replace(chassis, signal=0.0)


def driven(log: Recording, system: str | System, finish=as_built) -> Solution:
    """Through the outages."""
    return fuse(log, named(system) if isinstance(system, str) else system, outages=OUTAGES, finish=finish)


def worst(solution: Solution, log: Recording) -> np.ndarray:
    """Largest horizontal errors in the outages, floored [m]."""
    found = [o.horizontal_max for o in score(solution, log).outages]
    assert len(found) == len(OUTAGES)
    return np.maximum(found, FLOOR)


def ratio(a: np.ndarray, b: np.ndarray) -> float:
    """Geometric mean over the outages."""
    return float(np.exp(np.mean(np.log(a / b))))


def said(solution: Solution, name: str) -> tuple[object, str]:
    """Value and evidence of a decision."""
    (found,) = [d for d in solution.decisions if d.name == name]
    return found.value, found.evidence


class Frozen(Wheels):
    """Knows what it was given and learns nothing."""

    def _learn(self, belief, heard, time):
        pass


def injected(memory: Memory, stretch: float = 1.0):
    """A bridge that goes by another template, its orders multiplied: for `fuse`'s `finish`."""

    def finish(setup: Settings) -> Settings:
        bridge = Frozen(setup.sensors)
        bridge.memory = memory
        bridge.combs = stretched(Combs.of(memory), stretch)
        return replace(setup, bridges=(bridge,))

    return finish


def stretched(combs, factor):
    """Templates with their orders multiplied."""
    order = LOWEST + STEP * np.arange(ORDERS)

    def wider(heights):
        flat = [np.interp(order / factor, order, h, left=0.0, right=0.0) for h in heights.reshape(-1, ORDERS)]
        return np.reshape(flat, heights.shape)

    common = replace(combs.common, height=wider(combs.common.height))
    return Combs(common, wider(combs.others))


@cache
def learned(chassis: Chassis = CAR, seed: int = 5) -> Memory:
    """What wheels learn of a car on a drive without outages."""
    log = simulate("urban", "consumer", 400.0, seed, rate=100.0, chassis=chassis)
    still = Decided({}, (np.zeros(2), np.full(2, 0.02)), 0.0, (), 100.0)
    navigator = navigator_for(log, named("wheels"), still, 10.0)
    for event in events(log, {}):
        navigator.step(event)
    return navigator.bridges[0].memory
