"""Results of runs as rows: outages, errors by age, tracks, and what the runs themselves say.

Angles are in degrees from here on; NaN is what is not known.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np

from gapless.evaluation import QUANTITIES, Ages, OutageScore, Scores, chi_square_quantile
from gapless.laboratory.study import Scenario
from gapless.scenarios import Outage
from gapless.trip.recording import Array, Columns, Recording, Trajectory
from gapless.trip.solution import Solution
from gapless.units import DEG

Track = TypeVar("Track", bound=Columns)
Row = dict[str, Any]
Block = dict[str, Any]
Describe = Callable[[Solution], Mapping[str, Any]]
"""Gives "decisions", "states" and "innovations" of a solution, ready for JSON."""

_TRACK_STEP: Final = 0.5
"""Rows of a track lie at least so far apart [s]."""


class Key(NamedTuple):
    """What every row begins with.

    Parameters
    ----------
    recording, system, protocol, scenario : str
    """

    recording: str
    system: str
    protocol: str
    scenario: str


def _named(name: str) -> str:
    return f"{name}_deg" if name == "heading" else name


def outage_row(key: Key, scenario: Scenario, truth: str, score: OutageScore) -> Row:
    """One row of `outages.parquet`.

    Parameters
    ----------
    key : Key
    scenario : Scenario
    truth : str
        "reference" or "gnss".
    score : OutageScore

    Returns
    -------
    dict
    """
    sizes = {
        f"{_named(name)}_{what}": getattr(score, f"{name}_{what}") / (DEG if name == "heading" else 1.0)
        for name in QUANTITIES
        for what in ("max", "rmse", "end")
    }
    return {
        **key._asdict(),
        "group": scenario.group,
        "length": scenario.length,
        "shift": scenario.shift,
        "start": score.start,
        "end": score.end,
        "labels": "; ".join(score.labels),
        "truth": truth,
        "truth_epochs": score.truth_epochs,
        "distance": score.distance,
        **sizes,
        "percent": score.percent,
        "coverage_50": score.coverage_50,
        "coverage_95": score.coverage_95,
        "coverage_99": score.coverage_99,
        "nees": score.nees,
        "inside_95_end": score.inside_95_end,
    }


def age_columns(key: Key, start: float, ages: Ages) -> Block:
    """Rows of `ages.parquet` of one outage.

    Parameters
    ----------
    key : Key
    start : float
        Of the outage [s].
    ages : Ages

    Returns
    -------
    dict of str to list or ndarray
    """
    n = len(ages)
    return {
        **{name: [value] * n for name, value in key._asdict().items()},
        "start": np.full(n, start),
        "age": ages.time,
        **{_named(name): getattr(ages, name) / (DEG if name == "heading" else 1.0) for name in QUANTITIES},
        "bound": ages.bound,
        "nees": ages.nees,
    }


def track_columns(key: Key, outage: Outage, rows: Trajectory, start: float) -> Block:
    """Rows of `tracks.parquet` of a system in one outage.

    Parameters
    ----------
    key : Key
    outage : Outage
    rows : Trajectory
        May reach beyond the outage.
    start : float
        Time of the first IMU sample [s].

    Returns
    -------
    dict of str to list or ndarray
    """
    inside = _thinned(rows.slice(start + outage.start, start + outage.until))
    major, minor, direction = ellipse(inside)
    return _track(key, key.system, outage.start, inside.time - start, inside.lla, (major, minor, direction))


def truth_columns(recording: Recording, scores: Scores) -> Block:
    """Rows of `tracks.parquet` of the truth.

    Parameters
    ----------
    recording : Recording
    scores : Scores
        For the offset of its clock.

    Returns
    -------
    dict of str to list or ndarray
    """
    known = recording.gnss if recording.reference is None else recording.reference
    rows = _thinned(known.take(np.isfinite(known.lla).all(axis=1)))
    nan = np.full(len(rows), np.nan)
    time = rows.time + scores.clock_offset - recording.start
    key = Key(recording.name, "", "", "")
    return _track(key, "truth", np.nan, time, rows.lla, (nan, nan, nan))


def _track(
    key: Key, kind: str, start: float, time: Array, lla: Array, ellipse: tuple[Array, Array, Array]
) -> Block:
    n = len(time)
    return {
        "recording": [key.recording] * n,
        "kind": [kind] * n,
        "protocol": [key.protocol] * n,
        "scenario": [key.scenario] * n,
        "start": np.full(n, start),
        "time": time,
        "lat": lla[:, 0] / DEG,
        "lon": lla[:, 1] / DEG,
        **dict(zip(("semi_major", "semi_minor", "direction"), ellipse, strict=True)),
    }


def ellipse(rows: Trajectory, probability: float = 0.95) -> tuple[Array, Array, Array]:
    """Stated horizontal error ellipse.

    Parameters
    ----------
    rows : Trajectory
    probability : float
        That it should hold the truth.

    Returns
    -------
    semi_major, semi_minor : ndarray, shape (n,)
        [m]
    direction : ndarray, shape (n,)
        Of the major axis, counter-clockwise from east [rad].
    """
    n, e, ne = rows.sd[:, 0] ** 2, rows.sd[:, 1] ** 2, rows.horizontal
    mean, half = 0.5 * (n + e), np.hypot(0.5 * (n - e), ne)
    scale = chi_square_quantile(probability, 2)
    major, minor = np.sqrt(scale * (mean + half)), np.sqrt(scale * np.maximum(mean - half, 0.0))
    return major, minor, np.asarray(0.5 * np.arctan2(2.0 * ne, e - n))


def _thinned(rows: Track) -> Track:
    """At most one row in each half second of the clock."""
    slots = np.floor(rows.time / _TRACK_STEP + 1e-6)
    return rows.take(np.flatnonzero(np.diff(slots, prepend=-np.inf) > 0.0))


def run_row(key: Key, solution: Solution, scores: Scores, describe: Describe) -> Row:
    """One row of `runs.parquet`.

    Parameters
    ----------
    key : Key
    solution : Solution
    scores : Scores
    describe : callable

    Returns
    -------
    dict
    """
    said = describe(solution)
    texts = {"decisions": said["decisions"], "biases": said["states"], "innovations": said["innovations"]}
    return {
        **key._asdict(),
        **{name: json.dumps(value, ensure_ascii=False) for name, value in texts.items()},
        "rmse_open": scores.aided.horizontal_rmse,
        "coverage_open_95": scores.aided.coverage,
    }
