"""What a bridge remembers of each GNSS epoch, and what of it a learner is shown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from gapless import attitude
from gapless.trip.recording import Array


class Epoch(NamedTuple):
    """One GNSS epoch, or in an outage the moment at which one would have come.

    Parameters
    ----------
    time : float
        [s]
    dt : float
        Seconds since the epoch before; NaN where there was none, or a gap.
    segment : int
        Counts the shadow's starts: errors of different segments have nothing to do with each other.
    age : float
        Since the shadow's start [s].
    shadow : ndarray, shape (10,)
        State of the shadow INS.
    displacement : ndarray, shape (3,)
        Shadow's position since its start, NED [m].
    v_n : ndarray, shape (3,)
        Velocity of the filter (in an outage: as far as it is held) [m/s].
    rate, force : ndarray, shape (3,)
        Means over the epoch, corrected for bias, FRD [rad/s], [m/s^2].
    gnss_error : ndarray, shape (6,)
        Shadow less GNSS: position [m], velocity [m/s]; NaN in an outage.
    filter_error : ndarray, shape (9,)
        Shadow less filter: position, velocity, attitude [rad]; NaN in an outage.
    fix : ndarray, shape (3,)
        Antenna: latitude, longitude [rad], height [m]; NaN in an outage.
    """

    time: float
    dt: float
    segment: int
    age: float
    shadow: Array
    displacement: Array
    v_n: Array
    rate: Array
    force: Array
    gnss_error: Array
    filter_error: Array
    fix: Array


NOWHERE: Final = np.full(3, np.nan)


def _heading(e: Epoch) -> Array:
    angle = attitude.to_euler(e.shadow[6:10])[2]
    return np.array([np.sin(angle), np.cos(angle)])


def _attitude(e: Epoch) -> Array:
    euler = attitude.to_euler(e.shadow[6:10])
    return np.concatenate([euler[:2], _heading(e)])


FEATURES: Final[dict[str, Callable[[Epoch], Array]]] = {
    "heading": _heading,  # of the shadow, as sine and cosine
    "attitude": _attitude,  # its roll, pitch and heading, the last as sine and cosine
    "velocity": lambda e: e.shadow[3:5],  # of the shadow, north and east
    "position": lambda e: e.displacement[:2],  # of the shadow, north and east of its start
    "height": lambda e: np.array([e.displacement[2], e.shadow[5]]),  # of the shadow, and its rate
    "age": lambda e: np.array([e.age]),  # since the shadow's start
    "ins_velocity": lambda e: e.v_n,  # of the filter
    "force": lambda e: e.force,  # mean over the epoch: its integral, but for the epoch's length
    "rate": lambda e: e.rate,
}
"""What a recipe may show a learner, by name."""


def features(names: Sequence[str], epoch: Epoch) -> Array:
    """One row of inputs.

    Parameters
    ----------
    names : sequence of str
        From `FEATURES`.
    epoch : Epoch

    Returns
    -------
    ndarray, shape (k,)
    """
    return np.concatenate([FEATURES[name](epoch) for name in names]) if names else np.zeros(0)


def unknown() -> Epoch:
    """An epoch of nothing: level, at rest, at zero, and after no other.

    Returns
    -------
    Epoch
    """
    still = np.zeros(10)
    still[6] = 1.0
    none = np.zeros(3)
    return Epoch(0.0, 1.0, 0, 0.0, still, none, none, none, none, np.zeros(6), np.zeros(9), none)


def follows(epoch: Epoch, previous: Epoch) -> bool:
    """Whether an epoch is the next one of the same segment.

    Parameters
    ----------
    epoch, previous : Epoch

    Returns
    -------
    bool
    """
    return epoch.segment == previous.segment and not np.isnan(epoch.dt)
