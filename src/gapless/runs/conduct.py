"""What a recording is folded into: a navigator, or one that rehearses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from msgspec import structs

from gapless.errors import ConfigError
from gapless.fold.manner import Manner
from gapless.fold.navigator import Navigator
from gapless.fold.settings import Settings
from gapless.rehearsal.stage import Plan, Rehearsing
from gapless.runs.decide import Decided
from gapless.systems.adjust import changed
from gapless.systems.build import candidates, settings
from gapless.systems.recipe import System
from gapless.trip.recording import Recording

Folding = Navigator | Rehearsing
"""What events are folded into."""
Finish = Callable[[Settings], Settings]
"""Changes what a navigator is built from."""
FIXED = ("layout", "tick", "period", "row", "lateness", "memory", "wander_time", "open_loop", "cubature")
"""Settings that no preset changes."""


def as_built(settings: Settings) -> Settings:
    """Change nothing; see `Finish`.

    Parameters
    ----------
    settings : Settings

    Returns
    -------
    Settings
    """
    return settings


def settings_for(
    recording: Recording, system: System, decided: Decided, rate: float, lateness: float = 0.0
) -> Settings:
    """Settings of the navigator of a run.

    Parameters
    ----------
    recording : Recording
    system : System
    decided : Decided
    rate : float
        Rows per second.
    lateness : float
        For how long past states are kept at least [s].

    Returns
    -------
    Settings
    """
    system = decided.used(system)
    use = system.gnss
    share = use.wander if decided.wander is None else decided.wander
    use = structs.replace(use, jitter=max(use.jitter, decided.jitter), wander=share)
    built = settings(
        structs.replace(system, gnss=use),
        recording,
        decided.offsets,
        decided.mounting,
        decided.gyro_density,
        1.0 / rate,
        decided.doubt,
    )
    arm_doubt = built.arm_doubt if decided.arm is None else decided.arm.doubt
    return replace(built, lateness=max(built.lateness, lateness), arm_doubt=arm_doubt)


def navigator_for(
    recording: Recording,
    system: System,
    decided: Decided,
    rate: float,
    lateness: float = 0.0,
    finish: Finish = as_built,
) -> Folding:
    """The navigator of a run, and where the recipe asks for it one that rehearses.

    Parameters
    ----------
    recording : Recording
    system : System
    decided : Decided
    rate : float
        Rows per second.
    lateness : float
        For how long past states are kept at least [s].
    finish : callable
        Has the last word on the navigator's settings.

    Returns
    -------
    Navigator or Rehearsing

    Raises
    ------
    ConfigError
        If a preset changes what a navigator cannot change on its way.
    """
    use = system.rehearsal
    built = finish(settings_for(recording, system, decided, rate, lateness))
    if not use.every:
        return Navigator(built)
    own = () if system.bridge.model == "none" else (system.bridge.model,)
    names = (*own, *(other.name for other in candidates(system)))
    bridges: dict[str, tuple[int, ...]] = {name: (k,) for k, name in enumerate(names)}
    if own:
        bridges |= {f"{own[0]}+{name}": (0, k) for k, name in enumerate(names) if k}
    presets = {}
    for name, keys in use.presets.items():
        where = f"rehearsal.presets.{name}"
        other = settings_for(recording, changed(system, keys, where), decided, rate, lateness)
        presets[name] = _manner(where, built, other)
    return Rehearsing(Navigator(built), Plan(bridges, presets, use.every, use.length, use.budget))


def _manner(where: str, built: Settings, other: Settings) -> Manner:
    for key in FIXED:
        if getattr(other, key) != getattr(built, key):
            raise ConfigError(f"{where} changes {key}; a preset may tune noise and constraints only")
    if list(other.constraints) != list(built.constraints):
        raise ConfigError(f"{where} takes a constraint out or in; a preset may tune them only")
    return other.manner
