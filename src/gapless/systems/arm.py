"""The antenna's place on the box: who told of it, and a system that takes it for this or that."""

from __future__ import annotations

import numpy as np
from msgspec import structs

from gapless.systems.recipe import System
from gapless.trip.recording import Array, Recording

AXLE = 1.0
"""How far the rear axle may be off its usual place where the arm is estimated [m]: turns show to a decimetre
how far the antenna is from the axle, so a narrow prior that is a metre off would bend the arm."""


def lever_arm(system: System, recording: Recording) -> Array:
    """Antenna from the IMU: the recipe's word, else the recording's, else zero.

    Parameters
    ----------
    system : System
    recording : Recording

    Returns
    -------
    ndarray, shape (3,)
        FRD [m].
    """
    told = told_arm(system, recording)
    return np.zeros(3) if told is None else told


def told_arm(system: System, recording: Recording) -> Array | None:
    """Antenna from the IMU as somebody told it.

    Parameters
    ----------
    system : System
    recording : Recording

    Returns
    -------
    ndarray, shape (3,), or None
        FRD [m].
    """
    given = system.gnss.lever_arm
    return recording.lever_arm if given is None else np.array(given)


def with_arm(system: System, value: Array, sd: Array | None = None) -> System:
    """A system that takes the lever arm for this one, or that estimates it from there.

    Parameters
    ----------
    system : System
    value : ndarray, shape (3,)
        FRD [m].
    sd : ndarray, shape (3,), optional
        Standard deviations to start from [m].

    Returns
    -------
    System
    """
    gnss = structs.replace(system.gnss, lever_arm=tuple(value.tolist()))
    if sd is None:
        return structs.replace(system, gnss=gnss)
    names = system.filter.states
    names = names if "lever_arm" in names else (*names, "lever_arm")
    gnss = structs.replace(gnss, lever_arm_sd=tuple(sd.tolist()))
    slip = structs.replace(system.nonholonomic, axle_sd=max(system.nonholonomic.axle_sd, AXLE))
    widened = structs.replace(system, gnss=gnss, nonholonomic=slip)
    return structs.replace(widened, filter=structs.replace(system.filter, states=names))
