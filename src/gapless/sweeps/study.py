"""What a STUDY.toml may say, and the runs that this comes to."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain, product
from pathlib import Path
from typing import Annotated, Any, Final

import msgspec
from msgspec import Meta, Struct
from msgspec.structs import replace

from gapless.errors import ConfigError, GaplessError
from gapless.scenarios import parse as parse_scenario
from gapless.sensors import grade as named_grade
from gapless.simulate import profile as named_profile
from gapless.sweeps.run import Run
from gapless.sweeps.sources import Logged, Simulated, logged
from gapless.systems.adjust import changed, named
from gapless.systems.library import loads, typed
from gapless.systems.recipe import System
from gapless.systems.values import Positive

Name = Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")]
Seed = Annotated[int, Meta(ge=0, le=2**63 - 1)]
Texts = str | tuple[str, ...]
Drive = tuple[Simulated | Logged, int]
Method = tuple[System, dict[str, Any], bool]
SMOOTHED: Final = "smoothed"
"""The system that is "constraints", smoothed over the whole recording."""
PLAN: Final = "every=180,length=60,first=240"
"""Scenario of a study that names none."""


class Seeds(Struct, forbid_unknown_fields=True, frozen=True):
    """So many seeds in a row."""

    count: Annotated[int, Meta(ge=1)]
    first: Seed = 1


class Drives(Struct, forbid_unknown_fields=True, frozen=True):
    """Simulated drives: every profile with every grade and every seed."""

    profiles: tuple[str, ...] = ("urban",)
    grades: tuple[str, ...] = ("consumer",)
    seeds: Seeds | tuple[Seed, ...] = (1,)
    duration: Positive = 1800.0


class Single(Struct, forbid_unknown_fields=True, frozen=True):
    """One run, or one for each drive of `simulated`."""

    recording: Texts = ()
    simulated: Drives | None = None
    system: str = "constraints"
    scenario: Texts = PLAN
    override: dict[str, Any] = {}


class Study(Struct, forbid_unknown_fields=True, frozen=True):
    """A product of axes, and runs beside it; every table and every key is optional."""

    name: Name = "study"
    recordings: tuple[Texts, ...] = ()
    simulated: Drives | tuple[Drives, ...] = ()
    systems: tuple[str, ...] = ("constraints",)
    scenarios: tuple[Texts, ...] = (PLAN,)
    override: dict[str, Any] = {}
    runs: tuple[Single, ...] = ()


@dataclass(frozen=True)
class Block:
    """A product of axes; systems vary fastest, so that they share a recording that was read.

    Parameters
    ----------
    drives : tuple of (Simulated or Logged, int)
        Recordings with the seed that simulates them, 0 for a log.
    scenarios : tuple of tuple of str
    systems : tuple of (System, dict, bool)
        Recipes with what is changed in them, and whether they are smoothed.
    """

    drives: tuple[Drive, ...]
    scenarios: tuple[tuple[str, ...], ...]
    systems: tuple[Method, ...]

    def __len__(self) -> int:
        return len(self.drives) * len(self.scenarios) * len(self.systems)

    def __iter__(self) -> Iterator[Run]:
        axes = product(self.drives, self.scenarios, self.systems)
        for (source, seed), scenario, (system, override, smooth) in axes:
            yield Run(source, scenario, system, override, seed, smooth)


@dataclass(frozen=True)
class Plan:
    """The runs of a study, each made when it is its turn: a million of them take no memory.

    Parameters
    ----------
    name : str
    blocks : tuple of Block
    """

    name: str
    blocks: tuple[Block, ...]

    def __len__(self) -> int:
        return sum(map(len, self.blocks))

    def __iter__(self) -> Iterator[Run]:
        return chain.from_iterable(self.blocks)


def plan_study(path: str | os.PathLike[str]) -> Plan:
    """The runs that a study's file asks for.

    Parameters
    ----------
    path : str or path
        TOML; paths in it are seen from its folder, and its name is the study's if it gives none.

    Returns
    -------
    Plan

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices, or if it comes to no run.
    RecordingError
        If a recording is not there; one that cannot be read shows in its row.
    """
    path = Path(path)
    where = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read ({error}); give a TOML file") from None
    study = typed({"name": path.stem} | loads(text, where), Study, where)
    several = study.simulated if isinstance(study.simulated, tuple) else (study.simulated,)
    drives: list[Drive] = [pair for part in several for pair in _drives(part, f"{where}: simulated")]
    drives += [(_logged(_texts(r), path.parent, f"{where}: recordings"), 0) for r in study.recordings]
    variants = _combinations(_flat(study.override), f"{where}: override")
    systems = [
        pair for name in study.systems for pair in _systems(name, variants, path.parent, f"{where}: systems")
    ]
    scenarios = [_scenario(s, f"{where}: scenarios") for s in study.scenarios]
    block = Block(tuple(drives), tuple(scenarios), tuple(systems))
    singles = [_single(one, path.parent, f"{where}: runs[{k}]") for k, one in enumerate(study.runs)]
    plan = Plan(study.name, (block, *singles))
    if not len(plan):
        raise ConfigError(f"{where}: no runs; name recordings, [simulated] drives or [[runs]]")
    return plan


def _single(one: Single, folder: Path, where: str) -> Block:
    drives: list[Drive] = []
    if one.simulated:
        drives += _drives(one.simulated, f"{where}.simulated")
    if one.recording:
        drives.append((_logged(_texts(one.recording), folder, f"{where}.recording"), 0))
    if not drives:
        raise ConfigError(f"{where}: nothing to navigate; give a recording or simulated = {{...}}")
    systems = _systems(one.system, [_flat(one.override)], folder, where)
    return Block(tuple(drives), (_scenario(one.scenario, f"{where}.scenario"),), tuple(systems))


def _drives(part: Drives, where: str) -> Iterator[Drive]:
    with _at(where):
        for profile in part.profiles:
            named_profile(profile)
        for grade in part.grades:
            named_grade(grade)
    seeds = part.seeds
    chosen = range(seeds.first, seeds.first + seeds.count) if isinstance(seeds, Seeds) else seeds
    for profile, grade, seed in product(part.profiles, part.grades, chosen):
        yield Simulated(profile, grade, part.duration), seed


def _logged(paths: tuple[str, ...], folder: Path, where: str) -> Logged:
    with _at(where):
        return logged(*(path if "://" in path else str(folder / path) for path in paths))


def _scenario(texts: Texts, where: str) -> tuple[str, ...]:
    with _at(where):
        for text in _texts(texts):
            parse_scenario(text)
    return _texts(texts)


def _systems(name: str, variants: Iterable[dict[str, Any]], folder: Path, where: str) -> list[Method]:
    """A system with every override, whose values come out as the recipe's types have them."""
    smooth = name == SMOOTHED
    with _at(where):
        if smooth:
            system = replace(named("constraints"), name=SMOOTHED)
        else:
            system = named(str(folder / name) if name.endswith(".toml") else name)
    found = []
    for override in variants:
        tables = msgspec.to_builtins(changed(system, override, f"{where} with override"))
        found.append((system, {key: _value(tables, key) for key in override}, smooth))
    return found


def _value(tables: dict[str, Any], key: str) -> Any:
    value: Any = tables
    for part in key.split("."):
        value = value[part]
    return value


def _combinations(axes: dict[str, Any], where: str) -> list[dict[str, Any]]:
    for key, values in axes.items():
        if not isinstance(values, list) or not values:
            raise ConfigError(f"{where}.{key}: give a list of values to go through, such as [{values}]")
    return [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]


def _flat(tables: dict[str, Any], above: str = "") -> dict[str, Any]:
    """Keys with dots, whether TOML had them in quotes or made tables of them."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        flat |= _flat(value, f"{above}{key}.") if isinstance(value, dict) else {f"{above}{key}": value}
    return flat


def _texts(texts: Texts) -> tuple[str, ...]:
    return (texts,) if isinstance(texts, str) else texts


@contextmanager
def _at(where: str) -> Iterator[None]:
    """Say where in the study it is that something is wrong."""
    try:
        yield
    except GaplessError as error:
        raise type(error)(f"{where}: {error}") from None
