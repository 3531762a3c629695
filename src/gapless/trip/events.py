"""What a navigator is fed: blocks of IMU samples and readings of other sensors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gapless.trip.recording import Array, Imu

EPS = 1e-6
"""Times closer than this are the same instant [s]."""
GAP = 2.5
"""A longer silence of the IMU is not bridged: it ends in a new alignment [s]."""


class Reading(NamedTuple):
    """One value that a sensor logged.

    Parameters
    ----------
    channel : str
        Name of the sensor model that understands it: "position", "velocity", "odometer".
    time : float
        When the value held, IMU clock [s].
    value : ndarray
        lat, lon, h [rad, rad, m]; v_n [m/s]; (speed,) [m/s].
    sd : ndarray
        Standard deviations [m or m/s].
    interval : float
        Seconds since the sensor's last reading.
    """

    channel: str
    time: float
    value: Array
    sd: Array
    interval: float


class ImuBlock(NamedTuple):
    """Consecutive IMU samples: the columns of `Imu`.

    Parameters
    ----------
    time, dt : ndarray, shape (k,)
        End and length of each interval [s].
    dtheta, dvel : ndarray, shape (k, 3)
        Increments [rad], [m/s], FRD.
    """

    time: Array
    dt: Array
    dtheta: Array
    dvel: Array

    @classmethod
    def of(cls, imu: Imu, first: int, last: int) -> ImuBlock:
        """Samples first..last-1 of a recording's IMU.

        Parameters
        ----------
        imu : Imu
        first, last : int

        Returns
        -------
        ImuBlock
        """
        s = slice(first, last)
        return cls(imu.time[s], imu.dt[s], imu.dtheta[s], imu.dvel[s])

    def rows(self, first: int, last: int) -> ImuBlock:
        """Samples first..last-1 of the block.

        Parameters
        ----------
        first, last : int

        Returns
        -------
        ImuBlock
        """
        s = slice(first, last)
        return ImuBlock(self.time[s], self.dt[s], self.dtheta[s], self.dvel[s])

    def within(self, begin: float, end: float) -> ImuBlock:
        """Samples whose intervals end between two times, these included.

        Parameters
        ----------
        begin, end : float
            [s]

        Returns
        -------
        ImuBlock
        """
        first, last = int(self.time.searchsorted(begin)), int(self.time.searchsorted(end, side="right"))
        return self.rows(first, last)

    @staticmethod
    def join(blocks: list[ImuBlock]) -> ImuBlock:
        """Blocks that follow each other as one.

        Parameters
        ----------
        blocks : list of ImuBlock

        Returns
        -------
        ImuBlock
        """
        return ImuBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


Event = ImuBlock | tuple[Reading, ...]
"""IMU samples, or the readings that arrived together."""


class Motion(NamedTuple):
    """What the IMU felt over one tick, corrected for bias.

    Parameters
    ----------
    time : float
        End of the tick [s].
    dt : float
        Its length [s].
    felt : ndarray, shape (6,)
        Mean body rate [rad/s], then mean specific force [m/s^2].
    """

    time: float
    dt: float
    felt: Array

    @property
    def rate(self) -> Array:
        """Mean body rate [rad/s]."""
        return self.felt[:3]

    @property
    def force(self) -> Array:
        """Mean specific force [m/s^2]."""
        return self.felt[3:]
