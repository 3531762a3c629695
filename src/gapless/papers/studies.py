"""What papers show beside their drives: signals denoised, learners converging, a search getting fitter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from gapless.evaluation import score
from gapless.evaluation.statistics import rms
from gapless.papers.drives import make
from gapless.papers.jobs import navigate, prepare
from gapless.papers.model import Experiment, Method
from gapless.scenarios import Outage
from gapless.trip.recording import Array, Imu, Recording

FROM, UNTIL = 400.0, 900.0
"""The stretch of a drive that is denoised [s]: that of liu2019, Figure 6."""
NODES: Final = (2, 4, 6, 8, 10, 12, 15, 20, 25, 30, 40)
"""Sizes of the networks that are compared."""
GENERATIONS: Final = 30
"""Of the genetic search that is shown; the paper's ended after 57, 35 and 9 in its first test."""


class Signals(NamedTuple):
    """Signals before and after denoising.

    Parameters
    ----------
    time : ndarray, shape (n,)
        [s]
    raw, denoised : ndarray, shape (6, n)
        f_x, f_y, f_z [m/s^2], w_x, w_y, w_z [rad/s].
    ratios : dict of str to tuple of 6 floats
        Signal-to-noise ratio by row of Table 2 [dB].
    """

    time: Array
    raw: Array
    denoised: Array
    ratios: dict[str, tuple[float, ...]]


class Convergence(NamedTuple):
    """Misfit on the training data against the size of a network.

    Parameters
    ----------
    nodes : tuple of int
    misfit : dict of str to tuple of float
        By learner: RMSE over the standard deviation of the target, mean over the targets.
    """

    nodes: tuple[int, ...]
    misfit: dict[str, tuple[float, ...]]


class Fitness(NamedTuple):
    """A genetic search by generation.

    Parameters
    ----------
    history : dict of str to ndarray, shape (generations, 2)
        By output: best and mean RMS of cross-validation [m].
    """

    history: dict[str, Array]


Study = Signals | Convergence | Fitness


def signals(experiment: Experiment) -> Signals:
    """Noise of liu2019's sensors, removed from the whole of a stretch by its two competitors.

    Parameters
    ----------
    experiment : Experiment

    Returns
    -------
    Signals

    Raises
    ------
    MissingExtraError
        If PyWavelets is not installed.
    """
    from gapless.denoise import DENOISERS, denoised
    from gapless.denoise.compare import compare

    assert experiment.drive is not None
    measured = make(experiment.drive, 1).imu.slice(FROM, UNTIL)
    truth = make(replace(experiment.drive, grade="perfect"), 1).imu.slice(FROM, UNTIL)
    chosen = {"wavelet": DENOISERS["wavelet"](), "EMD": DENOISERS["emd-ciit"]()}
    ratios = {row.name: row.snr for row in compare(truth, measured, chosen)}
    clean = denoised(measured, chosen["EMD"])
    return Signals(measured.time, _channels(measured), _channels(clean), ratios)


def _channels(imu: Imu) -> Array:
    return np.vstack([imu.dvel.T, imu.dtheta.T]) / imu.dt


def convergence(experiment: Experiment) -> Convergence:
    """ELM and Fourier ELM on the error of an INS that runs free from 100 to 350 s, by number of nodes.

    The paper's abscissa is the number of trainings, which an ELM, solved at once, does not have.

    Parameters
    ----------
    experiment : Experiment

    Returns
    -------
    Convergence

    Raises
    ------
    MissingExtraError
        If scikit-learn is not installed.
    """
    from gapless.learners import make as learner

    assert experiment.drive is not None
    x, y = _free_running(experiment, make(experiment.drive, 1), 100.0, 350.0)
    found: dict[str, tuple[float, ...]] = {}
    for title, name in (("ELM", "elm"), ("IELM", "fourier_elm")):
        fits = (learner(name, {"n_nodes": n}, seed=0).fit(x, y).predict(x) - y for n in NODES)
        found[title] = tuple(float(np.mean([rms(e) for e in (m / y.std(axis=0)).T])) for m in fits)
    return Convergence(NODES, found)


def _free_running(
    experiment: Experiment, recording: Recording, begin: float, end: float
) -> tuple[Array, Array]:
    """Heading, velocity and position of an INS without corrections, and its errors, once a second."""
    ((method, system),), _ = prepare(replace(experiment, methods=(Method("INS", "ins"),)))
    blind = replace(recording, reference=None)
    solution = navigate(method, system, blind, (Outage(begin, end),))
    errors = score(solution, recording).errors.slice(recording.start + begin, recording.start + end)
    at = np.searchsorted(solution.trajectory.time, errors.time[::10])
    rows = solution.trajectory.take(np.minimum(at, len(solution.trajectory) - 1))
    heading = rows.euler[:, 2]
    x = np.column_stack([np.sin(heading), np.cos(heading), rows.v_n[:, :2], rows.lla[:, :2]])
    y = np.column_stack([errors.velocity[::10, :2], errors.position[::10, :2]])
    return x, y


def fitness(experiment: Experiment) -> Fitness:
    """GA-SVR on position increments of a training stretch, the stop rule off: it would end at the second one.

    Parameters
    ----------
    experiment : Experiment

    Returns
    -------
    Fitness

    Raises
    ------
    MissingExtraError
        If scikit-learn is not installed.
    """
    from gapless.learners import make as learner

    drive = experiment.drive
    assert drive is not None
    stretch = next(w for w in drive.windows if not w.withheld)
    x, y = _increments(make(drive, 1), stretch.start, stretch.end)
    fitted: Any = learner("ga_svr", {"tolerance": None, "generations": GENERATIONS}, seed=0).fit(x, y)
    half = 0.5 * np.ptp(y, axis=0)  # targets are learned in [-1, 1]
    history = fitted.regressor_.history_
    return Fitness(
        {axis: np.asarray(h) * s for axis, h, s in zip(("north", "east", "down"), history, half, strict=True)}
    )


def _increments(recording: Recording, begin: float, end: float) -> tuple[Array, Array]:
    """Integrated force and rate over each GNSS epoch, and how far the fixes went."""
    from gapless.trip.motion import offset_ned

    fixes = recording.gnss.slice(recording.start + begin, recording.start + end)
    imu, steps = recording.imu, np.searchsorted(recording.imu.time, fixes.time + 1e-6)
    sums = np.vstack([np.zeros(6), np.cumsum(np.column_stack([imu.dvel, imu.dtheta]), axis=0)])
    return np.diff(sums[steps], axis=0), offset_ned(fixes.lla[1:], fixes.lla[:-1])


STUDIES: Final[dict[str, Callable[[Experiment], Study]]] = {
    "convergence": convergence,
    "denoised": signals,
    "fitness": fitness,
}
"""By the names that a `Paper` lists."""
