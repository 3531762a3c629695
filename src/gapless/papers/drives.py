"""A paper's simulated drive: made, navigated with every method, and scored."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gapless.evaluation import score
from gapless.papers.jobs import BROKEN, Job, Outcome, Track, keep, navigate, told
from gapless.papers.model import Drive, Method
from gapless.papers.start import fuse_from
from gapless.sensors import grade
from gapless.simulate import simulate, spikes
from gapless.systems.recipe import System
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Recording
from gapless.trip.solution import Solution


def make(drive: Drive, seed: int) -> Recording:
    """A drive of an experiment.

    Parameters
    ----------
    drive : Drive
    seed : int
        Everything that is drawn follows from it.

    Returns
    -------
    Recording
    """
    of_path, of_faults = (np.random.default_rng([seed, k]) for k in (2, 3))
    segments = drive.segments if isinstance(drive.segments, str) else drive.segments(of_path)
    made = simulate(
        segments,
        replace(grade(drive.grade), rate=drive.rate),
        drive.duration,
        seed,
        receiver=drive.receiver,
        origin=drive.origin,
        heading=drive.heading,
    )
    gnss = made.gnss
    for fault in drive.faults:
        gnss, _ = spikes(gnss, of_faults, fault.count, fault.position, fault.velocity)
    return replace(made, name=f"seed {seed}", gnss=gnss)


def execute(job: Job) -> Outcome:
    """Navigate a drive with every method, and score.

    Parameters
    ----------
    job : Job

    Returns
    -------
    Outcome
    """
    drive = job.experiment.drive
    assert drive is not None
    recording = make(drive, job.seed)
    outcome = Outcome()
    for method, system in job.ready:
        try:
            solution = _navigate(method, system, recording, drive, job.seed)
        except BROKEN as error:
            outcome.failed[method.name] = told(error)
            continue
        scores = score(solution, recording)
        keep(outcome, job, method, recording, scores, drive.windows)
    if job.shown:
        outcome.tracks.append(_track(job.experiment.name, recording))
    return outcome


def _navigate(method: Method, system: System, recording: Recording, drive: Drive, seed: int) -> Solution:
    blind = replace(recording, reference=None)
    if drive.start is not None:
        return fuse_from(blind, recording, system, drive.outages, drive.start.error, seed)
    return navigate(method, system, blind, drive.outages)


def _track(experiment: str, recording: Recording) -> Track:
    rows = recording.reference
    assert rows is not None
    ned = offset_ned(rows.lla, np.broadcast_to(rows.lla[0], rows.lla.shape))
    return Track(experiment, rows.time - recording.start, ned[:, [1, 0]], rows.v_n[:, [1, 0]])
