"""Figures as the papers have them; needs matplotlib."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from io import BytesIO
from typing import Any, Final

from gapless.papers.experiment import Reproduction, Results
from gapless.papers.jobs import Curve, Track
from gapless.papers.studies import Convergence, Fitness, Signals
from gapless.reports.bench.figures import MADE_BY, figure_class

_COLOURS: Final = ("#4b545c", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#0072b2", "#a6761d")
_DASHES: Final = ("-", "--", ":", "-.")
_SIZE: Final = (7.2, 4.6)
_DPI: Final = 150
_SHOWN: Final = 10.0
"""Length of a stretch of signals [s]."""
_CAPTIONS: Final = {
    "errors": "east and north errors of position and velocity through the outage, first drive",
    "motion": "speeds and track of the first drive",
    "convergence": "misfit on the training data by number of nodes, in deviations of the target",
    "denoised": "ten seconds of the six channels, raw and after EMD-CIIT of the whole stretch",
    "fitness": "best (thick) and mean (thin) RMS of cross-validation by generation, stop rule off",
}
"""By the first word of a figure's name."""

Draw = Callable[[Any], None]


def caption(name: str) -> str:
    """What a figure shows.

    Parameters
    ----------
    name : str
        "errors-simulation-1-50-s".

    Returns
    -------
    str
    """
    kind, _, rest = name.partition("-")
    return f"{rest.replace('-', ' ')}: {_CAPTIONS[kind]}" if rest else _CAPTIONS[kind]


def is_named(name: str) -> bool:
    """Whether a figure of a reproduction may have this name.

    Parameters
    ----------
    name : str

    Returns
    -------
    bool
    """
    return name.partition("-")[0] in _CAPTIONS


def figures(done: Reproduction) -> dict[str, bytes]:
    """All figures of a reproduction.

    Parameters
    ----------
    done : Reproduction

    Returns
    -------
    dict of str to bytes
        PNG by name.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    """
    make = figure_class()
    found = {}
    for name, draw in _plans(done):
        figure = make(figsize=_SIZE, layout="constrained")
        draw(figure)
        held = BytesIO()
        figure.savefig(held, format="png", dpi=_DPI, metadata=MADE_BY["png"])
        found[re.sub("[^a-zA-Z0-9._]+", "-", name).strip("-")] = held.getvalue()
    return found


def _plans(done: Reproduction) -> Iterator[tuple[str, Draw]]:
    """Name of each figure, and what draws it."""
    for results in done.results:
        if results.experiment.aside:
            continue
        for track in results.tracks:
            yield f"motion-{results.experiment.name}", partial(_motion, track)
        for where in dict.fromkeys(curve.where for curve in results.curves):
            yield f"errors-{results.experiment.name}-{where}", partial(_errors, results, where)

    for name, study in done.studies.items():
        yield name, partial(_DRAWN[type(study)], study)


def _converging(study: Convergence, figure: Any) -> None:
    axes = figure.add_subplot()
    for k, (name, misfit) in enumerate(study.misfit.items()):
        axes.semilogy(study.nodes, misfit, label=name, linewidth=1.3, **_style(k))
    _finish(axes, "hidden nodes", "RMSE / standard deviation")
    axes.legend(fontsize=8, frameon=False)


def _fitter(study: Fitness, figure: Any) -> None:
    panels = figure.subplots(1, len(study.history), squeeze=False)[0]
    for panel, (axis, history) in zip(panels, study.history.items(), strict=True):
        generations = range(1, len(history) + 1)
        panel.semilogy(generations, history[:, 0], color=_COLOURS[1], linewidth=1.8)
        panel.semilogy(generations, history[:, 1], color=_COLOURS[0], linewidth=0.8)
        _finish(panel, "generation", f"RMS {axis} [m]")


def _denoised(study: Signals, figure: Any) -> None:
    panels = figure.subplots(3, 2, sharex=True)
    middle = 0.5 * (study.time[0] + study.time[-1])
    shown = (study.time >= middle) & (study.time < middle + _SHOWN)
    for k, panel in enumerate(panels.T.ravel()):
        panel.plot(study.time[shown], study.raw[k, shown], color=_COLOURS[5], linewidth=0.5)
        panel.plot(study.time[shown], study.denoised[k, shown], color=_COLOURS[1], linewidth=1.2)
        what = ("f_x", "f_y", "f_z", "w_x", "w_y", "w_z")[k]
        _finish(panel, "time [s]" if k % 3 == 2 else "", f"{what} [{'m/s²' if k < 3 else 'rad/s'}]")


_DRAWN: Final[dict[type, Callable[[Any, Any], None]]] = {
    Convergence: _converging,
    Fitness: _fitter,
    Signals: _denoised,
}
"""What draws each kind of study."""


def _errors(results: Results, where: str, figure: Any) -> None:
    """Position above, velocity below; east left, north right."""
    panels = figure.subplots(2, 2, sharex=True)
    chosen = [curve for curve in results.curves if curve.where == where]
    for k, curve in enumerate(chosen):
        for (row, series), column in ((a, b) for a in _series(curve) for b in (0, 1)):
            panels[row][column].plot(
                curve.age, series[:, 1 - column], label=curve.method, linewidth=1.1, **_style(k)
            )
    for row, what in ((0, "position error [m]"), (1, "velocity error [m/s]")):
        for column, axis in enumerate(("east", "north")):
            _finish(panels[row][column], "age of the outage [s]" if row else "", f"{axis} {what}")
    figure.legend(*panels[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=7,
                  frameon=False)  # fmt: skip


def _series(curve: Curve) -> tuple[tuple[int, Any], tuple[int, Any]]:
    return (0, curve.position), (1, curve.velocity)


def _motion(track: Track, figure: Any) -> None:
    speeds, plan = figure.subplots(1, 2)
    for k, axis in enumerate(("east", "north")):
        speeds.plot(track.time, track.velocity[:, k], label=axis, linewidth=1.1, **_style(k))
    _finish(speeds, "time [s]", "velocity [m/s]")
    speeds.legend(fontsize=7, frameon=False)
    plan.plot(*(track.east_north.T / 1000.0), color=_COLOURS[0], linewidth=1.1)
    plan.set_aspect("equal", adjustable="datalim")
    _finish(plan, "east [km]", "north [km]")


def _style(k: int) -> dict[str, Any]:
    return {"color": _COLOURS[k % len(_COLOURS)], "linestyle": _DASHES[k % len(_DASHES)]}


def _finish(axes: Any, x: str, y: str) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.grid(alpha=0.25, linewidth=0.5)
