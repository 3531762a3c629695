"""Who supplies the events of a recording: everything in the order in which it arrived."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from operator import itemgetter

import numpy as np

from gapless.trip.events import EPS, Event, ImuBlock, Reading
from gapless.trip.recording import Array, Gnss, Imu, Recording

AHEAD = 5.0
"""Readings of so many seconds are laid out at once where all is known [s]: samples run on in one go."""
Arrival = tuple[float, tuple[Reading, ...]]
"""When readings arrive, and which."""


DRIFT, SINCE = "drift", "since"
"""Beside channels, offsets may name by how much those of a receiver grow in a second, and from when [s]."""


def parted(time: Array, offsets: Mapping[str, float]) -> Array:
    """What a drift of the receiver's clock adds to its offsets.

    Parameters
    ----------
    time : ndarray
        Stamps as logged [s].
    offsets : mapping of str to float
        As for `events`.

    Returns
    -------
    ndarray
        [s]; zeros where there is none.
    """
    return np.asarray(offsets.get(DRIFT, 0.0) * (time - offsets.get(SINCE, 0.0)))


def events(
    recording: Recording,
    offsets: Mapping[str, float],
    start: float = -np.inf,
    end: float = np.inf,
    thin: float = 0.0,
) -> Iterator[Event]:
    """IMU blocks and readings by arrival.

    A reading arrives at its logged stamp, before an IMU sample of the same stamp, and holds for that
    stamp plus its channel's offset.

    Parameters
    ----------
    recording : Recording
        GNSS epochs that are to be withheld already taken out.
    offsets : mapping of str to float
        By channel: what is added to a stamp to land on the IMU clock [s]; 0 where not named.
    start, end : float
        Only what arrived in start <= time < end.
    thin : float
        Least time between the GNSS epochs that are used [s].

    Yields
    ------
    Event
    """
    yield from merged(recording.imu, _arrivals(recording, offsets, thin, start, end), start, end)


def in_order(recording: Recording, offsets: Mapping[str, float], thin: float = 0.0) -> list[Arrival]:
    """Readings by the time that they hold for: what only looking back can have.

    Parameters
    ----------
    recording : Recording
    offsets : mapping of str to float
        As for `events`.
    thin : float
        Least time between the GNSS epochs that are used [s].

    Returns
    -------
    list of (float, tuple of Reading)
        For `merged`: those of some seconds at once, ahead of their samples. None comes after a sample that
        ends later than it holds, by a rounding error even.
    """
    found = _arrivals(recording, offsets, thin, -np.inf, np.inf)
    readings = sorted((r for _, together in found for r in together), key=lambda r: r.time)
    return [
        ((few := tuple(together))[0].time - 2.0 * EPS, few)
        for _, together in groupby(readings, lambda r: r.time // AHEAD)
    ]


def merged(
    imu: Imu, arrivals: Sequence[Arrival], start: float = -np.inf, end: float = np.inf
) -> Iterator[Event]:
    """IMU blocks with readings between them.

    Parameters
    ----------
    imu : Imu
    arrivals : sequence of (float, tuple of Reading)
        Readings and when they arrive [s], in order of that.
    start, end : float
        Only what arrived in start <= time < end.

    Yields
    ------
    Event
    """
    chosen = slice(*(bisect_left(arrivals, t, key=itemgetter(0)) for t in (start, end)))
    arrivals = arrivals[chosen]
    first, last = (int(k) for k in np.searchsorted(imu.time, [start, end]))
    stops = np.searchsorted(imu.time, [t for t, _ in arrivals])
    for (_, readings), stop in zip(arrivals, np.clip(stops, first, last).tolist(), strict=True):
        if stop > first:
            yield ImuBlock.of(imu, first, stop)
            first = stop
        yield readings
    if last > first:
        yield ImuBlock.of(imu, first, last)


def _arrivals(
    recording: Recording, offsets: Mapping[str, float], thin: float, start: float, end: float
) -> list[Arrival]:
    found = list(_fixes(recording.gnss, offsets, thin, start, end))
    odometer = recording.odometer
    if odometer is not None:
        late, one = offsets.get("odometer", 0.0), np.ones(1)
        gaps = _intervals(odometer.time).tolist()
        for i in _between(odometer.time, start, end):
            t = float(odometer.time[i])
            found.append((t, (Reading("odometer", t + late, odometer.speed[i : i + 1], one, gaps[i]),)))
        found.sort(key=lambda arrival: arrival[0])
    return found


def _fixes(
    gnss: Gnss, offsets: Mapping[str, float], thin: float, start: float, end: float
) -> Iterator[tuple[float, tuple[Reading, ...]]]:
    if thin > 0.0:
        gnss = gnss.take(_thinned(gnss.time, thin))
    gaps = _intervals(gnss.time).tolist()
    has_position = np.asarray(np.isfinite(gnss.lla).all(axis=1))
    has_velocity = np.asarray(np.isfinite(gnss.v_n).all(axis=1))
    late = offsets.get("position", 0.0), offsets.get("velocity", 0.0)
    held = (gnss.time + parted(gnss.time, offsets)).tolist()
    for i in _between(gnss.time, start, end):
        t = float(gnss.time[i])
        readings: tuple[Reading, ...] = ()
        if has_position[i]:
            readings += (Reading("position", held[i] + late[0], gnss.lla[i], gnss.sd_position[i], gaps[i]),)
        if has_velocity[i]:
            readings += (Reading("velocity", held[i] + late[1], gnss.v_n[i], gnss.sd_velocity[i], gaps[i]),)
        if readings:
            yield t, readings


def _between(time: Array, start: float, end: float) -> range:
    """Rows with start <= time < end."""
    return range(*np.searchsorted(time, [start, end]).tolist())


def _thinned(time: Array, least: float) -> list[int]:
    kept: list[int] = []
    for i, t in enumerate(time.tolist()):
        if not kept or t - time[kept[-1]] >= least - 1e-3:
            kept.append(i)
    return kept


def _intervals(time: Array) -> Array:
    """Seconds since the reading before; the first is given one, and an outage counts for ten."""
    return np.clip(np.diff(time, prepend=time[:1] - 1.0), 0.01, 10.0)
