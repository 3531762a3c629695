"""Plans as a user types them.

    240:300                                     a stretch, in seconds after the first IMU sample
    every=180,length=60,first=240,shift=60      at regular distances (shift may be left out)
    random=180,length=60,first=240,seed=1       one in 180 s on average (seed may be left out)
    at=turn,every=180,length=60,first=240       beginning in a turn, at a stop, at speed
    gaps=5                                      the recording's own gaps of 5 s and more

All but the last may end with `,effect=noisy`, with a size `,effect=noisy:10`, with a seed for what is
drawn `,effect=noisy:10:1`: see `KINDS` for the effects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Final, NoReturn

from gapless.errors import ConfigError
from gapless.scenarios.effects import KINDS, SILENT, Effect
from gapless.scenarios.outage import Drive, Outage, duration_of
from gapless.scenarios.plans import PLACES, At, Gaps, Periodic, Plan, Random

_STRETCH: Final = "write start:end in seconds after the first IMU sample, for instance 240:300"
_PERIODIC: Final = "write every=180,length=60,first=240 and, if wanted, shift=60 (seconds)"
_RANDOM: Final = "write random=180,length=60,first=240 and, if wanted, seed=1"
_AT: Final = f"write at={'|'.join(PLACES)},every=180,length=60,first=240 (seconds)"
_GAPS: Final = "write gaps=5 for the recording's own gaps of 5 s and more"
_EFFECT: Final = (
    f"write effect={'|'.join(k for k in KINDS if k != 'real')} or with a size and a seed, effect=noisy:10:1"
)

_CLOSEST: Final = 1.0
"""Outages of a plan start no closer to each other [s]: there would be no end to them."""


def parse(text: str) -> Plan:
    """Read one plan.

    Parameters
    ----------
    text : str
        One of the forms that this module lists.

    Returns
    -------
    Plan

    Raises
    ------
    ConfigError
        If the text has none of the forms, or a value is negative, empty or makes outages overlap.
    """
    parts = text.split(",")
    if "=" not in parts[0]:
        return _stretch(text, parts)
    values = _keys(text, parts)
    for key, read in _FORMS.items():
        if key in values:
            return read(text, values)
    _refuse(text, f"{' and '.join(values)} alone make no plan", f"{_PERIODIC}; or {_RANDOM}; or {_AT}")


def plan(texts: Iterable[str], drive: Drive) -> tuple[Outage, ...]:
    """Outages of all texts together, in order of time.

    Parameters
    ----------
    texts : iterable of str
        As `parse` reads them.
    drive : Recording or float
        A duration [s] does where no plan looks into the recording.

    Returns
    -------
    tuple of Outage

    Raises
    ------
    ConfigError
        As `parse`; also if a text leaves no outage in the recording, or two overlap.
    """
    outages: list[Outage] = []
    for text in texts:
        chosen = parse(text).expand(drive)
        if not chosen:
            what = f"the recording lasts {duration_of(drive):.0f} s and no outage fits"
            _refuse(text, what, "begin earlier, or ask for less")
        outages += chosen
    outages.sort()
    for a, b in pairwise(outages):
        if b.start < a.end:
            raise ConfigError(f"outages {a} and {b} overlap; join them to {a.start:g}:{max(a.end, b.end):g}")
    return tuple(outages)


def _refuse(text: str, what: str, cure: str) -> NoReturn:
    raise ConfigError(f"outage {text!r}: {what}; {cure}")


def _number(text: str, part: str, form: str) -> float:
    try:
        value = float(part)
    except ValueError:
        _refuse(text, f"{part.strip()!r} is not a number", form)
    if not math.isfinite(value) or value < 0.0:
        _refuse(text, f"{part.strip()} is negative or not finite", form)
    return value


def _keys(text: str, parts: Sequence[str]) -> dict[str, str]:
    values: dict[str, str] = {}
    for part in parts:
        key, _, value = part.partition("=")
        key = key.strip()
        if key in values:
            _refuse(text, f"{key!r} is given twice", _PERIODIC)
        values[key] = value.strip()
    return values


def _only(text: str, values: Mapping[str, str], form: str, needed: Sequence[str], optional: str) -> None:
    """Refuse keys that are unknown, missing, or at odds with each other."""
    for key in values:
        if key not in (*needed, optional, "effect"):
            _refuse(text, f"{key!r} is unknown here", form)
    missing = [key for key in needed if key not in values]
    if missing:
        _refuse(text, f"{' and '.join(missing)} missing", form)


def _spaced(
    text: str, values: Mapping[str, str], form: str, every: str = "every"
) -> tuple[float, float, float]:
    """Distance, length and first start, checked against each other."""
    distance, length, first = (_number(text, values[key], form) for key in (every, "length", "first"))
    if min(distance, length) <= 0.0:
        _refuse(text, f"{every} and length must be above zero", form)
    if distance < _CLOSEST:
        _refuse(text, f"{every} is less than {_CLOSEST:g} s", form)
    if length > distance:
        _refuse(text, f"outages overlap, length is more than {every}", form)
    return distance, length, first


def _effect(text: str, word: str | None) -> Effect:
    if word is None:
        return SILENT
    name, *numbers = word.split(":")
    kind = KINDS.get(name)
    if kind is None or name == "real":
        _refuse(text, f"effect {name!r} is unknown", _EFFECT)
    if not numbers:
        return Effect(name, kind.size)
    if not kind.size:
        _refuse(text, f"effect {name} has no size", _EFFECT)
    size = _number(text, numbers[0], _EFFECT)
    if size <= 0.0 or len(numbers) > 2:
        _refuse(text, f"effect {name} needs a size above zero and at most a seed after it", _EFFECT)
    return Effect(name, size, _whole(text, numbers[1], _EFFECT) if len(numbers) == 2 else 0)


def _whole(text: str, part: str, form: str) -> int:
    value = _number(text, part, form)
    if value != int(value):
        _refuse(text, f"seed {value:g} is not a whole number", form)
    return int(value)


def _stretch(text: str, parts: Sequence[str]) -> Outage:
    ends, rest = parts[0].split(":"), _keys(text, parts[1:])
    if len(ends) != 2:
        cure = f"{_STRETCH}; or {_PERIODIC}; or {_RANDOM}; or {_AT}; or {_GAPS}"
        _refuse(text, "neither a stretch nor a plan", cure)
    _only(text, rest, _STRETCH, (), "effect")
    start, end = (_number(text, part, _STRETCH) for part in ends)
    if end <= start:
        _refuse(text, "it does not end after it starts", _STRETCH)
    return Outage(start, end, _effect(text, rest.get("effect")))


def _periodic(text: str, values: Mapping[str, str]) -> Periodic:
    _only(text, values, _PERIODIC, ("every", "length", "first"), "shift")
    every, length, first = _spaced(text, values, _PERIODIC)
    shift = _number(text, values.get("shift", "0"), _PERIODIC)
    return Periodic(every, length, first, shift, _effect(text, values.get("effect")))


def _random(text: str, values: Mapping[str, str]) -> Random:
    _only(text, values, _RANDOM, ("random", "length", "first"), "seed")
    every, length, first = _spaced(text, values, _RANDOM, "random")
    seed = _whole(text, values.get("seed", "0"), _RANDOM)
    return Random(every, length, first, seed, _effect(text, values.get("effect")))


def _at(text: str, values: Mapping[str, str]) -> At:
    _only(text, values, _AT, ("at", "every", "length", "first"), "effect")
    if values["at"] not in PLACES:
        _refuse(text, f"at {values['at']!r} is unknown", _AT)
    every, length, first = _spaced(text, values, _AT)
    return At(values["at"], every, length, first, _effect(text, values.get("effect")))


def _gaps(text: str, values: Mapping[str, str]) -> Gaps:
    if "effect" in values:
        _refuse(text, "nothing is withheld in a gap, so it has no effect", _GAPS)
    _only(text, values, _GAPS, ("gaps",), "gaps")
    least = _number(text, values["gaps"], _GAPS)
    if least <= 0.0:
        _refuse(text, "the least gap must be above zero", _GAPS)
    return Gaps(least)


_FORMS: Final[dict[str, Callable[[str, Mapping[str, str]], Plan]]] = {
    "random": _random,
    "at": _at,
    "gaps": _gaps,
    "every": _periodic,
}
"""By the key that tells a form from the others, in the order in which they are tried."""
