"""Do velocities, wheel speeds and positions tell of the same drive? Units, order, signs."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.io.log import Log
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Array, Gnss, Odometer

_SPAN: Final = 10.0
"""Seconds over which displacements are compared: long against the noise of a fix."""
_FAR: Final = 30.0
"""Displacement [m] from which on a pair is compared: ten times a single point's noise."""
_ENOUGH: Final = 30
"""Pairs below which nothing is concluded."""
_HILLY: Final = 0.5
"""Standard deviation of heights gained in ten seconds [m] below which they say nothing."""
_UNITS: Final = {
    3.6: "km/h",
    1 / 0.44704: "mph",
    1 / 0.514444: "knots",
    1 / 0.3048: "ft/s",
    100.0: "cm/s",
    1000.0: "mm/s",
}


def check_velocity(log: Log, gnss: Gnss) -> None:
    """Refuse a log whose velocities contradict its positions.

    Medians over pairs of fixes ten seconds apart decide, so outliers do not.

    Parameters
    ----------
    log : Log
        For the error.
    gnss : Gnss

    Raises
    ------
    RecordingError
        If the velocity's integral is not along the displacement or not as long.
    """
    ahead, moved = _displacements(gnss)
    _check_down(log, ahead[:, 2], moved[:, 2])
    ahead, moved = ahead[:, :2], moved[:, :2]
    size_v, size_p = np.hypot(*ahead.T), np.hypot(*moved.T)
    if len(ahead) >= _ENOUGH and np.mean((size_v > _FAR) & (size_p < 0.03 * size_v)) > 0.2:
        log.refuse(
            "the velocity moves, the positions hardly do", "lat and lon may be in radians: log degrees"
        )
    far = np.minimum(size_v, size_p) > _FAR
    if far.sum() < _ENOUGH:
        return
    ahead, moved, size_v, size_p = ahead[far], moved[far], size_v[far], size_p[far]
    along = float(np.median((ahead * moved).sum(axis=1) / (size_v * size_p)))
    crossed = float(np.median((ahead[:, ::-1] * moved).sum(axis=1) / (size_v * size_p)))
    ratio = float(np.median(size_v / size_p))
    if along < 0.7:
        cure = "check the signs and order of v_north and v_east"
        if crossed > 0.7:
            cure = "v_north and v_east, or lat and lon, look exchanged: swap them"
        log.refuse(f"velocity does not point along the track (median cosine {along:.2f})", cure)
    if not 0.7 < ratio < 1.4:
        log.refuse(
            f"velocity is {ratio:.3g} times what the positions show", f"{_unit(ratio)}: log deg and m/s"
        )


def _check_down(log: Log, sunk: Array, lower: Array) -> None:
    """Whether heights fall where the velocity says so; on flat roads neither tells."""
    if len(sunk) < _ENOUGH or min(np.std(sunk), np.std(lower)) < _HILLY:
        return
    agreed = float(np.corrcoef(sunk, lower)[0, 1])
    if agreed < -0.7:
        log.refuse(
            f"v_down points up (its correlation with falling heights is {agreed:.2f})", "change its sign"
        )


_DEAD = 0.02
"""A sensor that shows less of the way is not in another unit, but dead: the navigator silences it."""


def check_odometer(log: Log, wheels: Odometer, gnss: Gnss) -> None:
    """Refuse wheel speeds whose way is not nearly as long as the positions show.

    Parameters
    ----------
    log : Log
        For the error.
    wheels : Odometer
    gnss : Gnss

    Raises
    ------
    RecordingError
        If the way is another, by more than a scale error or winding roads explain.
    """
    known = np.isfinite(gnss.lla).all(axis=1)
    known &= (gnss.time >= wheels.time[0]) & (gnss.time <= wheels.time[-1])
    t, lla = gnss.time[known], gnss.lla[known]
    first, last = _apart(t)
    way = _integral(wheels.time, wheels.speed)
    rolled = np.interp(t[last], wheels.time, way) - np.interp(t[first], wheels.time, way)
    moved = np.hypot(*offset_ned(lla[last], lla[first])[:, :2].T)
    far = moved > _FAR
    if far.sum() < _ENOUGH:
        return
    share = rolled[far] / moved[far]
    alive = share[share > _DEAD]
    ratio = float(np.median(alive)) if len(alive) >= _ENOUGH else 1.0
    if not 0.7 < ratio < 1.4 and np.mean(np.abs(alive / ratio - 1.0) < 0.15) > 0.6:  # a unit is always wrong
        log.refuse(f"wheel speed is {ratio:.3g} times what the positions show", f"{_unit(ratio)}: log m/s")


def _unit(ratio: float) -> str:
    unit = next((u for x, u in _UNITS.items() if abs(ratio / x - 1.0) < 0.08), None)
    return f"it looks like {unit}" if unit else "check its unit"


def _apart(t: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of epochs about ten seconds apart."""
    first = np.arange(len(t))
    last = np.searchsorted(t, t + _SPAN)
    first, last = first[last < len(t)], last[last < len(t)]
    near = t[last] - t[first] < 1.2 * _SPAN
    return first[near], last[near]


def _integral(t: Array, rate: Array) -> Array:
    """Of a speed or a velocity, by trapezia, zero at the first epoch."""
    found = np.zeros_like(rate)
    found[1:] = np.cumsum((0.5 * (rate[1:] + rate[:-1]).T * np.diff(t)).T, axis=0)
    return found


def _displacements(gnss: Gnss) -> tuple[Array, Array]:
    """North, east and down [m] over about ten seconds, by velocity and by position."""
    known = np.isfinite(gnss.lla).all(axis=1) & np.isfinite(gnss.v_n).all(axis=1)
    t, lla, v = gnss.time[known], gnss.lla[known], gnss.v_n[known]
    if len(t) > 5:  # spikes of single fixes are the navigator's to judge
        v[2:-2] = np.median(np.lib.stride_tricks.sliding_window_view(v.copy(), 5, axis=0), axis=-1)
    first, last = _apart(t)
    path = _integral(t, v)
    return path[last] - path[first], offset_ned(lla[last], lla[first])
