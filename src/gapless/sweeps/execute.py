"""A run in, its row out, without clock or chance of its own: the same run gives the same bits."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, Final, Literal, get_type_hints

import msgspec

from gapless.errors import AlignmentError, ConfigError, GaplessError, SweepError
from gapless.evaluation import OutageScore, Scores, score
from gapless.runs.fuse import fuse
from gapless.runs.smooth import smooth
from gapless.scenarios import plan
from gapless.sweeps.run import Run, label, versions
from gapless.sweeps.sources import Simulated, recording
from gapless.trip.recording import Recording
from gapless.units import DEG

NAN: Final = math.nan
_HEADING: Final = "heading_"
_SCALARS: Final = (float, int, str, bool, tuple[str, ...])
"""Types of the fields of an outage's score that a table can hold."""


@dataclass(frozen=True)
class Row:
    """One run's result; figures are over the outages that count, NaN where nothing is known.

    Parameters
    ----------
    key : str
        Of the run.
    outcome : str
        "done"; "refused" where gapless said in one line why it cannot; "failed" where a worker died
        of it or a defect showed.
    reason : str
        That line; empty where it is done.
    recording : str
        Name.
    profile, grade : str
        Of a simulated drive; empty for a log.
    seed : int
    system : str
        Name of the recipe.
    override : str
        What was changed in it.
    scenario : str
        Outage arguments, joined by blanks.
    run : str
        The whole run as JSON; `Run` decodes it.
    aligned : bool
        False where no heading was found to start from; None where it did not come to that.
    truth : str
        "reference" or "gnss".
    duration : float
        Of the recording [s].
    outages, apart : int
        Number of outages, and of those that a label sets apart.
    horizontal_max_median, horizontal_max_rms, horizontal_max_p95, horizontal_max_worst : float
        Spread of the largest horizontal error of an outage [m].
    coverage_95 : float
        Share of truth epochs in these outages that the stated 95 % ellipses hold.
    rmse_open : float
        Horizontal RMSE outside outages [m].
    coverage_open_95 : float
        Share of truth epochs outside outages that the stated 95 % ellipses hold.
    each : tuple of dict
        Every outage, those apart too, as `outage_columns` names and measures it.
    """

    key: str
    outcome: Literal["done", "refused", "failed"]
    reason: str
    recording: str
    profile: str
    grade: str
    seed: int
    system: str
    override: str
    scenario: str
    run: str
    aligned: bool | None = None
    truth: str = ""
    duration: float = NAN
    outages: int = 0
    apart: int = 0
    horizontal_max_median: float = NAN
    horizontal_max_rms: float = NAN
    horizontal_max_p95: float = NAN
    horizontal_max_worst: float = NAN
    coverage_95: float = NAN
    rmse_open: float = NAN
    coverage_open_95: float = NAN
    each: tuple[dict[str, Any], ...] = ()


def execute(run: Run) -> Row:
    """Navigate and score one run.

    Parameters
    ----------
    run : Run

    Returns
    -------
    Row
        What gapless refuses, and a defect that shows, are rows too.

    Raises
    ------
    ConfigError
        If the run was planned with other versions than those here: its result would be another's.
    SweepError, OSError
        If its recording is not to be had here: that says nothing about the run.
    """
    if run.versions != versions():
        here, there = (", ".join(f"{k} {v}" for k, v in of.items()) for of in (versions(), run.versions))
        raise ConfigError(f"the study was planned with {there}, this worker has {here}; install the same")
    try:
        log = recording(run.source, run.seed)
    except (SweepError, OSError):
        raise
    except GaplessError as error:
        return blank(run, "refused", str(error))
    except Exception as error:
        return failed(run, error)
    try:
        navigate = smooth if run.smooth else fuse
        solution = navigate(log, run.recipe, plan(run.scenario, log))
        return _scored(run, log, score(solution, log))
    except GaplessError as error:
        aligned = False if isinstance(error, AlignmentError) else None
        return blank(run, "refused", str(error), log, aligned=aligned)
    except Exception as error:  # a defect; the other runs of the study are none the worse for it
        return failed(run, error, log)


def failed(run: Run, error: BaseException, log: Recording | None = None) -> Row:
    """The row of a run that came to nothing, by no fault that gapless foresaw.

    Parameters
    ----------
    run : Run
    error : BaseException
    log : Recording, optional

    Returns
    -------
    Row
    """
    return blank(run, "failed", f"{type(error).__name__}: {error}", log)


def blank(
    run: Run,
    outcome: Literal["done", "refused", "failed"],
    reason: str,
    log: Recording | None = None,
    **known: Any,
) -> Row:
    """What is known of a run besides its figures.

    Parameters
    ----------
    run : Run
    outcome, reason : str
    log : Recording, optional
        Where it could be read.
    **known : object
        Further columns.

    Returns
    -------
    Row
    """
    source = run.source
    simulated, paths = (source, ()) if isinstance(source, Simulated) else (None, source.paths)
    if log is not None:
        known |= {"duration": log.duration}
    return Row(
        key=run.key,
        outcome=outcome,
        reason=" ".join(reason.split()),
        recording=" ".join(paths) if log is None else log.name,
        profile=simulated.profile if simulated else "",
        grade=simulated.grade if simulated else "",
        seed=run.seed,
        system=run.system.name,
        override=label(run.override),
        scenario=" ".join(run.scenario),
        run=msgspec.json.encode(run).decode(),
        **known,
    )


def _scored(run: Run, log: Recording, scores: Scores) -> Row:
    spread = scores.horizontal
    return blank(
        run,
        "done",
        "",
        log,
        aligned=True,
        truth=scores.truth,
        outages=len(scores.outages),
        apart=len(scores.outages) - len(scores.pool),
        horizontal_max_median=spread.median,
        horizontal_max_rms=spread.rms,
        horizontal_max_p95=spread.p95,
        horizontal_max_worst=spread.worst,
        coverage_95=scores.coverage,
        rmse_open=scores.aided.horizontal_rmse,
        coverage_open_95=scores.aided.coverage,
        each=tuple(map(_outage, scores.outages)),
    )


def outage_columns() -> dict[str, type]:
    """Columns of an outage: `length` [s] and the fields of `OutageScore`, headings in degrees.

    Returns
    -------
    dict of str to type
        `heading_max` reads `heading_deg_max`; labels are one text, joined by "; ".
    """
    hints = get_type_hints(OutageScore)
    kinds = {f.name: hints[f.name] for f in fields(OutageScore) if hints[f.name] in _SCALARS}
    return {"length": float} | {
        _column(name): str if k == tuple[str, ...] else k for name, k in kinds.items()
    }


def _column(name: str) -> str:
    return name.replace(_HEADING, f"{_HEADING}deg_", 1) if name.startswith(_HEADING) else name


def _outage(one: OutageScore) -> dict[str, Any]:
    told: dict[str, Any] = {"length": one.end - one.start}
    for f in fields(one):
        value: Any = getattr(one, f.name)
        value = "; ".join(value) if isinstance(value, tuple) else value
        told[_column(f.name)] = value / DEG if f.name.startswith(_HEADING) else value
    return {name: told[name] for name in outage_columns()}
