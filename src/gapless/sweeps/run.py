"""One run of a study: everything that its result depends on, and the key that this hashes to."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from typing import Any

import msgspec
from msgspec import Struct

from gapless.sweeps.sources import Logged, Simulated
from gapless.systems.adjust import changed
from gapless.systems.recipe import System
from gapless.version import __version__


@cache
def versions() -> dict[str, str]:
    """Versions that count: gapless, and what draws its random numbers and compiles its kernels.

    Returns
    -------
    dict of str to str
    """
    return {"gapless": __version__} | {name: version(name) for name in ("numpy", "numba")}


class Run(Struct, frozen=True):
    """A recording, what is withheld of it, and what navigates it.

    Parameters
    ----------
    source : Simulated or Logged
    scenario : tuple of str
        Outage arguments as `gapless.plan` reads them; none for an open sky.
    system : System
        The whole recipe, so that a worker elsewhere needs no file.
    override : dict of str to object
        New values for keys of the recipe, by dotted name.
    seed : int
        Of a simulated drive.
    smooth : bool
        Let what came later correct what came before: the bound that no real-time run can pass.
    versions : dict of str to str
        Of the packages that the bits of a result depend on.
    """

    source: Simulated | Logged
    scenario: tuple[str, ...]
    system: System
    override: dict[str, Any] = {}
    seed: int = 0
    smooth: bool = False
    versions: dict[str, str] = msgspec.field(default_factory=versions)

    @property
    def recipe(self) -> System:
        """The recipe with the override in it."""
        return changed(self.system, self.override, f"override of {self.system.name}")

    @property
    def key(self) -> str:
        """SHA-256 of the canonical JSON, in hexadecimal; the same in every process, on every machine.

        Numbers are written as the fields' types have them and keys in order; where files lie does
        not count, what is in them does.
        """
        told = msgspec.to_builtins(msgspec.convert(msgspec.to_builtins(self), Run))
        told["source"].pop("paths", None)
        return hashlib.sha256(msgspec.json.encode(told, order="sorted")).hexdigest()


def label(override: dict[str, Any]) -> str:
    """An override in words, such as "nonholonomic.lateral=0.03".

    Parameters
    ----------
    override : dict of str to object

    Returns
    -------
    str
    """
    return ", ".join(f"{key}={msgspec.json.encode(value).decode()}" for key, value in override.items())
