"""What a run found, as one JSON-able dict."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from gapless.evaluation import Scores, consistency
from gapless.reports.numbers import known, measured, plain
from gapless.reports.quantities import state
from gapless.trip.exhibits import Candidate, Heard, Rehearsals, WheelsHeard
from gapless.trip.motion import horizontal_velocity, motion
from gapless.trip.recording import Trajectory
from gapless.trip.solution import Decision, Innovations, Solution, observability
from gapless.units import DEG
from gapless.version import __version__

_ANGLES = ("roll_rmse", "pitch_rmse", "heading_rmse", "heading_max", "heading_end")


def summarise(solution: Solution, scores: Scores | None = None) -> dict[str, Any]:
    """Everything worth keeping of a run besides its trajectory.

    Parameters
    ----------
    solution : Solution
    scores : Scores, optional

    Returns
    -------
    dict
        For `summary.json`: numbers, strings, lists and dicts; None where a number is not known.
        Metres, seconds, m/s; angles in degrees, their keys end in "_deg"; states name their unit.
        "verdict" judges the run in a sentence, "" where there is nothing to say.
        "notices", "observability", "wheels" and "rehearsals" are in SI units; times of the latter two are
        those of the IMU's clock.
    """
    moved = travelled(solution.trajectory)
    return {
        "gapless": __version__,
        "name": solution.name,
        "system": solution.system,
        "verdict": solution.verdict,
        "notices": [plain(one) for one in solution.notices],
        "start": plain(solution.start),
        "rows": len(solution.trajectory),
        "duration": plain(span(solution.trajectory)),
        "distance": plain(moved),
        "position_sd": plain(typical_sd(solution)),
        "decisions": [plain(one) for one in solution.decisions],
        "states": {name: _final(solution, name) for name in solution.states},
        "observability": [plain(one._asdict()) for one in observability(solution)],
        "innovations": {name: plain(channel_statistics(c)) for name, c in solution.innovations.items()},
        "scores": None if scores is None else _scores(scores),
        "outages": _outages(solution, scores),
        "wheels": next((_wheels(e) for e in solution.exhibits if isinstance(e, WheelsHeard)), None),
        "rehearsals": next((_rehearsals(e) for e in solution.exhibits if isinstance(e, Rehearsals)), None),
        "notes": [plain(note) for note in solution.notes],
    }


def channel_statistics(channel: Innovations) -> dict[str, float | int]:
    """How the innovations of one channel agree with their stated size.

    Parameters
    ----------
    channel : Innovations

    Returns
    -------
    dict
        `count`, `dof`, `mean_nis` divided by dof with its 95 % band `lower`, `upper` for independent
        innovations, `median_nis` divided by the median of its chi-square distribution, `within_95`
        (share below the 95 % quantile), `inflated`, `rejected`.
    """
    dof = max(channel.z.shape[1], 1)
    found = consistency(channel.nis, dof)
    finite = channel.nis[np.isfinite(channel.nis)]
    rejected = int(np.isinf(channel.factor).sum())
    return {
        "count": len(channel),
        "dof": dof,
        "mean_nis": found.mean / dof,
        "lower": found.lower / dof,
        "upper": found.upper / dof,
        "median_nis": float(np.median(finite)) / _MEDIANS[min(dof, 6)] if len(finite) else math.nan,
        "within_95": found.within,
        "inflated": int((channel.factor > 1.0).sum()) - rejected,
        "rejected": rejected,
    }


_MEDIANS = (math.nan, 0.454936, 1.386294, 2.365974, 3.356694, 4.351460, 5.348121)
"""Median of the chi-square distribution with 0 to 6 degrees of freedom."""


def travelled(trajectory: Trajectory) -> float:
    """Distance travelled [m].

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    float
    """
    if not len(trajectory):
        return 0.0
    velocity = horizontal_velocity(trajectory.time, trajectory.lla, trajectory.v_n)
    return float(motion(trajectory.time, velocity).distance[-1])


def span(trajectory: Trajectory) -> float:
    """Seconds from the first row to the last.

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    float
    """
    return float(trajectory.time[-1] - trajectory.time[0]) if len(trajectory) else 0.0


def typical_sd(solution: Solution) -> float:
    """Median horizontal standard deviation (root of both variances) outside outages [m].

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    float
        NaN where none is stated.
    """
    t = solution.trajectory
    sd = np.hypot(t.sd[:, 0], t.sd[:, 1])[~solution.in_outage(t.time)]
    sd = sd[np.isfinite(sd)]
    return float(np.median(sd)) if len(sd) else math.nan


def _final(solution: Solution, name: str) -> dict[str, Any]:
    values, sds = solution.states[name], solution.states_sd.get(name)
    shown = state(name, values.shape[1])
    last = values[-1] if len(values) else np.full(values.shape[1], math.nan)
    sd = sds[-1] if sds is not None and len(sds) else np.full(values.shape[1], math.nan)
    return {
        "unit": shown.unit,
        "axes": list(shown.axes),
        "value": plain(last / shown.scale),
        "sd": plain(sd / shown.scale),
    }


def _degrees(record: Any) -> dict[str, Any]:
    """Fields of a score with its angles in degrees."""
    found = {}
    for f in fields(record):
        value = getattr(record, f.name)
        angle = f.name in _ANGLES
        found[f.name + "_deg" * angle] = plain(value / DEG if angle else value)
    return found


def unstated(scores: Mapping[str, Any]) -> str:
    """What is to be said of epochs without a usable covariance; "" where there are none.

    Parameters
    ----------
    scores : mapping
        Of a summary.

    Returns
    -------
    str
    """
    count = scores.get("unstated", 0)
    what = "no covariance that is one (not finite, zero, singular or larger than the earth)"
    return f"{count} epochs state {what}: they count as outside the ellipse" if count else ""


def _scores(scores: Scores) -> dict[str, Any]:
    return {
        "truth": scores.truth,
        "statement": scores.statement,
        "clock_offset": plain(scores.clock_offset),
        "height_offset": plain(scores.height_offset),
        "aided": _degrees(scores.aided),
        "fixes_horizontal_rmse": plain(scores.fixes_rmse),
        "outages": len(scores.outages),
        "outages_apart": len(scores.outages) - len(scores.pool),
        "horizontal_max": plain(scores.horizontal),
        "coverage_95": plain(scores.coverage),
        "unstated": scores.unstated,
    }


def _outages(solution: Solution, scores: Scores | None) -> list[dict[str, Any]]:
    if scores is None:
        return [{"start": plain(a), "end": plain(b)} for a, b in solution.outages]
    return [_degrees(one) for one in scores.outages]


def _wheels(e: WheelsHeard) -> dict[str, Any]:
    """Orders as first and step; heights by channel."""
    columns = zip(*e.readings, strict=True) if e.readings else ((),) * len(Heard._fields)
    return {
        "spectra": round(e.spectra),
        "circumference": plain(None if e.circumference is None else round(e.circumference, 3)),
        "contrast": round(e.contrast, 2),
        "first_order": plain(e.orders[0]),
        "order_step": round(float(e.orders[1] - e.orders[0]), 6),
        "height": plain(np.round(e.height, 3)),
        "error": plain(np.round(e.error, 3)),
        "readings": {
            key: plain(np.round(column, 3)) for key, column in zip(Heard._fields, columns, strict=True)
        },
        "refused": e.refused,
    }


def _rehearsals(e: Rehearsals) -> dict[str, Any]:
    def name(who: Candidate) -> str:
        return ", ".join(filter(None, (who.bridge or "nobody", who.preset)))

    return {
        "length": e.length,
        "performances": [
            {
                "start": round(one.start, 3),
                "end": round(one.end, 3),
                "worst": {name(who): round(worst, 2) for who, worst in one.worst},
            }
            for one in e.performances
        ],
        "standings": [plain(one._asdict()) for one in e.standings],
        "choices": [
            {"time": round(c.time, 3), "candidate": name(c.candidate), "scale": round(c.scale, 3)}
            for c in e.choices
        ],
    }


def decision_of(entry: Mapping[str, Any]) -> Decision:
    """A decision as it stands in a summary.

    Parameters
    ----------
    entry : mapping

    Returns
    -------
    Decision
    """
    value = entry["value"]
    if not isinstance(value, str):
        value = tuple(map(known, value)) if isinstance(value, (list, tuple)) else known(value)
    return Decision(**{**entry, "value": value})


def decision_value(decision: Decision) -> str:
    """The value of a decision with its unit, and its standard deviation where there is one.

    Parameters
    ----------
    decision : Decision

    Returns
    -------
    str
    """
    value = decision.value
    if isinstance(value, str):
        return f"{value} {decision.unit}".strip()
    if isinstance(value, tuple):
        text = ", ".join(measured(one, decision.sd) for one in value)
        return text + (f"\u00a0{decision.unit}" if decision.unit else "")
    return measured(float(value), decision.sd, decision.unit)
