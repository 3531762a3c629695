"""Harmonics of something that turns: at which orders it shakes a car, how much, and how that grows.

An *order* is a frequency counted in cycles per turn: a tyre that is not quite round or balanced shakes the
chassis at whole orders of its own, an engine at multiples of half a turn. Amplitudes are those of the
chassis where the box sits, in the car's axes, before any sensor.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gapless.errors import ConfigError
from gapless.units import DEG

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


def demand(holds: bool, what: str, cure: str) -> None:
    """Refuse what does not hold.

    Parameters
    ----------
    holds : bool
    what, cure : str
        What was given, and what to give instead.

    Raises
    ------
    ConfigError
        If it does not.
    """
    if not holds:
        raise ConfigError(f"{what}; {cure}")


def finite(values: Iterable[float]) -> bool:
    """Whether numbers are finite and none is negative.

    Parameters
    ----------
    values : iterable of float

    Returns
    -------
    bool
    """
    return all(isfinite(v) and v >= 0.0 for v in values)


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
        demand(
            isfinite(self.order) and self.order > 0.0,
            f"a harmonic of order {self.order:g}",
            "give cycles per turn, more than 0",
        )
        demand(
            finite((*self.rate, *self.accel)),
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
        demand(
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


BY_SPEED: Final = Growth(15.0)
"""In proportion to a speed [m/s], up to 30."""
BY_TURNS: Final = Growth(30.0)
"""In proportion to turns per second [1/s], up to 60."""


def _harmonic(order: float, rate: Triple, accel: Triple) -> Harmonic:
    """A harmonic with its rates in deg/s."""
    return Harmonic(order, (rate[0] * DEG, rate[1] * DEG, rate[2] * DEG), accel)


TYRE: Final = (
    _harmonic(1.0, (0.08, 0.07, 0.04), (0.030, 0.030, 0.050)),
    _harmonic(2.0, (0.10, 0.09, 0.04), (0.040, 0.050, 0.080)),
    _harmonic(3.0, (0.08, 0.07, 0.03), (0.030, 0.040, 0.060)),
    _harmonic(4.0, (0.07, 0.06, 0.03), (0.030, 0.030, 0.050)),
    _harmonic(5.0, (0.06, 0.05, 0.03), (0.020, 0.030, 0.040)),
    _harmonic(6.0, (0.05, 0.05, 0.02), (0.020, 0.020, 0.040)),
    _harmonic(7.0, (0.04, 0.04, 0.02), (0.020, 0.020, 0.030)),
)
"""Orders of a car's tyres at 15 m/s, of the size that logs of real cars show at 11 to 19 m/s."""

MOTOR: Final = (
    _harmonic(0.5, (0.02, 0.02, 0.01), (0.010, 0.010, 0.010)),
    _harmonic(1.0, (0.04, 0.04, 0.02), (0.020, 0.020, 0.020)),
    _harmonic(2.0, (0.10, 0.06, 0.04), (0.040, 0.040, 0.060)),
    _harmonic(4.0, (0.04, 0.03, 0.02), (0.020, 0.020, 0.030)),
)
"""Orders of a four-cylinder engine at 30 turns a second: two ignitions a turn."""
