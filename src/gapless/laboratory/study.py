"""What a bench is asked to do: sources of recordings, scenarios, protocols."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Protocol

from gapless.errors import ConfigError
from gapless.scenarios import Outage, Periodic, Plan, parse
from gapless.trip.recording import Recording

PASSES, ISOLATED = "passes", "isolated"
PROTOCOLS: Final = {
    PASSES: "all outages of a plan withheld in one run",
    ISOLATED: "each outage alone, all other fixes open",
}
"""Protocols by name, and what they are."""
LONG: Final = 120.0
"""From this length on [s] outages of a ladder begin at least `LONG_EVERY` apart."""
LONG_EVERY: Final = 240.0


class Source(Protocol):
    """Where a recording comes from; opened by the process that needs it."""

    @property
    def name(self) -> str:
        """What tables call it."""
        ...

    def open(self) -> Recording:
        """Read or make the recording.

        Returns
        -------
        Recording
        """
        ...


@dataclass(frozen=True)
class Stored:
    """A recording on disk.

    Parameters
    ----------
    name : str
    paths : tuple of Path
        As `gapless.io.read` takes them.
    """

    name: str
    paths: tuple[Path, ...]

    def open(self) -> Recording:
        """Read it.

        Returns
        -------
        Recording
        """
        from gapless.io import read

        return replace(read(*self.paths), name=self.name)


@dataclass(frozen=True)
class Simulated:
    """A drive that never was.

    Parameters
    ----------
    profile, grade : str
        As `gapless.simulate` knows them.
    duration : float
        [s]
    seed : int
    """

    profile: str
    grade: str
    duration: float
    seed: int

    @property
    def name(self) -> str:
        """What tables call it."""
        return f"{self.profile}-{self.grade}-{self.seed:04d}"

    def open(self) -> Recording:
        """Simulate it.

        Returns
        -------
        Recording
        """
        from gapless.simulate import simulate

        made = simulate(self.profile, self.grade, self.duration, self.seed)
        return replace(made, name=self.name)


@dataclass(frozen=True)
class Scenario:
    """A plan, and with which others its outages are pooled.

    Parameters
    ----------
    text : str
        Of the plan.
    group : str
        Outages of one group are one pool: those of a length, whatever their shift.
    length : float
        Of its outages [s]; NaN where they differ.
    shift : float
        [s]
    """

    text: str
    group: str
    length: float
    shift: float

    def outages(self, recording: Recording) -> tuple[Outage, ...]:
        """Its outages in a recording; none where none fits.

        Parameters
        ----------
        recording : Recording

        Returns
        -------
        tuple of Outage
        """
        return parse(self.text).expand(recording)


def ladder(
    lengths: Iterable[float], every: float, shifts: Iterable[float], first: float
) -> tuple[Scenario, ...]:
    """Periodic outages of several lengths, each with all shifts: the protocol of the KF-GINS papers.

    Parameters
    ----------
    lengths : iterable of float
        [s]
    every : float
        From start to start [s]; at least 240 s for outages of 120 s and more.
    shifts : iterable of float
        Added to every start [s].
    first : float
        Start of the first [s].

    Returns
    -------
    tuple of Scenario

    Raises
    ------
    ConfigError
        If outages would overlap, or a value is out of range.
    """
    shifts = tuple(shifts)
    return tuple(
        scenario(f"every={_often(every, length):g},length={length:g},first={first:g},shift={shift:g}")
        for length in lengths
        for shift in shifts
    )


def _often(every: float, length: float) -> float:
    return max(every, LONG_EVERY) if length >= LONG else every


def scenario(text: str) -> Scenario:
    """A plan that a user typed.

    Parameters
    ----------
    text : str

    Returns
    -------
    Scenario

    Raises
    ------
    ConfigError
        As `gapless.scenarios.parse`.
    """
    plan = parse(text)
    length, shift = getattr(plan, "length", float("nan")), getattr(plan, "shift", 0.0)
    return Scenario(str(plan), _group(plan, length), float(length), float(shift))


def _group(plan: Plan, length: float) -> str:
    if isinstance(plan, Periodic):
        kind = plan.effect.name
        return f"{length:g} s" if kind == "silent" else f"{length:g} s, {plan.effect}"
    return str(plan)


def stored(paths: Sequence[Path]) -> tuple[Stored, ...]:
    """Recordings by the names of their folders.

    Parameters
    ----------
    paths : sequence of Path

    Returns
    -------
    tuple of Stored

    Raises
    ------
    ConfigError
        If two have the same name.
    """
    found = tuple(Stored(path.resolve().name, (path,)) for path in paths)
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1:
            raise ConfigError(f"two recordings are called {name}; give one of the folders another name")
    return found
