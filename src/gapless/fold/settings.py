"""What a navigator is built from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from gapless.alignment.coarse import Aligner
from gapless.bridges.base import Bridge
from gapless.filters.adaptation.base import Adaptation
from gapless.filters.adaptation.gate import Gate
from gapless.filters.adaptation.registry import KINDS
from gapless.filters.stamp_doubt import SURE, Doubt
from gapless.fold.manner import Manner
from gapless.inertial.layout import Layout
from gapless.measurements.base import Constraint, Sensor
from gapless.trip.recording import Array


@dataclass(frozen=True)
class Settings:
    """What a navigator is built from; everything in SI units.

    Parameters
    ----------
    layout : Layout
        Error states.
    noise : ndarray, shape (7,)
        Process noise, as `propagate` takes it.
    initial_sd : mapping of str to float or ndarray
        Standard deviation of each block at the start (position, velocity, heading come from the fix).
    initial : mapping of str to ndarray
        Starting values of additive blocks; zero where not named.
    sensors : mapping of str to Sensor
        By channel.
    constraints : mapping of str to Constraint
        By channel; copied, never changed.
    bridges : sequence of Bridge
        Copied, never changed.
    adaptation : mapping of str to Adaptation
        By kind of observation; copied.
    aligner : Aligner
        Copied.
    tick : float
        Time between constraint updates [s].
    period : float
        Time between covariance steps [s].
    row : float
        Time between journal rows [s].
    lateness : float
        How late a reading may arrive and still be put in its place [s].
    memory : float
        What a receiver that is found out said is taken back as far as this [s]; 0: never.
    misalignment : float
        Standard deviation of the box's axes against the sensors' [rad].
    wander_time : float
        Correlation time of what a sensor's readings share [s].
    arm_doubt : ndarray, shape (3, 3)
        How far an antenna that nobody told of may be from where it is taken to be: a covariance in FRD
        [m^2], part of every stated position.
    doubt : Doubt
        Of a receiver's stamps.
    open_loop : bool
        Feed-forward: never correct the nominal state.
    cubature : bool
        Carry the covariance by cubature points instead of Taylor's first order.
    trail : float
        Seconds of past velocity that a sensor needs.
    """

    layout: Layout
    noise: Array
    initial_sd: Mapping[str, float | Array]
    initial: Mapping[str, Array]
    sensors: Mapping[str, Sensor]
    constraints: Mapping[str, Constraint]
    bridges: Sequence[Bridge] = ()
    adaptation: Mapping[str, Adaptation] = field(default_factory=lambda: {kind: Gate() for kind in KINDS})
    aligner: Aligner = field(default_factory=Aligner)
    tick: float = 0.1
    period: float = 0.05
    row: float = 0.1
    lateness: float = 0.0
    memory: float = 12.0
    misalignment: float = 0.0
    wander_time: float = 60.0
    arm_doubt: Array = field(default_factory=lambda: np.zeros((3, 3)))
    doubt: Doubt = SURE
    open_loop: bool = False
    cubature: bool = False
    trail: float = 0.0

    @cached_property
    def manner(self) -> Manner:
        """As the settings have it: every bridge is listened to."""
        return Manner(self.noise, self.constraints, tuple(range(len(self.bridges))))

    @cached_property
    def ceiling(self) -> Array:
        """Variance beyond which no fading forgets, shape (n,): that of a state of which nothing is known."""
        found = np.full(self.layout.n, np.inf)
        for name, block in self.layout.blocks.items():
            if name == "attitude":
                found[block] = math.pi**2 / 3.0
            elif name not in ("position", "velocity"):
                found[block] = np.square(self.initial_sd.get(name, 0.0))
        return found
