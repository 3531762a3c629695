"""A paper's road test on real recordings: its methods, outages of its lengths all along each recording."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from gapless.evaluation import score
from gapless.laboratory.study import ladder
from gapless.papers.jobs import BROKEN, Job, Outcome, Ready, keep, navigate, told
from gapless.papers.model import Window
from gapless.scenarios import Outage
from gapless.trip.motion import first_motion
from gapless.trip.recording import Recording

BETWEEN: Final = 180.0
"""From the end of an outage to the start of the next [s]: time to settle, and to learn."""
FIRST: Final = 240.0
"""Start of the first outage [s]."""
SHIFTS: Final = 3
"""Runs of each length, the outages moved on in each."""
SETTLED: Final = 60.0
"""GNSS on is scored from so long after the first motion [s]."""


def execute(job: Job) -> Outcome:
    """Navigate a recording with every method, and score.

    Parameters
    ----------
    job : Job
        With a source.

    Returns
    -------
    Outcome

    Raises
    ------
    GaplessError
        If the recording cannot be read.
    """
    assert job.source is not None
    recording, outcome = job.source.open(), Outcome()
    for ready in job.ready:
        try:
            _one(outcome, job, ready, recording)
        except BROKEN as error:
            outcome.failed[ready.method.name] = told(error)
    return outcome


def planned(window: Window, recording: Recording) -> list[tuple[Outage, ...]]:
    """Outages of a length all along a recording, a set for each run.

    Parameters
    ----------
    window : Window
        Its length counts.
    recording : Recording

    Returns
    -------
    list of tuple of Outage
        None where none fits.
    """
    length = window.end - window.start
    every = length + BETWEEN
    shifts = [k * round(every / SHIFTS) for k in range(SHIFTS)]
    plans = (s.outages(recording) for s in ladder([length], every, shifts, FIRST))
    return [found for found in plans if found]


def _one(outcome: Outcome, job: Job, ready: Ready, recording: Recording) -> None:
    method, system = ready
    blind = replace(recording, reference=None)
    for window in job.experiment.road:
        if not window.withheld:
            if recording.reference is not None:
                whole = score(navigate(method, system, blind, ()), recording)
                begin = first_motion(recording) - recording.start + SETTLED
                keep(
                    outcome,
                    job,
                    method,
                    recording,
                    whole,
                    (window._replace(start=begin, end=recording.duration),),
                )
            continue
        for k, outages in enumerate(planned(window, recording)):
            scores = score(navigate(method, system, blind, outages), recording)
            at = tuple(window._replace(start=o.start, end=o.end) for o in outages)
            shown = replace(job, shown=job.shown and k == 0)
            keep(outcome, shown, method, recording, scores, at[:1])
            keep(outcome, replace(job, shown=False), method, recording, scores, at[1:])
