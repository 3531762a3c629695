"""Recipes from files and by name: read, completed from the one that they are like, and checked."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, TypeVar, get_args

import msgspec
from msgspec import Struct
from msgspec.structs import fields

from gapless.errors import ConfigError
from gapless.filters.adaptation.registry import KINDS
from gapless.filters.adaptation.registry import check as check_rules
from gapless.inertial.layout import EXTRAS
from gapless.systems.denoising import denoiser
from gapless.systems.learning import check as check_bridge
from gapless.systems.learning import check_learner
from gapless.systems.recipe import System

T = TypeVar("T", bound=Struct)
LIKE: Final = "like"
"""Key that names the built-in recipe of which a file says only what is different."""


def parse(text: str, where: str) -> System:
    """A system from the text of a TOML file.

    Parameters
    ----------
    text : str
    where : str
        What to call it in an error.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    return checked(_complete(loads(text, where), where), where)


def loads(text: str, where: str) -> dict[str, Any]:
    """Tables of a TOML text.

    Parameters
    ----------
    text : str
    where : str
        What to call it in an error.

    Returns
    -------
    dict

    Raises
    ------
    ConfigError
        If it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{where}: not valid TOML: {error}") from None


def checked(tables: Mapping[str, Any], where: str) -> System:
    """A system from the tables of its TOML.

    Parameters
    ----------
    tables : mapping
    where : str
        What to call it in an error.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    system = typed(tables, System, where)
    try:
        _check(system)
    except ConfigError as error:
        raise ConfigError(f"{where}: {error}") from None
    return system


def _check(system: System) -> None:
    """See that the parts of a system go together."""
    unknown = [name for name in system.filter.states if name not in EXTRAS]
    if len(set(system.filter.states)) < len(system.filter.states):
        raise ConfigError("filter.states names a block twice; name each once")
    if unknown:
        raise ConfigError(f"filter.states has {unknown[0]!r}; choose from {', '.join(EXTRAS)}")
    if system.filter.moments == "cubature" and system.filter.correction == "feedforward":
        raise ConfigError(
            "filter.moments = 'cubature' needs filter.correction = 'feedback': "
            "its points surround a nominal state that is corrected"
        )
    for kind in KINDS:
        check_rules(kind, getattr(system.adaptation, kind))
    check_bridge(system.bridge)
    check_learner(system.bridge, system.learner)
    denoiser(system.denoise)


def typed(tables: Mapping[str, Any], kind: type[T], where: str) -> T:
    """Tables of a TOML file as the struct that they should be.

    Parameters
    ----------
    tables : mapping
    kind : type of msgspec.Struct
    where : str
        What to call the file in an error.

    Returns
    -------
    msgspec.Struct
        Of that kind.

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    try:
        return msgspec.convert(tables, kind)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{where}: {_explain(str(error), kind)}") from None


def _explain(message: str, kind: type[Struct]) -> str:
    """Msgspec's message with a dotted path, and the keys that there are where one is unknown."""
    text, _, place = message.partition(" - at `")
    path = place.rstrip("`").removeprefix("$").lstrip(".")
    if "unknown field" in text:
        for part in re.findall(r"\w+", re.sub(r"\[.*?\]", "", path)):
            kind = next((_struct(f.type) or kind for f in fields(kind) if f.encode_name == part), kind)
        return f"{text} in {path or 'the top table'}; it may hold: {', '.join(kind.__struct_fields__)}"
    return f"{path}: {text}" if path else text


def _struct(kind: Any) -> type[Struct] | None:
    """The struct in a type such as `Struct | tuple[Struct, ...] | None`."""
    if isinstance(kind, type) and issubclass(kind, Struct):
        return kind
    return next((found for part in get_args(kind) if (found := _struct(part))), None)


def load(name: str | Path) -> System:
    """A system by its built-in name or from a TOML file.

    Parameters
    ----------
    name : str or Path

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If there is neither, or the file is wrong.
    """
    path = Path(name)
    if path.suffix == ".toml":
        try:
            return parse(path.read_text(encoding="utf-8"), str(path))
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: cannot be read ({error}); give a TOML file") from None
    return parse(source(str(name)), f"{name}.toml")


def source(name: str) -> str:
    """The text of a built-in recipe.

    Parameters
    ----------
    name : str

    Returns
    -------
    str
        TOML.

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    found = files("gapless.systems").joinpath("recipes", f"{name}.toml")
    if name not in names():
        raise ConfigError(
            f"system {name!r} is unknown; choose from {', '.join(names())} or give a .toml file"
        )
    return found.read_text(encoding="utf-8")


def _complete(tables: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Tables with what they leave out taken from the built-in recipe that they are like."""
    own = dict(tables)
    base = own.pop(LIKE, None)
    if base is None:
        return own
    if base not in names():
        raise ConfigError(f"{where}: {LIKE}: no system {base!r}; choose from {', '.join(names())}")
    if f"{base}.toml" == where:
        raise ConfigError(f"{where}: {LIKE}: a recipe cannot be like itself")
    return _merged(_complete(loads(source(base), f"{base}.toml"), f"{base}.toml"), own)


def _merged(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Tables within tables, key by key; a learner's parameters go with the learner that is named."""
    merged = dict(base)
    for key, value in own.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict) and "name" not in value:
            merged[key] = _merged(base[key], value)
        else:
            merged[key] = value
    return merged


def names() -> list[str]:
    """Names of the built-in systems.

    Returns
    -------
    list of str
    """
    folder = files("gapless.systems").joinpath("recipes").iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in folder if entry.name.endswith(".toml"))
