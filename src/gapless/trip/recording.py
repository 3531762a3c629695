"""What one trip measured: frozen columns in SI units, radians, FRD body axes and one clock.

Time is float seconds on the recording's IMU clock; a GNSS or odometer stamp is kept as logged
(`Recording.clock` and the navigator turn it into IMU time, they never rewrite it).
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Columns:
    """Arrays that share their first axis, the first of which is `time` [s], increasing."""

    time: Array

    def __len__(self) -> int:
        return len(self.time)

    def take(self, index: Any) -> Self:
        """Rows chosen by a slice, a mask or indices.

        Parameters
        ----------
        index : slice or ndarray

        Returns
        -------
        Columns
            Of the same class; single values are kept.
        """
        n = len(self)
        chosen = {}
        for f in fields(self):
            value = getattr(self, f.name)
            if isinstance(value, np.ndarray) and value.ndim and len(value) == n:
                chosen[f.name] = value[index]
        return replace(self, **chosen)

    def slice(self, start: float, end: float) -> Self:
        """Rows with start <= time < end.

        Parameters
        ----------
        start, end : float
            [s]

        Returns
        -------
        Columns
        """
        a, b = np.searchsorted(self.time, [start, end])
        return self.take(slice(int(a), int(b)))


@dataclass(frozen=True, eq=False)
class Imu(Columns):
    """Increments over intervals that end at `time`, in forward-right-down body axes.

    Parameters
    ----------
    time : ndarray, shape (n,)
        End of each interval [s].
    dt : ndarray, shape (n,)
        Length of each interval [s], > 0. Where `time[k] - dt[k]` is later than `time[k - 1]`, the
        log has a gap.
    dtheta : ndarray, shape (n, 3)
        Integral of the angular rate over the interval [rad].
    dvel : ndarray, shape (n, 3)
        Integral of the specific force over the interval [m/s].
    """

    dt: Array
    dtheta: Array
    dvel: Array

    @classmethod
    def from_rates(cls, time: Array, gyro: Array, accel: Array, dt: Array | None = None) -> Imu:
        """Increments of sampled rates, each taken as the mean over the interval that ends at its stamp.

        Parameters
        ----------
        time : ndarray, shape (n,)
            Stamps [s], increasing.
        gyro, accel : ndarray, shape (n, 3)
            Angular rate [rad/s] and specific force [m/s^2], FRD.
        dt : ndarray, shape (n,), optional
            Interval lengths [s]; stamp differences, the first the median, if not given.

        Returns
        -------
        Imu
        """
        if dt is None:
            dt = np.diff(time, prepend=time[0] - float(np.median(np.diff(time))))
        return cls(time, dt, gyro * dt[:, None], accel * dt[:, None])

    @property
    def rate(self) -> float:
        """Samples per second (from the median interval)."""
        return float(1.0 / np.median(self.dt))


@dataclass(frozen=True, eq=False)
class Gnss(Columns):
    """Fixes of a receiver, as logged.

    Parameters
    ----------
    time : ndarray, shape (m,)
        Logged stamp [s].
    lla : ndarray, shape (m, 3)
        Latitude, longitude [rad], height [m] of the antenna; NaN rows where there is no position.
    sd_position : ndarray, shape (m, 3)
        Stated standard deviation north, east, down [m].
    v_n : ndarray, shape (m, 3)
        Velocity north, east, down [m/s]; NaN rows where there is none.
    sd_velocity : ndarray, shape (m, 3)
        Its stated standard deviation [m/s].
    fix : ndarray, shape (m,)
        1 single, 2 differential, 4 RTK fixed, 5 RTK float.
    """

    lla: Array
    sd_position: Array
    v_n: Array
    sd_velocity: Array
    fix: NDArray[np.int64]

    @property
    def has_velocity(self) -> bool:
        """Whether any fix carries a velocity."""
        return bool(np.isfinite(self.v_n).any())


@dataclass(frozen=True, eq=False)
class Odometer(Columns):
    """Wheel speed.

    Parameters
    ----------
    time : ndarray, shape (k,)
        Logged stamp [s].
    speed : ndarray, shape (k,)
        Forward speed [m/s] as the odometer reads it.
    """

    speed: Array


@dataclass(frozen=True, eq=False)
class Trajectory(Columns):
    """A path with attitude and uncertainty: a reference, or what a navigator found.

    Parameters
    ----------
    time : ndarray, shape (n,)
        On the IMU clock [s].
    lla : ndarray, shape (n, 3)
        Latitude, longitude [rad], height [m].
    v_n : ndarray, shape (n, 3)
        Velocity north, east, down [m/s]; NaN where unknown.
    euler : ndarray, shape (n, 3)
        Roll, pitch, heading of the box [rad]; NaN where unknown.
    sd : ndarray, shape (n, 9)
        One standard deviation of position north, east, down [m], velocity [m/s], roll, pitch,
        heading [rad]; NaN where unknown.
    horizontal : ndarray, shape (n,)
        Covariance between the north and east position errors [m^2]; NaN where unknown.
    source : ndarray of str, shape (n,)
        What held the row: "gnss", "bridge", "constraints", "ins" or "reference".
    """

    lla: Array
    v_n: Array
    euler: Array
    sd: Array
    horizontal: Array
    source: NDArray[np.str_]


@dataclass(frozen=True)
class Note:
    """Something a reader mended or noticed, for the user to see.

    Parameters
    ----------
    where : str
        The sensor or file.
    what : str
        One clause that says what was found and what was done.
    count : int
        How many rows it touched.
    """

    where: str
    what: str
    count: int = 0


@dataclass(frozen=True, eq=False)
class Recording:
    """Everything measured on one trip.

    Parameters
    ----------
    name : str
        What the user calls it.
    imu : Imu
        Increments in FRD.
    gnss : Gnss
        Fixes on their own, logged clock.
    odometer : Odometer, optional
    reference : Trajectory, optional
        Truth to score against; never used to navigate.
    reference_clock : str
        "imu" or "gnss": whose clock the reference's stamps are on.
    lever_arm : ndarray, shape (3,), optional
        Antenna from the IMU, FRD [m]; None where nobody told it, which is not the same as zero.
    grade : str, optional
        Named sensor grade, if the recording states one.
    notes : tuple of Note
        What the reader mended.
    """

    name: str
    imu: Imu
    gnss: Gnss
    odometer: Odometer | None = None
    reference: Trajectory | None = None
    reference_clock: str = "imu"
    lever_arm: Array | None = None
    grade: str | None = None
    notes: tuple[Note, ...] = ()

    @property
    def start(self) -> float:
        """Time of the first IMU sample [s]; outages are counted from it."""
        return float(self.imu.time[0])

    @property
    def duration(self) -> float:
        """Seconds from the first to the last IMU sample."""
        return float(self.imu.time[-1] - self.imu.time[0])

    def slice(self, start: float, end: float) -> Recording:
        """The recording as it was logged in start <= time < end (by arrival, every sensor).

        Parameters
        ----------
        start, end : float
            [s] on the logged clocks.

        Returns
        -------
        Recording
        """
        return replace(
            self,
            imu=self.imu.slice(start, end),
            gnss=self.gnss.slice(start, end),
            odometer=None if self.odometer is None else self.odometer.slice(start, end),
            reference=None if self.reference is None else self.reference.slice(start, end),
        )
