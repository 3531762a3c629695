"""`gapless systems`: the built-in systems, and what they are made of."""

from __future__ import annotations

from shutil import get_terminal_size
from typing import TYPE_CHECKING

import click
from click.formatting import wrap_text

if TYPE_CHECKING:
    from gapless.systems.recipe import System


@click.command(short_help="List the built-in systems and what they are made of.")
@click.argument("name", required=False)
def systems(name: str | None) -> None:
    """List the built-in systems, or show the recipe of NAME.

    A recipe is a TOML file: save one under another name, change it, and give it
    to fuse with --config or to bench with --systems. `like = "wang2018"` at its
    top takes over what the file does not say.
    """
    from gapless.systems.library import load, names, source

    if name is not None:
        click.echo(source(name).rstrip())
        return
    width = max(40, min(100, get_terminal_size().columns))
    for known in names():
        system = load(known)
        click.echo(click.style(known, bold=True))
        for text in (system.description, made_of(system)):
            click.echo(wrap_text(text, width, "  ", "  "))


def made_of(system: System) -> str:
    """What a system consists of, in one line.

    Parameters
    ----------
    system : System

    Returns
    -------
    str
    """
    from gapless.inertial.layout import EXTRAS, N_CORE
    from gapless.systems.learning import MODELS

    bridge, learner = system.bridge, system.learner
    states = N_CORE + sum(EXTRAS[name] for name in system.filter.states)
    parts = [
        f"{states} states, {' then '.join(system.adaptation.gnss) or 'no adaptation'}",
        ", ".join(system.constraints).replace("_", " ") or "no constraints",
    ]
    if system.filter.moments != "taylor":
        parts[0] = f"{system.filter.moments} filter, {parts[0]}"
    if system.denoise.method != "none":
        window = f"windows of {system.denoise.window}" if system.denoise.window else "whole record"
        parts.insert(0, f"{system.denoise.method} ({window})")
    if bridge.model == "none":
        return "; ".join([*parts, "no bridge"])
    if system.rehearsal.every:
        parts.append(f"rehearsed every {system.rehearsal.every:g} s")
    if bridge.model not in MODELS:
        return "; ".join([*parts, bridge.model])
    shown = [*bridge.features, *([f"{bridge.window} past errors"] if bridge.window else [])]
    what = "position increment" if bridge.model == "increment" else f"{' and '.join(bridge.learns)} error"
    rules = " then ".join(system.adaptation.bridge)
    noise = f"{bridge.noise} noise" + (f", {rules}" if rules else "")
    return "; ".join([*parts, f"{learner.name}: {', '.join(shown)} -> {what}, {noise}"])
