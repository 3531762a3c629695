"""Every rule by its name in a recipe, chains of them, and which make no sense."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal, Self, get_args

from gapless.errors import ConfigError
from gapless.filters.adaptation.base import Adaptation, Innovation, Rule, Verdict
from gapless.filters.adaptation.chi_square import ChiSquare
from gapless.filters.adaptation.fading import Fading
from gapless.filters.adaptation.gate import Gate
from gapless.filters.adaptation.igg3 import Igg3
from gapless.filters.adaptation.improved_fading import ImprovedFading
from gapless.filters.adaptation.relock import Relock
from gapless.filters.adaptation.sage_husa import SageHusa
from gapless.filters.adaptation.variational import Variational

RULES: Final[dict[str, type[Rule]]] = {
    "gate": Gate,
    "relock": Relock,
    "chi_square": ChiSquare,
    "igg3": Igg3,
    "sage_husa": SageHusa,
    "variational": Variational,
    "fading": Fading,
    "improved_fading": ImprovedFading,
}
Kind = Literal["gnss", "bridge", "constraints"]
"""Kinds of observation, each with a chain of its own: odometers count as constraints."""
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
_TWICE: Final = {
    "noise": "both estimate R, and the second would not hear what the first says",
    "process": "both make the filter forget, and would do it twice",
    "recovery": "both doubt the filter for the same surprises",
    "test": "both test the same z' S^-1 z, and the second finds what the first has left",
    "weight": "both weigh the same residual",
}


def kind_of(channel: str) -> Kind:
    """Which kind of observation comes through a channel.

    Parameters
    ----------
    channel : str

    Returns
    -------
    str
        From `KINDS`.
    """
    if channel in ("position", "velocity"):
        return "gnss"
    return "bridge" if channel.startswith("bridge") else "constraints"


@dataclass
class Chain:
    """Rules one after the other, each hearing what the one before has left.

    Parameters
    ----------
    rules : tuple of Adaptation
        None of them: every observation counts as stated.
    """

    rules: tuple[Adaptation, ...] = ()

    def judge(self, innovation: Innovation) -> Verdict:
        """All effects together; a rejection, or doubt in the filter, ends the chain."""
        gain, noise, fade = 1.0, None, 1.0
        for rule in self.rules:
            said = rule.judge(innovation)
            gain, fade = gain * said.gain, fade * said.fade
            noise = noise if said.noise is None else said.noise
            if said.r is None or said.widen:
                return Verdict(said.r, gain, said.widen, noise, fade)
            if said.r is not innovation.r:
                innovation = innovation.bent(said.r)
        return Verdict(innovation.r, gain, False, noise, fade)

    def copy(self) -> Self:
        """An independent chain; see `Adaptation.copy`."""
        return type(self)(tuple(rule.copy() for rule in self.rules))


def chain(kind: str, names: Sequence[str], tables: Mapping[str, Any] | None = None) -> Adaptation:
    """Rules by their names, in this order.

    Parameters
    ----------
    kind : str
        From `KINDS`.
    names : sequence of str
        From `RULES`.
    tables : mapping of str to Struct, optional
        Parameters by rule; defaults where not named.

    Returns
    -------
    Adaptation

    Raises
    ------
    ConfigError
        If there is no such rule, or the combination makes no sense.
    """
    check(kind, names)
    tables = tables or {}
    made = tuple(RULES[name](tables[name]) if name in tables else RULES[name]() for name in names)
    return made[0] if len(made) == 1 else Chain(made)


def check(kind: str, names: Sequence[str]) -> None:
    """Refuse a chain that makes no sense.

    Parameters
    ----------
    kind : str
    names : sequence of str

    Raises
    ------
    ConfigError
        With the reason.
    """
    for name in names:
        if name not in RULES:
            raise ConfigError(f"adaptation.{kind} has {name!r}; choose from {', '.join(RULES)}")
    for k, name in enumerate(names):
        reason = _clash(kind, name, names[:k], names)
        if reason:
            raise ConfigError(f"adaptation.{kind}: {reason}")


def _clash(kind: str, name: str, before: Sequence[str], names: Sequence[str]) -> str:
    """Why a rule cannot stand where it does, or nothing."""
    rule = RULES[name]
    if name in before:
        return f"{name} is named twice; name it once"
    for other in before:
        if RULES[other].role == rule.role:
            return f"{other} and {name} do not go together: {_TWICE[rule.role]}; keep one"
    if rule.role == "process" and kind != "gnss":
        return f"{name} counts epochs by GNSS positions; name it in adaptation.gnss"
    doubts = [other for other in before if RULES[other].role in ("test", "weight")]
    if rule.role == "noise" and doubts:
        return f"{name} would undo what {doubts[0]} did to R; name {name} first"
    bending = [other for other in names if RULES[other].bends_gain]
    if rule.reckons_optimal and bending:
        return f"{name} reckons with the residual of the optimal gain, which {bending[0]} does not take"
    return ""


def bends_gain(names: Sequence[str]) -> str:
    """The rule that takes another gain than the optimal one.

    Parameters
    ----------
    names : sequence of str

    Returns
    -------
    str
        Empty where there is none.
    """
    return next((name for name in names if RULES[name].bends_gain), "")
