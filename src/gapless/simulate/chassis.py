"""What shakes a car: the tyres, the engine, the road."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite
from typing import Final, NamedTuple

from gapless.simulate.harmonics import (
    BY_SPEED,
    BY_TURNS,
    MOTOR,
    TYRE,
    Growth,
    Harmonic,
    Triple,
    demand,
    finite,
)
from gapless.units import DEG


def _demand_circumference(circumference: float) -> None:
    demand(
        isfinite(circumference) and circumference > 0.0,
        f"a wheel of {circumference:g} m circumference",
        "give metres a turn, more than 0",
    )


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
    growth: Growth = BY_SPEED
    driven: bool = True

    def __post_init__(self) -> None:
        _demand_circumference(self.circumference)


class Gear(NamedTuple):
    """A gear: up to which speed [m/s], and turns of the engine per turn of the driven wheels."""

    until: float
    ratio: float


GEARS: Final = (Gear(4.5, 13.7), Gear(8.0, 7.7), Gear(13.0, 5.3), Gear(19.0, 3.85), Gear(inf, 3.12))
"""Five gears of a car, which take its engine to 1850 to 2200 turns a minute before each change. No ratio
is whole: or an order of the engine would be one of the wheels."""


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
    growth: Growth = BY_TURNS

    def __post_init__(self) -> None:
        _demand_circumference(self.circumference)
        demand(
            isfinite(self.idle) and self.idle > 0.0,
            f"an engine that idles at {self.idle:g} turns a second",
            "give more than 0",
        )
        bands = [0.0, *(g.until for g in self.gears)]
        demand(
            all(a < b for a, b in pairwise(bands)) and bands[-1] == inf,
            f"gears until {', '.join(f'{b:g}' for b in bands[1:]) or 'nothing'} m/s",
            "give rising speeds, the last of them inf",
        )
        demand(
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
    growth: Growth = BY_SPEED
    lowest: float = 3.0

    def __post_init__(self) -> None:
        demand(
            finite((*self.rate, *self.accel, self.lowest)),
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
        demand(finite([self.signal]), f"wheels cannot be {self.signal:g} times as loud", "give zero or more")
        for s in self.slips:
            demand(
                finite(s) and s.duration > 0.0,
                f"a slip of {s.duration:g} s from {s.start:g} s, ratio {s.ratio:g}",
                "give a start and a ratio of zero or more, and a positive duration",
            )
        for a, b in pairwise(sorted(self.slips)):
            demand(a.start + a.duration <= b.start, f"slips overlap at {b.start:g} s", "part or join them")


CAR: Final = Chassis()
"""A passenger car: one kind of tyres, a four-cylinder engine, asphalt."""
