"""What a reading says of the belief, beside what its sensor alone would make of it."""

from __future__ import annotations

import math

import numpy as np

from gapless.fold.settings import Settings
from gapless.fold.state import State
from gapless.measurements.base import Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.witnesses.hearing import Hearing

STILL = 1.0
"""For so long after the last word of rest a car stands [s]."""


def observed(state: State, settings: Settings, reading: Reading) -> Observation:
    """The observation of a reading.

    Fixes of a standing car have their error in common, and count less. Of wheels without a sign both ways of
    rolling are heard.

    Parameters
    ----------
    state : State
    settings : Settings
    reading : Reading

    Returns
    -------
    Observation
    """
    sensor, belief, hearing = settings.sensors[reading.channel], state.belief, state.hearing
    observation = sensor.observe(belief, reading)
    if reading.channel == "velocity":
        return observation._replace(R=observation.R + _probation(hearing, reading, observation))
    if reading.channel == "position":
        rests = state.clock - state.heard.get("zero_velocity", -math.inf) < STILL
        r = observation.R * hearing.rest.shared(reading.time, rests, hearing.channels.silenced("position"))
        return observation._replace(R=r + _probation(hearing, reading, observation))
    if reading.channel != "odometer":
        return observation
    back, h = sensor.observe(belief, reading._replace(value=-reading.value)), observation.H
    hph = float((h @ belief.P @ h.T)[0, 0])
    return hearing.sign.settles(float(reading.value[0]), observation, back, hph)


def _probation(hearing: Hearing, reading: Reading, o: Observation) -> Array | float:
    variance = hearing.channels.probation(reading, o.z)
    return variance * np.eye(len(o.R)) if variance else 0.0
