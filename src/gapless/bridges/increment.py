"""The way that GNSS goes from epoch to epoch as what is learned: O_INS-dP_GNSS.

In an outage increments are summed from the last fix into a quasi-GNSS position. Liu et al. 2019 show the
learner the INS velocity, specific force and angular rate; Tan et al. 2015 (eq. 22, 23) the integrals of
force and rate over the epoch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gapless import earth
from gapless.bridges.epochs import Epoch, features
from gapless.bridges.model import Part
from gapless.inertial.belief import Belief
from gapless.measurements.base import Sensor
from gapless.trip.events import Reading
from gapless.trip.recording import Array


class Course(NamedTuple):
    """How far the model has come in an outage.

    Parameters
    ----------
    fix : ndarray, shape (3,)
        The last one: latitude, longitude [rad], height [m] of the antenna.
    way : ndarray, shape (3,)
        Since then, NED [m].
    """

    fix: Array
    way: Array


@dataclass(frozen=True)
class IncrementModel:
    """INS -> GNSS position increment, learned per second: epochs need not be equally long.

    Parameters
    ----------
    features : tuple of str
        From `FEATURES`.
    axes : int
        2 for north and east, 3 for down too.
    sensor : Sensor
        For antenna and lever arm.
    """

    features: tuple[str, ...]
    axes: int
    sensor: Sensor

    @property
    def outputs(self) -> int:
        """See `Model`."""
        return self.axes

    def pairs(self, epochs: Sequence[Epoch]) -> tuple[Array, Array]:
        """See `Model`."""
        rows, targets = [], []
        for before, epoch in pairwise(epochs):
            if not np.isnan(epoch.dt):
                way = earth.lla_to_ned(epoch.fix, before.fix)[: self.axes]
                rows.append(features(self.features, epoch))
                targets.append(way / epoch.dt)
        if not rows:
            return np.zeros((0, 1)), np.zeros((0, 1))
        x, y = np.array(rows).reshape(len(rows), -1), np.array(targets).reshape(len(rows), -1)
        good = np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)
        return x[good], y[good]

    def begin(self, epochs: Sequence[Epoch], fix: Array) -> Course:
        """See `Model`."""
        return Course(fix, np.zeros(3))

    def row(self, course: Course, epoch: Epoch) -> Array:
        """See `Model`."""
        return features(self.features, epoch)

    def carry(self, course: Course, epoch: Epoch, y: Array) -> Course:
        """See `Model`: P_k = P_i + sum of increments (Tan et al. 2015, eq. 23)."""
        way = course.way.copy()
        way[: self.axes] += y * epoch.dt
        return Course(course.fix, way)

    def wrong(self, course: Course, epoch: Epoch) -> dict[str, Array]:
        """See `Model`."""
        return {"position": (course.way - earth.lla_to_ned(epoch.fix, course.fix))[: self.axes]}

    def say(self, course: Course, belief: Belief, epoch: Epoch) -> list[Part]:
        """See `Model`."""
        place = earth.ned_to_lla(course.way, course.fix)
        o = self.sensor.observe(belief, Reading("position", epoch.time, place, np.ones(3), epoch.dt))
        return [Part("position", o.z[: self.axes], o.H[: self.axes])]
