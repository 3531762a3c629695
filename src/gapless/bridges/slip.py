"""Whether wheels roll or slip, judged by how their readings follow the inertial course of the speed.

Over seconds an inertial sensor knows how the speed changed far better than how fast the car is. So the
readings less that course hardly change while wheels roll, leap where they spin or are braked, and leap back
where they find hold. Two hypotheses, each with what it takes the course to be off by; either lasts. It is a
switching Kalman filter whose branches are merged by moments after each reading (Bar-Shalom, Li and
Kirubarajan 2001, *Estimation with Applications to Tracking and Navigation*, ch. 11.6). A filter that is
wrong is told from wheels that slip for long by this: a slip has to go on, second by second.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple, Self

BEGINS: Final = 1.0 / 100.0
"""Rate at which rolling wheels begin to slip [1/s]."""
ENDS: Final = 1.0 / 8.0
"""Rate at which slipping ones find hold again [1/s]."""
SIZE: Final = 0.1
"""Standard deviation of a slip, as a share of the speed."""
CHANGES: Final = 0.01
"""By how much a slip changes in a second, as a share of the speed."""
STRAYS: Final = 0.001
"""So many of the leaps are the filter's, and stay. What lasts for half a minute is therefore no slip."""
OFTEN: Final = BEGINS / (BEGINS + ENDS)
"""Share of time in which wheels slip."""
LEAST: Final = 1e-9
"""No hypothesis becomes less likely than this: it must be able to come back."""


class Gauss(NamedTuple):
    """A normal distribution."""

    mean: float
    variance: float

    def wider(self, by: float) -> Gauss:
        """With more variance."""
        return Gauss(self.mean, self.variance + by)

    def given(self, seen: float, variance: float, slope: float = 1.0) -> Gauss:
        """After `slope` times it was seen, with a variance."""
        gain = slope * self.variance / (slope**2 * self.variance + variance)
        return Gauss(
            self.mean + gain * (seen - slope * self.mean), max(1.0 - gain * slope, 0.0) * self.variance
        )

    def log(self, seen: float) -> float:
        """Log density, but for a constant."""
        return -0.5 * (math.log(self.variance) + (seen - self.mean) ** 2 / self.variance)

    def or_(self, other: Gauss, share: float) -> Gauss:
        """One normal with the moments of both, `share` being the other's."""
        mean = self.mean + share * (other.mean - self.mean)
        spread = share * (1.0 - share) * (other.mean - self.mean) ** 2
        return Gauss(mean, self.variance + share * (other.variance - self.variance) + spread)


NEW: Final = Gauss(0.0, SIZE**2)
"""A slip that begins."""


class Hold(NamedTuple):
    """How well the wheels are believed to hold the road.

    Parameters
    ----------
    time : float
        Of the last reading, or of the beginning of the silence [s].
    drift : float
        What the inertial course may gain, as a standard deviation [m/s^2].
    rolling, slipping : Gauss
        By how much the car is faster than the inertial course, if wheels roll now and if they slip [m/s].
    size : Gauss
        By how much wheels turn faster than the car, if they slip, as a share of the speed.
    slips : float
        Probability that they do.
    """

    time: float
    drift: float
    rolling: Gauss
    slipping: Gauss
    size: Gauss = NEW
    slips: float = OFTEN

    @property
    def rolls(self) -> float:
        """Probability that the wheels roll."""
        return 1.0 - self.slips

    @classmethod
    def begin(cls, time: float, variance: float, drift: float) -> Self:
        """Nothing read yet.

        Parameters
        ----------
        time : float
            [s]
        variance : float
            Of the filter's speed [m^2/s^2].
        drift : float
            [m/s^2]

        Returns
        -------
        Hold
        """
        sure = Gauss(0.0, variance)
        return cls(time, drift, sure, sure)

    def after(self, time: float, seen: float, variance: float, speed: float) -> Self:
        """What is believed after another reading.

        Parameters
        ----------
        time : float
            [s]
        seen : float
            The reading less the inertial course [m/s].
        variance : float
            Of a reading by itself [m^2/s^2].
        speed : float
            The filter's [m/s].

        Returns
        -------
        Hold
        """
        dt = time - self.time
        gained, changed = (self.drift * dt) ** 2, 1.0 - math.exp(-(BEGINS + ENDS) * dt)
        starts, stops = self.rolls * changed * OFTEN, self.slips * changed * (1.0 - OFTEN)
        roll, slip = self.rolling.wider(gained), self.slipping.wider(gained)
        size, wide = self.size.wider(CHANGES**2 * dt), (SIZE * speed) ** 2
        on = Gauss(slip.mean + speed * size.mean, speed**2 * size.variance + gained)
        fits = (
            (self.rolls - starts, roll),
            (stops, slip),
            (starts * STRAYS, roll.wider(wide)),
            (starts * (1.0 - STRAYS), roll.wider(wide)),
            (self.slips - stops, on),
        )
        w = _normed([math.log(max(p, LEAST)) + fit.wider(variance).log(seen) for p, fit in fits])
        rolling = roll.given(seen, variance).or_(slip.given(seen, variance), w[1] / (w[0] + w[1]))
        stray = roll.wider(wide).given(seen, variance)
        fresh, lasts = NEW.given(seen - roll.mean, variance, speed), w[4] / (w[3] + w[4])
        slips = min(max(w[3] + w[4], LEAST), 1.0 - LEAST)
        return self._replace(
            time=time,
            rolling=rolling.or_(stray, w[2] / (w[0] + w[1] + w[2])),
            slipping=roll.or_(slip, lasts),
            size=fresh.or_(size.given(seen - slip.mean, variance, speed), lasts),
            slips=slips,
        )


def _normed(logs: list[float]) -> list[float]:
    """Probabilities out of log weights, none of them zero."""
    most = max(logs)
    weights = [math.exp(max(log - most, -80.0)) for log in logs]
    total = sum(weights)
    return [w / total for w in weights]
