"""What shakes a car: tyres and engine, each a comb of orders, and the road.

An *order* is a frequency counted in cycles per turn of what turns: a tyre that is not quite round or
balanced shakes the chassis at whole orders of its own, an engine at multiples of half a turn. Amplitudes
are those of the box's surroundings in the car's axes, not of what a sensor makes of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless.errors import ConfigError
from gapless.units import DEG

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


def _demand(holds: bool, what: str, cure: str) -> None:
    if not holds:
        raise ConfigError(f"{what}; {cure}")


def _demand_circumference(circumference: float) -> None:
    _demand(
        isfinite(circumference) and circumference > 0.0,
        f"a wheel of {circumference:g} m circumference",
        "give metres a turn, more than 0",
    )


def _finite(values: Iterable[float], least: float = 0.0) -> bool:
    return all(isfinite(v) and v >= least for v in values)


@dataclass(frozen=True)
class Harmonic:
    """One line of an order comb.

    Parameters
    ----------
    order : float
        Cycles per turn, > 0.
    rate : tuple of 3 floats
        Amplitude of the angular rate about the car's forward, right, down axes [rad/s], where the
        comb's `Growth` is 1.
    accel : tuple of 3 floats
        Of the acceleration along them [m/s^2].

    Raises
    ------
    ConfigError
        If the order is not positive or an amplitude is negative.
    """

    order: float
    rate: Triple
    accel: Triple

    def __post_init__(self) -> None:
        _demand(
            isfinite(self.order) and self.order > 0.0,
            f"a harmonic of order {self.order:g}",
            "give cycles per turn, more than 0",
        )
        _demand(
            _finite((*self.rate, *self.accel)),
            f"harmonic {self.order:g}: an amplitude is negative or not finite",
            "give zero or more",
        )


@dataclass(frozen=True)
class Growth:
    """How an amplitude grows with what drives it: a power law that saturates.

    Parameters
    ----------
    reference : float
        Where it is 1: a speed [m/s] or turns per second [1/s], > 0.
    exponent : float
        > 0, so that what stands is still.
    cap : float
        It grows no more from `cap` times the reference on.

    Raises
    ------
    ConfigError
        If one of them is not positive.
    """

    reference: float
    exponent: float = 1.0
    cap: float = 2.0

    def __post_init__(self) -> None:
        given = (self.reference, self.exponent, self.cap)
        _demand(
            all(v > 0.0 for v in given) and isfinite(self.reference) and isfinite(self.exponent),
            f"growth by reference {given[0]:g}, exponent {given[1]:g}, cap {given[2]:g}",
            "each must be more than 0",
        )

    def __call__(self, driver: Array) -> Array:
        """Factor on the amplitude.

        Parameters
        ----------
        driver : ndarray
            In the unit of the reference; its sign does not count.

        Returns
        -------
        ndarray, of that shape
        """
        share = np.minimum(np.abs(driver) / self.reference, self.cap)
        return np.asarray(share**self.exponent)


def _harmonic(order: float, rate: Triple, accel: Triple) -> Harmonic:
    """A harmonic with its rates in deg/s."""
    return Harmonic(order, (rate[0] * DEG, rate[1] * DEG, rate[2] * DEG), accel)


TYRE: Final = (
    _harmonic(1.0, (0.12, 0.14, 0.08), (0.030, 0.030, 0.060)),
    _harmonic(2.0, (0.20, 0.18, 0.08), (0.040, 0.040, 0.080)),
    _harmonic(3.0, (0.14, 0.12, 0.06), (0.030, 0.040, 0.060)),
    _harmonic(4.0, (0.10, 0.10, 0.05), (0.040, 0.030, 0.060)),
    _harmonic(5.0, (0.08, 0.07, 0.05), (0.030, 0.030, 0.050)),
    _harmonic(6.0, (0.06, 0.06, 0.05), (0.030, 0.020, 0.040)),
    _harmonic(7.0, (0.05, 0.05, 0.05), (0.020, 0.020, 0.030)),
)
"""Orders of a car's tyres at 15 m/s."""

MOTOR: Final = (
    _harmonic(0.5, (0.02, 0.02, 0.01), (0.010, 0.010, 0.010)),
    _harmonic(1.0, (0.04, 0.04, 0.02), (0.020, 0.020, 0.020)),
    _harmonic(2.0, (0.10, 0.06, 0.04), (0.040, 0.040, 0.060)),
    _harmonic(4.0, (0.04, 0.03, 0.02), (0.020, 0.020, 0.030)),
)
"""Orders of a four-cylinder engine at 30 turns a second: two ignitions a turn."""


@dataclass(frozen=True)
class WheelComb:
    """Tyres of one circumference.

    Parameters
    ----------
    circumference : float
        Way of one turn [m], > 0.
    harmonics : tuple of Harmonic
    growth : Growth
        Of the amplitudes with the tread's speed [m/s].
    driven : bool
        Whether slip reaches these wheels.

    Raises
    ------
    ConfigError
        If the circumference is not positive.
    """

    circumference: float = 2.0
    harmonics: tuple[Harmonic, ...] = TYRE
    growth: Growth = Growth(15.0)
    driven: bool = True

    def __post_init__(self) -> None:
        _demand_circumference(self.circumference)


