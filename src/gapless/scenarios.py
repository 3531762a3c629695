"""Outage plans: which stretches of a recording lose their GNSS, and what is left of it.

A stretch is written `240:300`, a periodic plan `every=180,length=60,first=240[,shift=60]`, all in
seconds after the first IMU sample. A GNSS epoch whose logged time lies in [start, end) is withheld,
position and velocity both.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from gapless.errors import ConfigError
from gapless.recording import Array, Gnss

_STRETCH_FORM = "write start:end in seconds after the first IMU sample, for instance 240:300"
_PERIODIC_FORM = "write every=180,length=60,first=240 and, if wanted, shift=60 (seconds)"
_PERIODIC_KEYS = ("every", "length", "first", "shift")


@dataclass(frozen=True, order=True)
class Outage:
    """A stretch without GNSS.

    Parameters
    ----------
    start, end : float
        [s] after the first IMU sample; epochs in [start, end) are withheld.
    """

    start: float
    end: float

    @property
    def length(self) -> float:
        """Duration [s]."""
        return self.end - self.start

    def expand(self, duration: float) -> tuple[Outage, ...]:
        """The outage itself, if it begins within the recording.

        Parameters
        ----------
        duration : float
            Of the recording [s].

        Returns
        -------
        tuple of Outage
        """
        return (self,) if self.start < duration else ()

    def __str__(self) -> str:
        return f"{self.start:g}:{self.end:g}"


@dataclass(frozen=True)
class Periodic:
    """Outages of equal length at equal distances.

    Parameters
    ----------
    every : float
        From start to start [s].
    length : float
        Of each outage [s], not longer than `every`.
    first : float
        Start of the first [s] after the first IMU sample.
    shift : float
        Added to every start [s].
    """

    every: float
    length: float
    first: float
    shift: float = 0.0

    def expand(self, duration: float) -> tuple[Outage, ...]:
        """The outages that end within the recording.

        Parameters
        ----------
        duration : float
            Of the recording [s].

        Returns
        -------
        tuple of Outage
        """
        begin = self.first + self.shift
        count = max(0, math.floor((duration - self.length - begin) / self.every) + 1)
        starts = (begin + k * self.every for k in range(count))
        return tuple(Outage(s, s + self.length) for s in starts)

    def __str__(self) -> str:
        return ",".join(f"{key}={getattr(self, key):g}" for key in _PERIODIC_KEYS)


def parse(text: str) -> Outage | Periodic:
    """Read one outage argument.

    Parameters
    ----------
    text : str
        `start:end`, or `every=...,length=...,first=...[,shift=...]`, in seconds.

    Returns
    -------
    Outage or Periodic

    Raises
    ------
    ConfigError
        If the text has neither form, or a value is negative, empty or makes outages overlap.
    """
    return _parse_periodic(text) if "=" in text else _parse_stretch(text)


def plan(texts: Iterable[str], duration: float) -> tuple[Outage, ...]:
    """Outages of all arguments together, in order of time.

    Parameters
    ----------
    texts : iterable of str
        As `parse` reads them.
    duration : float
        Of the recording [s].

    Returns
    -------
    tuple of Outage

    Raises
    ------
    ConfigError
        As `parse`; also if an argument leaves no outage in the recording, or two overlap.
    """
    outages: list[Outage] = []
    for text in texts:
        chosen = parse(text).expand(duration)
        if not chosen:
            _refuse(text, f"the recording lasts {duration:.0f} s and no outage fits", "begin earlier")
        outages += chosen
    outages.sort()
    for a, b in pairwise(outages):
        if b.start < a.end:
            raise ConfigError(f"outages {a} and {b} overlap; join them to {a.start:g}:{max(a.end, b.end):g}")
    return tuple(outages)


def withheld(time: Array, outages: Sequence[Outage], start: float) -> NDArray[np.bool_]:
    """Which logged times lie in an outage.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Logged stamps [s].
    outages : sequence of Outage
    start : float
        Time of the first IMU sample [s].

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    mask = np.zeros(len(time), bool)
    for outage in outages:
        mask |= (time >= start + outage.start) & (time < start + outage.end)
    return mask


def withhold(gnss: Gnss, outages: Sequence[Outage], start: float) -> Gnss:
    """What the receiver would have logged without the epochs in the outages.

    Parameters
    ----------
    gnss : Gnss
    outages : sequence of Outage
    start : float
        Time of the first IMU sample [s].

    Returns
    -------
    Gnss
        Withheld epochs are gone, position and velocity both.
    """
    return gnss.take(~withheld(gnss.time, outages, start))


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


def _parse_stretch(text: str) -> Outage:
    parts = text.split(":")
    if len(parts) != 2:
        cure = f"{_STRETCH_FORM}; or {_PERIODIC_FORM}"
        _refuse(text, "neither a stretch nor a periodic plan", cure)
    start, end = (_number(text, part, _STRETCH_FORM) for part in parts)
    if end <= start:
        _refuse(text, "it does not end after it starts", _STRETCH_FORM)
    return Outage(start, end)


def _parse_periodic(text: str) -> Periodic:
    values: dict[str, float] = {}
    for part in text.split(","):
        key, _, value = part.partition("=")
        key = key.strip()
        if key not in _PERIODIC_KEYS or key in values:
            _refuse(text, f"{key!r} is {'given twice' if key in values else 'unknown'}", _PERIODIC_FORM)
        values[key] = _number(text, value, _PERIODIC_FORM)
    missing = [key for key in _PERIODIC_KEYS[:3] if key not in values]
    if missing:
        _refuse(text, f"{' and '.join(missing)} missing", _PERIODIC_FORM)
    if min(values["every"], values["length"]) <= 0.0:
        _refuse(text, "every and length must be above zero", _PERIODIC_FORM)
    if values["length"] > values["every"]:
        _refuse(text, "outages overlap, length is more than every", _PERIODIC_FORM)
    return Periodic(**values)
