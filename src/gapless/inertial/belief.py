"""The belief: nominal state and covariance, and how an error estimate enters them."""

from __future__ import annotations

from typing import Final, Self

import numpy as np

from gapless import attitude, earth
from gapless._numba import kernel
from gapless.attitude import product
from gapless.inertial import propagate as at
from gapless.inertial.layout import ROW, Layout
from gapless.inertial.trail import Trail
from gapless.trip.recording import Array
from gapless.units import DEG

CORE_STATES: Final = 15
TILTED: Final = 3.0 * DEG
"""Roll and pitch may have changed by this in a long silence: ramps and hills."""
SECONDS: Final = 5.0
"""In which a tilt shows in the velocity, for `Belief.doubt`."""


@kernel
def inject(x: Array, dx: Array) -> None:
    """X (+) dx: position in metres, attitude by rotation vector, the rest added.

    Parameters
    ----------
    x : ndarray, shape (n + 1,)
        Nominal state, changed in place.
    dx : ndarray, shape (n,)
        Error estimate, truth = estimate (+) dx.
    """
    r_m, r_n = earth.radii(np.sin(x[0]))
    x[1] += dx[1] / ((r_n + x[2]) * np.cos(x[0]))
    x[0] += dx[0] / (r_m + x[2])
    x[2] -= dx[2]
    for i in range(3):
        x[3 + i] += dx[3 + i]
    angle = np.sqrt(dx[6] * dx[6] + dx[7] * dx[7] + dx[8] * dx[8])
    k = 0.5 if angle < 1e-9 else np.sin(0.5 * angle) / angle
    q = product((np.cos(0.5 * angle), k * dx[6], k * dx[7], k * dx[8]), (x[6], x[7], x[8], x[9]))
    norm = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    x[6], x[7], x[8], x[9] = q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm
    for i in range(9, dx.size):
        x[i + 1] += dx[i]


