"""What a paper's experiment consists of, as data: drives, methods, published tables, claims."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from numpy.random import Generator

from gapless.papers.published import Claim, Published
from gapless.scenarios import Outage
from gapless.simulate import Receiver, Segment
from gapless.simulate.drive import HEADING, ORIGIN

OURS: Final = "constraints (ours)"
"""The bar that no paper shows: what every car obeys for free."""


@dataclass(frozen=True)
class Method:
    """A row of a paper's tables, and how gapless runs it.

    Parameters
    ----------
    name : str
        As the paper calls it.
    recipe : str
        Built-in system that it starts from.
    changes : mapping of str to object
        Other values for some of its keys, by dotted key.
    smoothed : bool
        Whether the whole record is looked back over: not causal.
    """

    name: str
    recipe: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    smoothed: bool = False


class Window(NamedTuple):
    """A stretch that is scored.

    Parameters
    ----------
    name : str
        What tables call it.
    start, end : float
        [s] after the first IMU sample.
    withheld : bool
        Whether GNSS is silent in it.
    """

    name: str
    start: float
    end: float
    withheld: bool = True

    @property
    def outage(self) -> Outage:
        """The stretch as an outage."""
        return Outage(self.start, self.end)


@dataclass(frozen=True)
class Faults:
    """Gross errors that a receiver does not own up to.

    Parameters
    ----------
    count : int
        Of fixes that are struck.
    position, velocity : tuple of 2 floats
        Least and greatest size [m], [m/s].
    """

    count: int
    position: tuple[float, float]
    velocity: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Start:
    """An initial attitude that is told instead of found.

    Parameters
    ----------
    error : float
        Standard deviation of the misalignment per axis [rad].
    """

    error: float


@dataclass(frozen=True)
class Drive:
    """A simulated drive and what is measured of it.

    Parameters
    ----------
    segments : str or callable
        A named profile, or a function of a random generator that gives segments.
    grade : str
        Of the IMU.
    rate : float
        Of the IMU [Hz].
    duration : float
        [s]
    receiver : Receiver
    windows : tuple of Window
    heading : float
        Initial [rad].
    origin : tuple of 3 floats
        Latitude, longitude [rad], height [m].
    faults : tuple of Faults
    start : Start, optional
        Without one, gapless aligns itself in motion.
    """

    segments: str | Callable[[Generator], tuple[Segment, ...]]
    grade: str
    rate: float
    duration: float
    receiver: Receiver
    windows: tuple[Window, ...]
    heading: float = HEADING
    origin: tuple[float, float, float] = ORIGIN
    faults: tuple[Faults, ...] = ()
    start: Start | None = None

    @property
    def outages(self) -> tuple[Outage, ...]:
        """Its windows in which GNSS is silent."""
        return tuple(w.outage for w in self.windows if w.withheld)


@dataclass(frozen=True)
class Experiment:
    """Methods on a drive, or on real recordings, with what was published of them.

    Parameters
    ----------
    name : str
    about : str
        One sentence.
    methods : tuple of Method
    drive : Drive, optional
        Of a simulation; a road test has the outages of `road` instead.
    road : tuple of Window
        Outages of a road test: their length is what counts, and they come again along a recording.
    tables : tuple of Published
    claims : tuple of Claim
        Besides those that the tables give.
    seeds : int
        Drives that are simulated if nothing else is said.
    aside : bool
        Whether it looks at what the paper leaves open, rather than at what it shows.
    """

    name: str
    about: str
    methods: tuple[Method, ...]
    drive: Drive | None = None
    road: tuple[Window, ...] = ()
    tables: tuple[Published, ...] = ()
    claims: tuple[Claim, ...] = ()
    seeds: int = 100
    aside: bool = False

    @property
    def windows(self) -> tuple[Window, ...]:
        """What is scored."""
        return self.road if self.drive is None else self.drive.windows


@dataclass(frozen=True)
class Paper:
    """A paper's experiments, and what has to be said of them.

    Parameters
    ----------
    name : str
        As of its recipe.
    title, citation : str
    idea : str
        A few sentences in plain words.
    experiments : tuple of Experiment
    open : tuple of str
        What the paper leaves open, and what was taken.
    differs : tuple of str
        What cannot agree, and why.
    studies : tuple of str
        What is shown beside the drives, of `studies.STUDIES`.
    """

    name: str
    title: str
    citation: str
    idea: str
    experiments: tuple[Experiment, ...]
    open: tuple[str, ...]
    differs: tuple[str, ...]
    studies: tuple[str, ...] = ()


SAME_CLOCK: Final = MappingProxyType({"clock.position": 0.0, "clock.velocity": 0.0})
"""Simulated sensors share one clock, as the papers' simulations do, and the filter is told so."""
WHITE: Final = MappingProxyType(
    {
        "gnss.jitter": 0.0,
        "gnss.wander": 0.0,
        "gnss.position_correlation": 0.0,
        "gnss.velocity_correlation": 0.0,
        "gnss.position_floor": 0.0,
        "gnss.velocity_floor": 0.0,
    }
)
"""The filter's R is that of the simulated receiver, whose errors are white."""
