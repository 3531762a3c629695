"""What a navigator writes down on its way; a replay never writes the same moment twice."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

import numpy as np

from gapless import attitude, earth
from gapless.inertial.belief import Belief
from gapless.inertial.layout import ROW, Layout
from gapless.trip.recording import Array, Trajectory
from gapless.trip.solution import Innovations
from gapless.units import DEG

KNOCK: Final = 8.0 * DEG
"""A box that was turned by less is not spoken of [rad]."""


class Knock(NamedTuple):
    """A box that was turned: when [s], by how much [rad], and what takes its axes to those of before."""

    time: float
    angle: float
    box: Array | None


@dataclass
class _Channel:
    time: list[float] = field(default_factory=list)
    z: list[Array] = field(default_factory=list)
    s: list[Array] = field(default_factory=list)
    nis: list[float] = field(default_factory=list)
    factor: list[float] = field(default_factory=list)

    def cut(self, n: int) -> None:
        for column in (self.time, self.z, self.s, self.nis, self.factor):
            del column[n:]


class Journal:
    """Rows, innovations and alignments.

    Parameters
    ----------
    layout : Layout
    misalignment : float
        Standard deviation of the box's axes against the sensors', which no motion shows [rad]. It is
        part of what is stated for the box: of attitude and mounting angles.
    """

    def __init__(self, layout: Layout, misalignment: float = 0.0) -> None:
        self.layout = layout
        cross = [(0, 1), (6, 7), (6, 8), (7, 8)]
        self._unseen = np.zeros(layout.n + len(cross))
        for name in ("attitude", "mounting"):
            self._unseen[layout.blocks.get(name, slice(0))] = misalignment**2
        self._kept = np.array([i * ROW + j for i, j in [*((i, i) for i in range(layout.n)), *cross]])
        self.last = -math.inf
        self.times: list[float] = []
        self.states: list[Array] = []
        self.variances: list[Array] = []
        self.shared: list[Array] = []
        self.sources: list[str] = []
        self.channels: dict[str, _Channel] = {}
        self.latest: dict[str, float] = {}
        self.alignments: list[tuple[float, str]] = []
        self.rulings: list[tuple[float, str, str]] = []
        self.ruled: dict[str, tuple[float, str]] = {}
        self.knocks: list[Knock] = []
        self.knocked = -math.inf
        self.moves: list[tuple[float, str, float]] = []

    def row(self, time: float, belief: Belief, shared: Array, source: str) -> None:
        """Write the belief down.

        Parameters
        ----------
        time : float
            [s]
        belief : Belief
        shared : ndarray, shape (3, 3)
            Covariance of the position on top of the belief's [m^2]; not to be changed later.
        source : str
            What holds it.
        """
        if time <= self.last:
            return
        self.last = time
        self.times.append(time)
        self.states.append(belief.estimate().copy())
        self.variances.append(belief.p[self._kept])
        self.shared.append(shared)
        self.sources.append(source)

    def innovation(self, channel: str, time: float, z: Array, s: Array, nis: float, factor: float) -> None:
        """Write an innovation down.

        Parameters
        ----------
        channel : str
        time : float
        z : ndarray, shape (m,)
        s : ndarray, shape (m, m)
            Predicted covariance of z.
        nis, factor : float
            As in `Innovations`.
        """
        if not self._news(channel, time):
            return
        c = self.channels.setdefault(channel, _Channel())
        c.time.append(time)
        c.z.append(z)
        c.s.append(s)
        c.nis.append(nis)
        c.factor.append(factor)

    def heard(self, channel: str, time: float, ruling: str) -> None:
        """Write down that a channel was silenced, or is heard again.

        Parameters
        ----------
        channel : str
        time : float
            [s]
        ruling : str
            "use", "silence", "believe" or "turn".
        """
        when, before = self.ruled.get(channel, (-math.inf, "use"))
        if time > when and ruling != before:
            self.rulings.append((time, channel, ruling))
            self.ruled[channel] = time, ruling

    def knock(self, time: float, angle: float, box: Array | None) -> None:
        """Write down that the box was turned.

        Parameters
        ----------
        time : float
            [s]
        angle : float
            By how much its gravity turned [rad].
        box : ndarray, shape (3, 3), or None
            Takes what it feels from then on to the axes in which it sat at first.
        """
        if time > self.knocked + 1.0:
            self.knocks.append(Knock(time, angle, box))
            self.knocked = time
        elif self.knocks:
            self.knocks[-1] = self.knocks[-1]._replace(box=box)

    def moved(self, time: float, what: str, size: float) -> None:
        """Write down that something else was found to have moved.

        Parameters
        ----------
        time : float
            [s]
        what : str
            "gyro": its zero [rad/s]; "heading": what the filter took for it [rad].
        size : float
            By how much.
        """
        if self._news("moves", time):
            self.moves.append((time, what, size))

    def align(self, time: float, evidence: str) -> None:
        """Write an alignment down.

        Parameters
        ----------
        time : float
        evidence : str
        """
        if self._news("alignments", time):
            self.alignments.append((time, evidence))

    def _news(self, what: str, time: float) -> bool:
        """Whether nothing so late was written down of it, here or where a fork began."""
        if time <= self.latest.get(what, -math.inf):
            return False
        self.latest[what] = time
        return True

    def mark(self) -> Any:
        """Where the journal stands, for `rewind`.

        Returns
        -------
        object
        """
        counts = {name: len(c.time) for name, c in self.channels.items()}
        return (
            self.last,
            len(self.times),
            counts,
            dict(self.latest),
            len(self.alignments),
            len(self.rulings),
            dict(self.ruled),
            len(self.knocks),
            self.knocked,
            len(self.moves),
        )

    def rewind(self, mark: Any) -> None:
        """Forget what was written after a mark.

        Parameters
        ----------
        mark : object
            From `mark`.
        """
        self.last, n, counts, latest, aligned, ruled, last, knocked, self.knocked, moved = mark
        self.latest, self.ruled = dict(latest), dict(last)
        for rows in (self.times, self.states, self.variances, self.shared, self.sources):
            del rows[n:]
        for name, channel in self.channels.items():
            channel.cut(counts.get(name, 0))
        del self.alignments[aligned:]
        del self.rulings[ruled:]
        del self.knocks[knocked:]
        del self.moves[moved:]

    def after(self, other: Journal) -> None:
        """Start empty where another journal stands.

        Parameters
        ----------
        other : Journal
        """
        self.last, self.latest = other.last, dict(other.latest)
        self.ruled, self.knocked = dict(other.ruled), other.knocked

    def trajectory(self) -> Trajectory:
        """All rows as a trajectory.

        Returns
        -------
        Trajectory
        """
        n = self.layout.n
        x, var = np.array(self.states).reshape(-1, n + 1), self._stated()
        euler = attitude.to_euler(x[:, 6:10])
        lla = np.column_stack([x[:, 0], earth.longitude(x[:, 1]), x[:, 2]])
        sd = np.sqrt(np.column_stack([var[:, :6], _euler_variance(var, n, euler)]))
        return Trajectory(
            np.array(self.times), lla, x[:, 3:6], euler, sd, var[:, n], np.array(self.sources, dtype=str)
        )

    def blocks(self) -> tuple[dict[str, Array], dict[str, Array]]:
        """Additive blocks at the rows, and their standard deviations.

        Returns
        -------
        states, sds : dict of str to ndarray, shape (rows, k)
        """
        x, var = np.array(self.states).reshape(-1, self.layout.n + 1), self._stated()
        names = [name for name, s in self.layout.blocks.items() if s.start >= 9]
        where = self.layout.blocks
        states = {name: x[:, where[name].start + 1 : where[name].stop + 1] for name in names}
        return states, {name: np.sqrt(var[:, where[name]]) for name in names}

    def _stated(self) -> Array:
        """Variances with what the filter does not know of: what fixes share, how the box is turned."""
        var = np.array(self.variances).reshape(-1, len(self._kept)) + self._unseen
        shared = np.array(self.shared).reshape(-1, 3, 3)
        var[:, :3] += np.diagonal(shared, axis1=1, axis2=2)
        var[:, self.layout.n] += shared[:, 0, 1]
        return var

    def innovations(self) -> dict[str, Innovations]:
        """Innovations by channel.

        Returns
        -------
        dict of str to Innovations
        """
        return {
            name: Innovations(
                np.array(c.time),
                np.array(c.z),
                np.sqrt(np.diagonal(np.array(c.s), axis1=1, axis2=2)),
                np.array(c.nis),
                np.array(c.factor),
            )
            for name, c in self.channels.items()
            if c.time
        }


def _euler_variance(var: Array, n: int, euler: Array) -> Array:
    """Variances of roll, pitch, heading from those of the rotation vector in NED.

    d(heading) = phi_d + tan(pitch) (cos(heading) phi_n + sin(heading) phi_e), d(pitch) =
    -sin(heading) phi_n + cos(heading) phi_e, d(roll) = (cos(heading) phi_n + sin(heading) phi_e)
    / cos(pitch).
    """
    c, s = np.cos(euler[:, 2]), np.sin(euler[:, 2])
    nn, ee, dd = var[:, 6], var[:, 7], var[:, 8]
    ne, nd, ed = var[:, n + 1], var[:, n + 2], var[:, n + 3]
    along = c * c * nn + s * s * ee + 2.0 * c * s * ne
    across = s * s * nn + c * c * ee - 2.0 * c * s * ne
    t = np.tan(euler[:, 1])
    heading = dd + t * t * along + 2.0 * t * (c * nd + s * ed)
    variances = np.column_stack([along / np.cos(euler[:, 1]) ** 2, across, heading])
    return np.asarray(np.maximum(variances, 0.0))
