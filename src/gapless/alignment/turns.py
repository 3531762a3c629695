"""Clock offset to half a second or so, from turns: the course by GNSS turns when the gyros feel it.

The fine search looks a second and a half to either side, and must begin near. Leap seconds, a logger that
stamps what it was sent a while ago, a clock set by hand: such stamps are further off, and nothing else tells
them from a drive in which nothing fits.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.alignment.clock import neighbours
from gapless.trip.motion import Sums
from gapless.trip.recording import Array, Gnss, Imu
from gapless.trip.steering import steered

REACH: Final = 30.0
"""Offsets up to this are looked for [s]: leap seconds are 18."""
_STEP: Final = 0.25
_FINE: Final = 0.05
"""Felt turns are laid out at such a step [s]: they are sums over two seconds."""
_HALF: Final = 1.0
"""Turns are compared over twice this [s]."""
_SHARP: Final = 1.0
"""A course that turns by more within the window is a spike's, not a car's [rad]."""
_SPIKE: Final = 15.0
"""A velocity that is off the median of five by more is no car's [m/s]."""
_ENOUGH: Final = 60
"""Turns, a second apart, below which nothing is concluded."""
_ALONE: Final = 2.0
"""Anywhere else so many times as much of the turns must be left unexplained: half of them is least."""
_NEAR: Final = 5.0
"""Offsets less apart see the same turns [s]."""
_TURNING: Final = 0.09
"""A car turns where its course does by so much within twice `_HALF` [rad]: it swerves by less."""
_TOLD: Final = 20.0
"""Seconds of turning on both sides from which turns must agree: half a dozen corners."""
_STRANGE: Final = 0.3
"""Turns of which no offset explains so much are not of one car at one time: by chance it is a fifth."""
_CLEAR: Final = 0.5
"""Turns that are the same are explained to nine tenths, on real cars too; less than this is a puzzle."""
_SURE: Final = 0.85
"""An offset far off is named where it explains so much."""
_FAR: Final = 600.0
"""Where no offset within `REACH` explains turns, offsets up to this are looked at for a hint [s]."""
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
    both : float
        Seconds of turning that course and gyros have, the lesser of the two.
    """

    offset: Array
    explained: Array
    both: float = 0.0


def turns(imu: Imu, gnss: Gnss, reach: float = REACH, least: float = 0.0) -> Turns:
    """Hold the turns of the course against those of the gyros, about whatever axis explains most.

    Parameters
    ----------
    imu : Imu
    gnss : Gnss
    reach : float
        Offsets up to this are looked at [s].
    least : float
        Where the course turned for less than this, an offset explains nothing [s].

    Returns
    -------
    Turns
    """
    offsets, explained = np.arange(-reach, reach + 0.5 * _STEP, _STEP), list[float]()
    if not len(imu):
        return Turns(offsets, np.zeros(len(offsets)))
    drove, angle = steered(_sound(gnss), _HALF), Sums.of(imu, imu.dtheta)
    slow = np.abs(drove.turned) < _SHARP
    turned, time = drove.turned[slow], drove.time[slow]
    grid = np.arange(angle.time[0] + _HALF, angle.time[-1] - _HALF, _FINE)
    swung = angle.around(grid, _HALF)
    for at in (time + s for s in offsets):
        there = (at - _HALF > angle.time[0]) & (at < grid[-1]) if len(grid) else np.zeros(len(at), bool)
        there &= (np.abs(turned[there]) > _TURNING).sum() >= least
        felt = _between(swung, (at[there] - grid[0]) / _FINE) if there.any() else swung[:0]
        explained.append(_explained(felt, turned[there]) if there.sum() >= _ENOUGH else 0.0)
    return Turns(offsets, np.array(explained), _turning(turned, angle))


def _between(value: Array, at: Array) -> Array:
    """Rows of a table at fractional indices."""
    k = np.minimum(at.astype(int), len(value) - 2)
    return np.asarray(value[k] + (at - k)[:, None] * (value[k + 1] - value[k]))


def _sound(gnss: Gnss) -> Gnss:
    """Fixes without those whose velocity no car has between its neighbours': a spike turns nothing."""
    v = gnss.v_n[:, :2]
    if len(v) < 5 or not np.isfinite(v).all():
        return gnss
    return gnss.take(np.hypot(*(v - neighbours(v)).T) < _SPIKE)


def _turning(turned: Array, angle: Sums) -> float:
    """Seconds of turning that both course and gyros have."""
    at = np.arange(angle.time[0] + _HALF, angle.time[-1] - _HALF, 1.0)
    if not len(at):
        return 0.0
    felt = angle.around(at, _HALF)
    swung = np.linalg.norm(felt - np.median(felt, axis=0), axis=1)
    return float(min((np.abs(turned) > _TURNING).sum(), (swung > _TURNING).sum()))


def strangers(told: Turns) -> bool:
    """Whether course and gyros both tell of turns, and no offset makes them the same ones.

    Parameters
    ----------
    told : Turns

    Returns
    -------
    bool
        False where there are too few turns, as on a motorway.
    """
    enough = told.both >= _TOLD and bool((told.explained > 0.0).mean() > 0.5)
    return enough and float(told.explained.max()) < _STRANGE


def puzzling(told: Turns) -> bool:
    """Whether there are turns, and no offset explains them as it should.

    Parameters
    ----------
    told : Turns

    Returns
    -------
    bool
    """
    return (
        told.both >= 0.5 * _TOLD
        and bool((told.explained > 0.0).mean() > 0.5)
        and told.explained.max() < _CLEAR
    )


def hint(imu: Imu, gnss: Gnss) -> float:
    """Offset further off that explains turns all the same; zero where there is none.

    Parameters
    ----------
    imu : Imu
    gnss : Gnss

    Returns
    -------
    float
        [s]
    """
    told = turns(imu, gnss, _FAR, 0.5 * _TOLD)
    return far_off(told) if told.explained.max() > _SURE else 0.0


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
