"""The prefix law: what a row says must not change when nothing is there after it.

`navigate(recording[:t]) == navigate(recording)[:t]`, bit for bit, with the withheld fixes replaced by
nonsense: so no row has seen a later sample, nor a fix that it was not to see.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from gapless.scenarios import Outage, withhold
from gapless.trip.motion import displace
from gapless.trip.recording import Recording, Trajectory
from gapless.trip.solution import Solution

RANDOM_SAMPLES: Final = 3
"""Rows of an outage that are looked at besides the first and the last."""
_COLUMNS: Final = ("time", "lla", "v_n", "euler", "sd", "horizontal")
_ASTRAY, _FAST = 5000.0, 50.0
"""Size of the nonsense [m, m/s]: beyond what any gate lets pass for an error, and stated as exact."""


class Peek(NamedTuple):
    """A row that knew too much.

    Parameters
    ----------
    outage : Outage
    time : float
        Of the row [s after the first IMU sample].
    """

    outage: Outage
    time: float


def samples(rows: Trajectory, outage: Outage, start: float, rng: np.random.Generator) -> tuple[float, ...]:
    """Times of the rows of an outage that are looked at: the first, the last and three at random.

    Parameters
    ----------
    rows : Trajectory
    outage : Outage
    start : float
        Time of the first IMU sample [s].
    rng : numpy.random.Generator

    Returns
    -------
    tuple of float
        [s], increasing; none where the outage has no rows.
    """
    inside = rows.slice(start + outage.start, start + outage.until).time
    n = len(inside)
    if not n:
        return ()
    chosen = {0, n - 1, *rng.integers(0, n, RANDOM_SAMPLES).tolist()}
    return tuple(float(inside[k]) for k in sorted(chosen))


def known_at(recording: Recording, time: float) -> float:
    """Where to cut a recording so that a row can just be written.

    Parameters
    ----------
    recording : Recording
    time : float
        Of the row [s].

    Returns
    -------
    float
        [s] just after the stamp of the IMU sample in which the row lies. As a rule the row lies at its
        very end; where a reading cuts a sample in two, a row may lie at the cut.
    """
    stamps = recording.imu.time
    k = min(int(np.searchsorted(stamps, time)), len(stamps) - 1)
    return float(np.nextafter(max(stamps[k], time), np.inf))


def spoil(recording: Recording, outages: Sequence[Outage], rng: np.random.Generator) -> Recording:
    """The recording with nonsense in place of all that the outages withhold, and without its reference.

    Parameters
    ----------
    recording : Recording
    outages : sequence of Outage
    rng : numpy.random.Generator

    Returns
    -------
    Recording
        With fixes of the same stamps; what a degraded fix is made from stays.
    """
    gnss = recording.gnss
    left = withhold(gnss, outages, recording.start)
    rows = np.searchsorted(left.time, gnss.time)
    there = np.isin(gnss.time, left.time)
    rows = np.minimum(rows, max(len(left) - 1, 0))
    lla, v_n, sd_position, sd_velocity = (
        a.copy() for a in (gnss.lla, gnss.v_n, gnss.sd_position, gnss.sd_velocity)
    )
    no_position = ~there | (np.isnan(left.lla[rows]).any(axis=1) if len(left) else True)
    no_velocity = ~there | (np.isnan(left.v_n[rows]).any(axis=1) if len(left) else True)
    n = len(gnss)
    lla[no_position] = displace(lla, _ASTRAY * rng.standard_normal((n, 3)))[no_position]
    v_n[no_velocity] += _FAST * rng.standard_normal((n, 3))[no_velocity]
    sd_position[no_position], sd_velocity[no_velocity] = 0.01, 0.01
    spoilt = replace(gnss, lla=lla, v_n=v_n, sd_position=sd_position, sd_velocity=sd_velocity)
    return replace(recording, gnss=spoilt, reference=None)


def first_difference(
    rows: Trajectory, again: Trajectory, after: float, times: Sequence[float]
) -> float | None:
    """First time at which two runs differ, of all that was written up to the last sample looked at.

    Parameters
    ----------
    rows : Trajectory
        Of the run in question.
    again : Trajectory
        Of the one that knew no more than it was to know.
    after : float
        Rows later than this are compared [s].
    times : sequence of float
        Samples looked at [s], increasing.

    Returns
    -------
    float or None
        [s]
    """
    if not times or not len(rows):
        return None
    after = max(after, float(np.nextafter(rows.time[0], -np.inf)))
    a, b = (t.take((t.time > after) & (t.time <= times[-1])) for t in (rows, again))
    n = min(len(a), len(b))
    same = np.ones(n, bool)
    for name in _COLUMNS:
        x, y = (getattr(t, name)[:n].reshape(n, -1) for t in (a, b))
        same &= ((x == y) | (np.isnan(x) & np.isnan(y))).all(axis=1)
    if not same.all():
        return float(a.time[int(np.argmin(same))])
    if len(a) != len(b):
        return float((a if len(a) > n else b).time[n])
    return None


def from_the_start(
    run: Callable[[Recording, tuple[Outage, ...]], Solution],
    recording: Recording,
    outages: tuple[Outage, ...],
    rows: Trajectory,
    time: float,
    rng: np.random.Generator,
) -> float | None:
    """First row up to a time that is not the same where nothing is there after it.

    Parameters
    ----------
    run : callable
        Navigates a recording through outages, from its first sample.
    recording : Recording
    outages : tuple of Outage
    rows : Trajectory
        Of the run in question.
    time : float
        [s]
    rng : numpy.random.Generator

    Returns
    -------
    float or None
        [s]
    """
    cut = spoil(recording, outages, rng).slice(-np.inf, known_at(recording, time))
    return first_difference(rows, run(cut, outages).trajectory, -np.inf, (time,))
