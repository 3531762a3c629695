"""What a car did while its IMU was silent: what that leaves in doubt."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless import earth
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief
from gapless.inertial.layout import ROW
from gapless.inertial.trail import Trail
from gapless.trip.recording import Array
from gapless.units import DEG

TILTED: Final = 3.0 * DEG
"""Roll and pitch may have changed by this in a long silence: ramps and hills."""
UNKNOWN: Final = 100.0 * DEG
"""Standard deviation of a heading that is no longer known."""


class Turned(NamedTuple):
    """A turn that nobody saw, in a long hole of the IMU: the way since may be turned about its place.

    Neither the strapdown nor what a car cannot do tells of it, for they are the same in any direction. A
    linear filter that is asked to carry it learns of it all the same, from every change of speed, and is
    sure of a wrong heading. So it is set aside until something is heard that has a direction.

    Parameters
    ----------
    place : ndarray, shape (3,)
        Latitude, longitude [rad], height [m].
    variance : float
        Of the angle [rad^2].
    """

    place: Array
    variance: float

    def after(self, sd: float) -> Turned:
        """With one more: about the first place, for that is farther."""
        return Turned(self.place, min(self.variance + sd * sd, UNKNOWN**2))


def stray(b: Belief, doubt: Array, seconds: float) -> None:
    """Doubt what was guessed of the motion over some time: a car goes where it points.

    A turn that was missed has turned the velocity too, and so is no news to a constraint that
    compares the two. What the lateral force tells of it is taken out of its doubt.

    Parameters
    ----------
    b : Belief
        Changed in place.
    doubt : ndarray, shape (4,)
        As in `Filling`.
    seconds : float
        For how long.
    """
    c, turn, gains = b.C_nb, seconds * doubt[0], seconds * doubt[1:]
    swept = turn * np.square(np.cross([0.0, 0.0, 1.0], c.T @ b.v_n))
    gains = np.maximum(gains - swept, 0.1 * gains)
    spread = np.zeros((6, 4))
    spread[:3, 0] = np.cross(c[:, 2], b.v_n) * np.sqrt(turn)
    spread[3:, 0] = c[:, 2] * np.sqrt(turn)
    spread[:3, 1:] = c * np.sqrt(gains)
    _spread(b, spread, seconds)


def tilt(b: Belief, doubt: Array) -> None:
    """Doubt roll and pitch.

    Parameters
    ----------
    b : Belief
        Changed in place.
    doubt : ndarray, shape (2,)
        Variances about the forward and the right axis [rad^2].
    """
    spread = np.zeros((6, 2))
    spread[3:] = b.C_nb[:, :2] * np.sqrt(doubt)
    _spread(b, spread, 0.0)


def _spread(b: Belief, spread: Array, seconds: float) -> None:
    """Add errors of velocity and attitude, shape (6, k), that grew at random over some time till now."""
    whole = np.vstack([0.5 * seconds * spread[:3], spread])
    p = b.p.reshape(ROW, ROW)
    p[:9, :9] += whole @ whole.T
    p[:3, :3] += seconds * seconds / 12.0 * spread[:3] @ spread[:3].T


def lose_track(b: Belief, time: float, silence: float, turned: float) -> None:
    """Carry on after a long silence of the IMU: what a car may have done meanwhile bounds the doubt.

    It went straight on, faster or slower. That it may have turned is for the caller to `turn`, but for
    where in the hole it did.

    Parameters
    ----------
    b : Belief
        Changed in place.
    time : float
        When samples come again [s].
    silence : float
        How long there were none [s].
    turned : float
        Standard deviation of the heading's change [rad].
    """
    r_m, r_n = earth.radii(np.sin(b.x[0]))
    b.x[0] += b.x[3] * silence / r_m
    b.x[1] += b.x[4] * silence / (r_n * np.cos(b.x[0]))
    b.memory[:] = 0.0
    b.memory[at.TIME] = time
    p = b.p.reshape(ROW, ROW)
    p[:3] += silence * p[3:6]
    p[:, :3] += silence * p[:, 3:6]
    b.error[:3] += silence * b.error[3:6]
    spread = np.zeros((6, 5))
    spread[:3, :3] = b.C_nb * np.array([1.0, 0.1, 0.1]) * min(3.0 * silence, 15.0)
    spread[3:5, 3:5] = np.eye(2) * TILTED
    _spread(b, spread, silence)
    aside = silence / np.sqrt(12.0) * min(turned, 1.0) * np.cross([0.0, 0.0, 1.0], b.v_n)
    p[:3, :3] += np.outer(aside, aside)
    b.trail = Trail(b.trail.length)


def turn(b: Belief, place: Array, variance: float) -> None:
    """Doubt the heading since some place: the way from there may be turned about it as a whole.

    Parameters
    ----------
    b : Belief
        Changed in place.
    place : ndarray, shape (3,)
        Latitude, longitude [rad], height [m].
    variance : float
        [rad^2]
    """
    p, turned = b.p.reshape(ROW, ROW), turned_about(b, place)
    p[:9, :9] += variance * np.outer(turned, turned)


def turned_about(b: Belief, place: Array) -> Array:
    """What a turn of the way since some place does to position, velocity and attitude.

    Parameters
    ----------
    b : Belief
    place : ndarray, shape (3,)

    Returns
    -------
    ndarray, shape (9,)
        Errors by the angle [1/rad].
    """
    down = np.array([0.0, 0.0, 1.0])
    way = earth.lla_to_ned(b.lla, place)
    return np.concatenate([np.cross(down, way), np.cross(down, b.v_n), down])
