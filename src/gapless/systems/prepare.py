"""A recording as a recipe navigates it: its inertial signals denoised, where the recipe says so."""

from __future__ import annotations

import inspect
from dataclasses import replace
from typing import TYPE_CHECKING

from gapless.errors import ConfigError, registered_elsewhere
from gapless.systems.recipe import DenoiseUse, System
from gapless.trip.recording import Imu, Recording
from gapless.trip.solution import Decision

if TYPE_CHECKING:
    from gapless.denoise import Denoiser


_done: dict[tuple[int, str, int, int, str], tuple[Imu, Imu]] = {}
_MOST = 3


def prepared(recording: Recording, system: System) -> Recording:
    """The recording that a system navigates.

    Parameters
    ----------
    recording : Recording
    system : System

    Returns
    -------
    Recording
        The same one where the recipe does not denoise.

    Raises
    ------
    ConfigError
        If there is no such denoiser, or what it needs is not installed.
    """
    made = denoiser(system.denoise)
    if made is None:
        return recording
    from gapless.denoise import denoised

    key = (id(recording.imu), (use := system.denoise).method, use.window, use.step, repr(use.parameters))
    if key not in _done:  # the raw one is kept too, or its id could come again
        while len(_done) >= _MOST:
            del _done[next(iter(_done))]
        _done[key] = (recording.imu, denoised(recording.imu, made))
    return replace(recording, imu=_done[key][1])


def denoiser(use: DenoiseUse) -> Denoiser | None:
    """The denoiser of a recipe.

    Parameters
    ----------
    use : DenoiseUse

    Returns
    -------
    Denoiser or None

    Raises
    ------
    ConfigError
        If there is no such denoiser, it has no such parameter, or what it needs is not installed.
    """
    if use.method == "none":
        return None
    from gapless.denoise import DENOISERS, Windowed

    if use.method not in DENOISERS:
        raise ConfigError(
            f"denoise.method: {use.method!r} is unknown; choose from none, {', '.join(DENOISERS)}"
            f"{registered_elsewhere()}"
        )
    kind = DENOISERS[use.method]
    known = list(inspect.signature(kind).parameters)
    for name in use.parameters:
        if name not in known:
            raise ConfigError(f"denoise.parameters: {use.method} has no {name!r}; it has {', '.join(known)}")
    inner = kind(**use.parameters)
    return Windowed(inner, use.window, use.step) if use.window else inner


def sees_the_future(system: System) -> bool:
    """Whether a system's denoising makes its solution no real-time result.

    Parameters
    ----------
    system : System

    Returns
    -------
    bool
    """
    return system.denoise.method != "none" and not system.denoise.window


def denoise_decisions(system: System) -> tuple[Decision, ...]:
    """What was done to the inertial signals, as a solution states it.

    Parameters
    ----------
    system : System

    Returns
    -------
    tuple of Decision
        None or one.
    """
    made = denoiser(system.denoise)
    return () if made is None else (Decision("denoising", made.name, "", "user", made.text),)
