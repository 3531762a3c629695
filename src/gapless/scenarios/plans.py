"""Where outages lie: at regular distances, at random, in the gaps there are, where the car turns or stands.

Where an outage lies may be chosen from the whole recording; what navigates never sees the choice.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from gapless.attitude import wrap
from gapless.errors import ConfigError
from gapless.scenarios.effects import SILENT, Effect
from gapless.scenarios.outage import Drive, Outage, duration_of, seconds, suffix
from gapless.trip.motion import Motion, horizontal_velocity, motion
from gapless.trip.recording import Gnss, Recording
from gapless.units import DEG

_APART: Final = 30.0
"""Random outages keep this far apart [s], or half of what `every` leaves."""
_TURN_RATE, _TURN_SPEED = 8.0 * DEG, 2.0
"""A turn: the course changes faster [rad/s], the car moves faster [m/s]."""
_STILL, _STILL_FOR = 0.5, 2.0
"""A stop: slower [m/s], and for that long already [s]."""
_FAST: Final = 0.8
"""Speed: this share of what the drive passes in one moving epoch of twenty."""


class Plan(Protocol):
    """Says where the outages of a recording lie."""

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """Outages of a recording, in order of time.

        Parameters
        ----------
        drive : Recording or float

        Returns
        -------
        tuple of Outage
        """
        ...


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
    effect : Effect
    """

    every: float
    length: float
    first: float
    shift: float = 0.0
    effect: Effect = SILENT

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """The outages that end within the recording.

        Parameters
        ----------
        drive : Recording or float

        Returns
        -------
        tuple of Outage
        """
        begin = self.first + self.shift
        count = max(0, math.floor((duration_of(drive) - self.length - begin) / self.every) + 1)
        starts = (begin + k * self.every for k in range(count))
        return tuple(Outage(s, s + self.length, self.effect) for s in starts)

    def __str__(self) -> str:
        keys = ("every", "length", "first", "shift")
        return ",".join(f"{key}={seconds(getattr(self, key))}" for key in keys) + suffix(self.effect)


@dataclass(frozen=True)
class Random:
    """Outages of equal length at random.

    Parameters
    ----------
    every : float
        There is one in so many seconds, on average.
    length : float
        Of each outage [s], shorter than `every`.
    first : float
        None begins earlier [s] after the first IMU sample.
    seed : int
    effect : Effect
    """

    every: float
    length: float
    first: float
    seed: int = 0
    effect: Effect = SILENT

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """The outages, all within the recording and apart from each other.

        Parameters
        ----------
        drive : Recording or float

        Returns
        -------
        tuple of Outage
        """
        span = duration_of(drive) - self.first
        count = max(0, math.floor(span / self.every))
        step = self.length + min(_APART, 0.5 * (self.every - self.length))
        # sorted uniforms on what room there is, moved apart: every arrangement is as likely
        room = np.sort(np.random.default_rng(self.seed).uniform(0.0, max(0.0, span - count * step), count))
        starts = np.round(self.first + room + step * np.arange(count), 3).tolist()
        return tuple(Outage(s, s + self.length, self.effect) for s in starts)

    def __str__(self) -> str:
        where = f"random={seconds(self.every)},length={seconds(self.length)},first={seconds(self.first)}"
        return f"{where},seed={self.seed}{suffix(self.effect)}"


@dataclass(frozen=True)
class Gaps:
    """The stretches in which the recording itself has no position; nothing is withheld.

    Parameters
    ----------
    least : float
        Length from which a gap counts [s].
    """

    least: float

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """The gaps between the first position and the last.

        Parameters
        ----------
        drive : Recording

        Returns
        -------
        tuple of Outage
            From one median interval after the last position to the first one again.
        """
        recording = _looked_into(drive, str(self))
        time = recording.gnss.time[np.isfinite(recording.gnss.lla).all(axis=1)] - recording.start
        if len(time) < 2:
            return ()
        usual = float(np.median(np.diff(time)))
        found = np.flatnonzero(np.diff(time) - usual >= self.least)
        real = Effect("real")
        return tuple(
            Outage(float(time[k]) + usual, float(time[k + 1]), real) for k in found if time[k] >= 0.0
        )

    def __str__(self) -> str:
        return f"gaps={seconds(self.least)}"


@dataclass(frozen=True)
class At:
    """Outages that begin in a turn, at a stop or at speed, as GNSS saw the drive.

    Parameters
    ----------
    place : str
        A key of `PLACES`.
    every : float
        Least time from start to start [s].
    length : float
        Of each outage [s].
    first : float
        None begins earlier [s] after the first IMU sample.
    effect : Effect
    """

    place: str
    every: float
    length: float
    first: float
    effect: Effect = SILENT

    def expand(self, drive: Drive) -> tuple[Outage, ...]:
        """The first moment of that kind, the next one at least `every` later, and so on.

        Parameters
        ----------
        drive : Recording

        Returns
        -------
        tuple of Outage
        """
        recording = _looked_into(drive, str(self))
        moved = _motion(recording.gnss)
        chosen: list[Outage] = []
        for time in (moved.time[PLACES[self.place](moved)] - recording.start).tolist():
            begin = math.floor(1000.0 * time) / 1000.0
            soonest = chosen[-1].start + self.every if chosen else self.first
            if begin >= soonest and begin + self.length <= recording.duration:
                chosen.append(Outage(begin, begin + self.length, self.effect))
        return tuple(chosen)

    def __str__(self) -> str:
        where = ",".join(f"{key}={seconds(getattr(self, key))}" for key in ("every", "length", "first"))
        return f"at={self.place},{where}{suffix(self.effect)}"


def _motion(gnss: Gnss) -> Motion:
    gnss = gnss.take(np.isfinite(gnss.lla).all(axis=1))
    moved = motion(gnss.time, horizontal_velocity(gnss.time, gnss.lla, gnss.v_n))
    return replace(moved, speed=np.nan_to_num(moved.speed), course=np.nan_to_num(moved.course))


def _turning(moved: Motion) -> NDArray[np.bool_]:
    """Course against that of a second ago and a second ahead."""
    t = moved.time
    before = np.searchsorted(t, t - 1.0 - 1e-6)
    after = np.searchsorted(t, t + 1.0 + 1e-6, side="right") - 1
    span = np.maximum(t[after] - t[before], 1e-3)
    rate = np.abs(wrap(moved.course[after] - moved.course[before])) / span
    slowest = np.minimum(moved.speed[before], moved.speed[after])
    return np.asarray((rate > _TURN_RATE) & (slowest > _TURN_SPEED) & (span < 3.0))


def _standing(moved: Motion) -> NDArray[np.bool_]:
    """Slow now and since at least `_STILL_FOR`."""
    moving = np.where(moved.speed >= _STILL, moved.time, -np.inf)
    return np.asarray(moved.time - np.maximum.accumulate(moving) >= _STILL_FOR)


def _fast(moved: Motion) -> NDArray[np.bool_]:
    driven = moved.speed[moved.speed > _TURN_SPEED]
    if not len(driven):
        return np.zeros(len(moved), bool)
    return np.asarray(moved.speed >= _FAST * float(np.percentile(driven, 95.0)))


PLACES: Final[dict[str, Callable[[Motion], NDArray[np.bool_]]]] = {
    "turn": _turning,
    "stop": _standing,
    "speed": _fast,
}
"""What `at=` understands."""


def _looked_into(drive: Drive, text: str) -> Recording:
    if isinstance(drive, Recording):
        return drive
    raise ConfigError(f"outage {text!r}: it is found in a recording; give the recording, not its duration")
