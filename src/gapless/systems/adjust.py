"""Small changes to a recipe, checked as its TOML would be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, get_args

import msgspec
from msgspec.structs import replace

from gapless.errors import ConfigError
from gapless.systems.learning import BridgeUse
from gapless.systems.library import checked, load, names
from gapless.systems.recipe import Clock, DenoiseUse, System
from gapless.systems.values import Offset

PARTS: Final = {"bridge": BridgeUse(), "denoise": DenoiseUse()}
"""Parts that a system can do without, and what is left then."""


ADDED: Final[dict[str, dict[str, Any]]] = {
    "constraints": {"constraints": System().constraints},
    "calibrated": {"bridge.noise": "calibrated"},
}
"""What can be added to a system by name, and the keys that it changes."""


def has(system: System, part: str) -> bool:
    """Whether a system has a bridge, or denoises.

    Parameters
    ----------
    system : System
    part : str
        "bridge" or "denoise".

    Returns
    -------
    bool
    """
    return system.bridge.model != "none" if part == "bridge" else system.denoise.method != "none"


def named(text: str) -> System:
    """A system by name, with parts taken out or the constraints put in.

    Parameters
    ----------
    text : str
        A built-in name or a TOML file; then any of "-NAME", as for `without`, and of `ADDED`:
        "wang2018-bridge" is its filter alone, "wang2018+constraints" what it does for a filter that
        knows what every car obeys, "wang2018+calibrated" what with a noise from held-out epochs.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If there is no such recipe or part.
    """
    out: list[str] = []
    base, *added = text.split("+")
    while base not in names():
        shorter, dash, last = base.rpartition("-")
        if not dash or last not in (*_choices("constraints"), *_choices("sensors"), *PARTS):
            break
        base, out = shorter, [last, *out]
    system = load(base)
    for name in out:
        system = replace(without(system, name), name=f"{system.name}-{name}")
    for name in added:
        if name not in ADDED:
            raise ConfigError(f"{text}: there is no {name!r} to add; choose from {', '.join(ADDED)}")
        system = replace(changed(system, ADDED[name], text), name=f"{system.name}+{name}")
    return system


def without(system: System, *names: str) -> System:
    """A system that does without some of its constraints or sensors.

    Parameters
    ----------
    system : System
    *names : str
        "zero_velocity", "nonholonomic", "position", "velocity", "odometer", "bridge" or "denoise"; one
        that the system does not use anyway changes nothing.

    Returns
    -------
    System
        Of the same name, with "without ..." behind it where something was taken out.

    Raises
    ------
    ConfigError
        If a name is none of these.
    """
    known = (*_choices("constraints"), *_choices("sensors"), *PARTS)
    for name in names:
        if name not in known:
            raise ConfigError(f"there is no {name!r} to do without; choose from {', '.join(known)}")
    used = (*system.constraints, *system.sensors, *(name for name in PARTS if has(system, name)))
    out = [name for name in dict.fromkeys(names) if name in used]
    if not out:
        return system
    gone = {name: PARTS[name] for name in out if name in PARTS}
    return replace(
        system,
        **gone,
        name=f"{system.name} without {', '.join(out)}",
        constraints=tuple(name for name in system.constraints if name not in out),
        sensors=tuple(name for name in system.sensors if name not in out),
    )


def changed(system: System, keys: Mapping[str, Any], where: str) -> System:
    """A system with other values for some keys of its recipe.

    Parameters
    ----------
    system : System
    keys : mapping of str to object
        New values by dotted key, such as "nonholonomic.lateral".
    where : str
        What to call the place that names them in an error.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If there is no such key or the recipe could not have that value.
    """
    tables = msgspec.to_builtins(system)
    for key, value in keys.items():
        *path, last = key.split(".")
        table: Any = tables
        for part in path:
            table = table.get(part) if isinstance(table, dict) else None
        if not isinstance(table, dict):
            named = ", ".join(name for name, value in tables.items() if isinstance(value, dict))
            raise ConfigError(f"{where}: a recipe has no {key!r}; its tables are {named}")
        table[last] = value
    return checked(tables, where)


def with_clock(system: System, channel: str, offset: float) -> System:
    """A system that is told a clock offset instead of finding it.

    Parameters
    ----------
    system : System
    channel : str
        "position", "velocity" or "odometer".
    offset : float
        What must be added to the sensor's stamps to land on the IMU clock [s].

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If there is no such channel, or the offset is beyond what a recipe may say.
    """
    channels = Clock.__struct_fields__
    if channel not in channels:
        raise ConfigError(f"{channel!r} has no clock; choose from {', '.join(channels)}")
    try:
        told = msgspec.convert(offset, Offset)
    except msgspec.ValidationError as error:
        raise ConfigError(f"clock offset of {channel}, {offset:g} s: {error}") from None
    return replace(system, clock=replace(system.clock, **{channel: told}))


def _choices(field: str) -> tuple[str, ...]:
    """The words that a field of a recipe may list."""
    (kind,) = (f.type for f in msgspec.structs.fields(System) if f.name == field)
    words: tuple[str, ...] = get_args(get_args(kind)[0])
    return words
