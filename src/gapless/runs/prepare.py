"""A recording as a recipe navigates it: its inertial signals denoised, where the recipe says so."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from msgspec import structs

from gapless.errors import ConfigError
from gapless.scenarios import Outage, withhold
from gapless.sensors import grade_names
from gapless.systems.denoising import denoiser
from gapless.systems.recipe import System
from gapless.trip.recording import Imu, Recording

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


def graded(system: System, recording: Recording) -> System:
    """A system that knows the sensor's grade where the recording states it and the recipe does not.

    Parameters
    ----------
    system : System
    recording : Recording

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If the recording states a grade that is not known.
    """
    if system.imu.grade or recording.grade is None:
        return system
    if recording.grade not in grade_names():
        raise ConfigError(
            f"{recording.name}: no sensor grade {recording.grade!r}; "
            f"state one of {', '.join(grade_names())}, or none"
        )
    return structs.replace(system, imu=structs.replace(system.imu, grade=recording.grade))


def withhold_from(recording: Recording, outages: Iterable[Outage]) -> Recording:
    """The recording without the GNSS epochs of the outages.

    Parameters
    ----------
    recording : Recording
    outages : iterable of Outage

    Returns
    -------
    Recording
    """
    return replace(recording, gnss=withhold(recording.gnss, tuple(outages), recording.start))