class Gear(NamedTuple):
    """A gear: up to which speed [m/s], and turns of the engine per turn of the driven wheels."""

    until: float
    ratio: float


GEARS: Final = (Gear(4.5, 14.0), Gear(8.0, 8.0), Gear(13.0, 5.4), Gear(19.0, 4.0), Gear(inf, 3.1))
"""Five gears that keep a car's engine between 1200 and 3100 turns a minute up to 120 km/h."""


@dataclass(frozen=True)
class Engine:
    """An engine, geared to the driven wheels; it idles where they would turn it slower.

    Parameters
    ----------
    harmonics : tuple of Harmonic
        Orders of the crankshaft.
    gears : tuple of Gear
        With rising `until`, the last of them inf; a change takes no time.
    circumference : float
        Of the driven wheels [m], > 0.
    idle : float
        Turns per second [1/s], > 0.
    growth : Growth
        Of the amplitudes with the turns per second [1/s].

    Raises
    ------
    ConfigError
        If a number is not positive, or the gears do not cover every speed in rising order.
    """

    harmonics: tuple[Harmonic, ...] = MOTOR
    gears: tuple[Gear, ...] = GEARS
    circumference: float = 2.0
    idle: float = 13.0
    growth: Growth = Growth(30.0)

    def __post_init__(self) -> None:
        _demand_circumference(self.circumference)
        _demand(
            isfinite(self.idle) and self.idle > 0.0,
            f"an engine that idles at {self.idle:g} turns a second",
            "give more than 0",
        )
        bands = [0.0, *(g.until for g in self.gears)]
        _demand(
            all(a < b for a, b in pairwise(bands)) and bands[-1] == inf,
            f"gears until {', '.join(f'{b:g}' for b in bands[1:]) or 'nothing'} m/s",
            "give rising speeds, the last of them inf",
        )
        _demand(
            all(isfinite(g.ratio) and g.ratio > 0.0 for g in self.gears),
            "a gear ratio is not positive",
            "give engine turns per wheel turn",
        )


@dataclass(frozen=True)
class Road:
    """Broadband shaking by the road, white above its lowest frequency, none where the car stands.

    Parameters
    ----------
    rate : tuple of 3 floats
        Density of the angular rate about forward, right, down where the growth is 1 [rad/sqrt(s)];
        as the white noise of a `Grade`, it adds density^2 dt to the variance of an increment.
    accel : tuple of 3 floats
        Of the acceleration [m/s/sqrt(s)].
    growth : Growth
        With the speed [m/s].
    lowest : float
        Below this frequency the car follows the road and there is none [Hz], so that the integral
        of the shaking stays bounded.

    Raises
    ------
    ConfigError
        If a number is negative.
    """

    rate: Triple = (0.04 * DEG, 0.04 * DEG, 0.02 * DEG)
    accel: Triple = (0.02, 0.02, 0.04)
    growth: Growth = Growth(15.0)
    lowest: float = 3.0

    def __post_init__(self) -> None:
        _demand(
            _finite((*self.rate, *self.accel, self.lowest)),
            "road noise: a density or the lowest frequency is negative or not finite",
            "give zero or more",
        )


class Slip(NamedTuple):
    """Driven wheels turn otherwise than the car moves: when [s], how long [s], how many times as fast.

    More than 1 where they spin, less under braking, 0 locked.
    """

    start: float
    duration: float
    ratio: float


@dataclass(frozen=True)
class Chassis:
    """All that shakes a car.

    Parameters
    ----------
    wheels : tuple of WheelComb
        One for each circumference; front and rear tyres differ by a few thousandths.
    engine : Engine, optional
    road : Road, optional
    slips : tuple of Slip
        In no particular order; they may not overlap.
    signal : float
        Factor on the wheels' amplitudes, and on theirs alone: 0 for wheels that nobody can hear.

    Raises
    ------
    ConfigError
        If the factor or a slip's ratio is negative, or slips overlap or do not last.
    """

    wheels: tuple[WheelComb, ...] = (WheelComb(),)
    engine: Engine | None = Engine()
    road: Road | None = Road()
    slips: tuple[Slip, ...] = ()
    signal: float = 1.0

    def __post_init__(self) -> None:
        _demand(
            _finite([self.signal]), f"wheels cannot be {self.signal:g} times as loud", "give zero or more"
        )
        for s in self.slips:
            _demand(
                _finite(s) and s.duration > 0.0,
                f"a slip of {s.duration:g} s from {s.start:g} s, ratio {s.ratio:g}",
                "give a start and a ratio of zero or more, and a positive duration",
            )
        for a, b in pairwise(sorted(self.slips)):
            _demand(a.start + a.duration <= b.start, f"slips overlap at {b.start:g} s", "part or join them")


CAR: Final = Chassis()
"""A passenger car: one kind of tyres, a four-cylinder engine, asphalt."""
