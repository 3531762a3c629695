"""Clock offset to half a second or so, from turns: the course by GNSS turns when the gyros feel it.

The fine search looks a second and a half to either side, and must begin near. Leap seconds, a logger that
stamps what it was sent a while ago, a clock set by hand: such stamps are further off, and nothing else tells
them from a drive in which nothing fits.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.trip.motion import Sums
from gapless.trip.recording import Array, Gnss, Imu
from gapless.trip.steering import steered

REACH: Final = 30.0
"""Offsets up to this are looked for [s]: leap seconds are 18."""
_STEP: Final = 0.25
_HALF: Final = 1.0
"""Turns are compared over twice this [s]."""
_ENOUGH: Final = 60
"""Turns, a second apart, below which nothing is concluded."""
_ALONE: Final = 2.0
"""Anywhere else so many times as much of the turns must be left unexplained: half of them is least."""
_NEAR: Final = 5.0
"""Offsets less apart see the same turns [s]."""
_SMALL: Final = 1.0
"""Offsets up to this are left to the finer search [s]."""


class Turns(NamedTuple):
    """How well turns agree, for each offset.

    Parameters
    ----------
    offset : ndarray, shape (n,)
        Added to the stamps of the receiver [s].
    explained : ndarray, shape (n,)
        Share of the variance of the course's turns; zero where too little was driven.
    """

    offset: Array
    explained: Array


def turns(imu: Imu, gnss: Gnss) -> Turns:
    """Hold the turns of the course against those of the gyros, about whatever axis explains most.

    Parameters
    ----------
    imu : Imu
    gnss : Gnss

    Returns
    -------
    Turns
    """
    offsets, explained = np.arange(-REACH, REACH + 0.5 * _STEP, _STEP), list[float]()
    if not len(imu):
        return Turns(offsets, np.zeros(len(offsets)))
    drove, angle = steered(gnss, _HALF), Sums.of(imu, imu.dtheta)
    turned = drove.turned
    for at in (drove.time + s for s in offsets):
        there = (at - _HALF > angle.time[0]) & (at + _HALF < angle.time[-1])
        felt = angle.around(at[there], _HALF)
        explained.append(_explained(felt, turned[there]) if there.sum() >= _ENOUGH else 0.0)
    return Turns(offsets, np.array(explained))


def far_off(told: Turns) -> float:
    """Offset that turns show where it is more than a second; else zero.

    Parameters
    ----------
    told : Turns

    Returns
    -------
    float
        [s]
    """
    k = int(np.argmax(told.explained))
    found = float(told.offset[k])
    elsewhere = float(told.explained[np.abs(told.offset - found) > _NEAR].max())
    shown = 1.0 - elsewhere > _ALONE * (1.0 - float(told.explained[k]))
    return found if shown and abs(found) > _SMALL else 0.0


def _explained(felt: Array, turned: Array) -> float:
    """Share of the variance of one column that three others, and a constant, explain."""
    felt, turned = felt - felt.mean(axis=0), turned - turned.mean()
    fitted = felt @ np.linalg.lstsq(felt, turned, rcond=None)[0]
    return float(fitted @ fitted) / max(float(turned @ turned), 1e-30)
