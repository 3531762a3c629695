"""Who supplies the events of a recording: everything in the order in which it arrived."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from gapless.events import Event, ImuBlock, Reading
from gapless.recording import Array, Gnss, Recording


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
    arrivals = _arrivals(recording, offsets, thin, start, end)
    imu = recording.imu
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
) -> list[tuple[float, tuple[Reading, ...]]]:
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
    for i in _between(gnss.time, start, end):
        t = float(gnss.time[i])
        readings: tuple[Reading, ...] = ()
        if has_position[i]:
            readings += (Reading("position", t + late[0], gnss.lla[i], gnss.sd_position[i], gaps[i]),)
        if has_velocity[i]:
            readings += (Reading("velocity", t + late[1], gnss.v_n[i], gnss.sd_velocity[i], gaps[i]),)
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
