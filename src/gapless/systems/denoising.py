"""The denoiser of a recipe."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING

from gapless.errors import ConfigError, registered_elsewhere
from gapless.systems.recipe import DenoiseUse, System

if TYPE_CHECKING:
    from gapless.denoise import Denoiser


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