class Belief:
    """Nominal state and covariance at one time; `Navigator` is the only one that changes it.

    Parameters
    ----------
    layout : Layout
        Which error states there are.
    open_loop : bool
        Keep the error estimate beside an uncorrected nominal state (feed-forward) instead of
        feeding it back.
    trail : float
        Seconds of past velocity kept, for sensors that average.

    Attributes
    ----------
    x : ndarray, shape (n + 1,)
        lat, lon [rad], height [m], v_n [m/s], q_nb, then every additive block in layout order.
    memory : ndarray
        What the propagation kernel carries from sample to sample.
    p : ndarray, shape (1024,)
        Covariance, flat, rows of `ROW`.
    error : ndarray, shape (width,) or (0,)
        Open-loop error estimate.
    trail : Trail
    """

    __slots__ = ("error", "layout", "memory", "p", "scratch", "trail", "x")

    def __init__(self, layout: Layout, open_loop: bool = False, trail: float = 0.0) -> None:
        self.layout = layout
        self.x = np.zeros(layout.n + 1)
        self.x[at.QUAT] = 1.0
        self.memory = np.zeros(at.MEMORY_SIZE)
        self.p = np.zeros(ROW * ROW)
        self.scratch = np.empty((2, ROW * ROW))
        self.error = np.zeros(layout.width if open_loop else 0)
        self.trail = Trail(trail)

    def copy(self) -> Self:
        """An independent belief with the same content.

        Returns
        -------
        Belief
        """
        new = object.__new__(type(self))
        new.layout, new.scratch = self.layout, np.empty_like(self.scratch)
        new.x, new.memory = self.x.copy(), self.memory.copy()
        new.p, new.error = self.p.copy(), self.error.copy()
        new.trail = self.trail.copy() if self.trail.length else self.trail
        return new

    @property
    def time(self) -> float:
        """IMU time that the state holds for [s]."""
        return float(self.memory[at.TIME])

    @property
    def P(self) -> Array:
        """Covariance, a view of shape (n, n)."""
        n = self.layout.n
        return self.p.reshape(ROW, ROW)[:n, :n]

    @property
    def lla(self) -> Array:
        """Latitude, longitude [rad], height [m] of the nominal state (a view)."""
        return self.x[:3]

    @property
    def v_n(self) -> Array:
        """Velocity north, east, down [m/s] of the nominal state (a view)."""
        return self.x[3:6]

    @property
    def q_nb(self) -> Array:
        """Attitude quaternion of the nominal state (a view)."""
        return self.x[6:10]

    @property
    def C_nb(self) -> Array:
        """Direction cosine matrix of the nominal state."""
        return attitude.to_matrix(self.q_nb)

    def block(self, name: str) -> Array:
        """A block of additive states, such as "gyro_bias" (a view).

        Parameters
        ----------
        name : str
            From the layout, not position, velocity or attitude.

        Returns
        -------
        ndarray
        """
        s = self.layout.blocks[name]
        return self.x[s.start + 1 : s.stop + 1]

    def set_sd(self, name: str, sd: float | Array) -> None:
        """Forget all that is known of a block: variance sd^2, no correlations.

        Parameters
        ----------
        name : str
        sd : float or ndarray
            One standard deviation.
        """
        s = self.layout.blocks[name]
        p = self.p.reshape(ROW, ROW)
        p[s, :] = 0.0
        p[:, s] = 0.0
        index = np.arange(s.start, s.stop)
        p[index, index] = np.square(sd)

    def course_heading(self, sd: float) -> None:
        """Take the heading to come from a course: the course less the mounting yaw, sharing its error.

        Parameters
        ----------
        sd : float
            One standard deviation of the course [rad].
        """
        p = self.p.reshape(ROW, ROW)
        p[8, 8] = sd * sd
        if "mounting" in self.layout:
            yaw = self.layout.blocks["mounting"].start + 1
            p[8, 8] += p[yaw, yaw]
            p[8, yaw] = p[yaw, 8] = -p[yaw, yaw]

    def stray(self, doubt: Array, seconds: float) -> None:
        """Doubt what was guessed of the motion over some time: a car goes where it points.

        A turn that was missed has turned the velocity too, and so is no news to a constraint that
        compares the two. What the lateral force tells of it is taken out of its doubt.

        Parameters
        ----------
        doubt : ndarray, shape (4,)
            As in `Filling`.
        seconds : float
            For how long.
        """
        c, turn, gains = self.C_nb, seconds * doubt[0], seconds * doubt[1:]
        swept = turn * np.square(np.cross([0.0, 0.0, 1.0], c.T @ self.v_n))
        gains = np.maximum(gains - swept, 0.1 * gains)
        spread = np.zeros((6, 4))
        spread[:3, 0] = np.cross(c[:, 2], self.v_n) * np.sqrt(turn)
        spread[3:, 0] = c[:, 2] * np.sqrt(turn)
        spread[:3, 1:] = c * np.sqrt(gains)
        self._spread(spread, seconds)

    def tilt(self, doubt: Array) -> None:
        """Doubt roll and pitch.

        Parameters
        ----------
        doubt : ndarray, shape (2,)
            Variances about the forward and the right axis [rad^2].
        """
        spread = np.zeros((6, 2))
        spread[3:] = self.C_nb[:, :2] * np.sqrt(doubt)
        self._spread(spread, 0.0)

    def _spread(self, spread: Array, seconds: float) -> None:
        """Add errors of velocity and attitude, shape (6, k), that grew at random over some time till now."""
        whole = np.vstack([0.5 * seconds * spread[:3], spread])
        p = self.p.reshape(ROW, ROW)
        p[:9, :9] += whole @ whole.T
        p[:3, :3] += seconds * seconds / 12.0 * spread[:3] @ spread[:3].T

    def lose_track(self, time: float, silence: float, turned: float) -> None:
        """Carry on after a long silence of the IMU: what a car may have done meanwhile bounds the doubt.

        It went straight on, faster or slower. That it may have turned is for the caller to `turn`, but for
        where in the hole it did.

        Parameters
        ----------
        time : float
            When samples come again [s].
        silence : float
            How long there were none [s].
        turned : float
            Standard deviation of the heading's change [rad].
        """
        r_m, r_n = earth.radii(np.sin(self.x[0]))
        self.x[0] += self.x[3] * silence / r_m
        self.x[1] += self.x[4] * silence / (r_n * np.cos(self.x[0]))
        self.memory[:] = 0.0
        self.memory[at.TIME] = time
        p = self.p.reshape(ROW, ROW)
        p[:3] += silence * p[3:6]
        p[:, :3] += silence * p[:, 3:6]
        self.error[:3] += silence * self.error[3:6]
        spread = np.zeros((6, 5))
        spread[:3, :3] = self.C_nb * np.array([1.0, 0.1, 0.1]) * min(3.0 * silence, 15.0)
        spread[3:5, 3:5] = np.eye(2) * TILTED
        self._spread(spread, silence)
        aside = silence / np.sqrt(12.0) * min(turned, 1.0) * np.cross([0.0, 0.0, 1.0], self.v_n)
        p[:3, :3] += np.outer(aside, aside)
        self.trail = Trail(self.trail.length)

    def turn(self, place: Array, variance: float) -> None:
        """Doubt the heading since some place: the way from there may be turned about it as a whole.

        Parameters
        ----------
        place : ndarray, shape (3,)
            Latitude, longitude [rad], height [m].
        variance : float
            [rad^2]
        """
        p, turned = self.p.reshape(ROW, ROW), self.turned_about(place)
        p[:9, :9] += variance * np.outer(turned, turned)

    def turned_about(self, place: Array) -> Array:
        """What a turn of the way since some place does to position, velocity and attitude.

        Parameters
        ----------
        place : ndarray, shape (3,)

        Returns
        -------
        ndarray, shape (9,)
            Errors by the angle [1/rad].
        """
        down = np.array([0.0, 0.0, 1.0])
        way = earth.lla_to_ned(self.lla, place)
        return np.concatenate([np.cross(down, way), np.cross(down, self.v_n), down])

    def doubt(self, off: float, ceiling: Array) -> None:
        """Doubt what a bridge that misled the filter taught it: attitude and the biases of the sensors.

        Parameters
        ----------
        off : float
            By how much the velocity turned out to be wrong [m/s]; a tilt does that in some seconds.
        ceiling : ndarray, shape (n,)
            Variance of each state when nothing is known of it; biases come back to a tenth of it.
        """
        p, blocks = self.p.reshape(ROW, ROW), self.layout.blocks
        tilt = min(off / (SECONDS * 9.8), 0.3)
        heading = min(off / max(float(np.hypot(*self.v_n[:2])), 5.0), 1.0)
        p[(6, 7, 8), (6, 7, 8)] += np.square([tilt, tilt, heading])
        for name in ("gyro_bias", "accel_bias"):
            index = np.arange(blocks[name].start, blocks[name].stop)
            p[index, index] += 0.1 * ceiling[index]

    def estimate(self) -> Array:
        """The best state: nominal, with the open-loop error applied to a copy of it.

        Returns
        -------
        ndarray, shape (n + 1,)
        """
        if not self.error.size:
            return self.x
        x = self.x.copy()
        inject(x, self.error[: self.layout.n])
        return x

    def fade(self, factor: float, ceiling: Array) -> None:
        """Forget: P times a factor, but for variances at their ceiling.

        P + (factor - 1) E P E, E diagonal between 0 and 1: what is added is a covariance, and a state
        that no observation shows does not grow for ever.

        Parameters
        ----------
        factor : float
            At least 1.
        ceiling : ndarray, shape (n,)
            Variances that are not exceeded; states beyond stay as they are.
        """
        p = self.P
        room = (ceiling / np.maximum(np.diag(p), 1e-300) - 1.0) / (factor - 1.0)
        share = np.sqrt(np.clip(room, 0.0, 1.0))
        p += (factor - 1.0) * (share[:, None] * p * share)

    def widen(self, h: Array, z: Array) -> None:
        """Admit an error as large as an innovation, where a channel looks directly at the state.

        Parameters
        ----------
        h : ndarray, shape (m, n)
            Rows of a position or velocity observation: the identity on one block.
        z : ndarray, shape (m,)
            Innovation.
        """
        p = self.p.reshape(ROW, ROW)
        for row, error in zip(h, z, strict=True):
            i = int(np.argmax(row[:6]))
            p[i, i] += error * error
