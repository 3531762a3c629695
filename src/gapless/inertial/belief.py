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

CORE_STATES: Final = 15


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
        return attitude.matrix(self.q_nb)

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

    def hang(self) -> None:
        """Take a position that is doubted by itself for one that was had from the antenna's.

        It is wrong by what the lever arm and the attitude are wrong, too: dp = [C l x] phi - C dl. A doubt of
        its own would tell a filter that looks for the arm how short it is.
        """
        if "lever_arm" not in self.layout:
            return
        c, block = self.C_nb, self.layout.blocks["lever_arm"]
        n, e, d = c @ self.block("lever_arm")
        to = np.zeros((3, self.layout.n))
        to[:, 6:9] = [[0.0, -d, e], [d, 0.0, -n], [-e, n, 0.0]]
        to[:, block] = -c
        p = self.P
        shared = to @ p
        p[:3, :] += shared
        p[:, :3] += shared.T
        p[:3, :3] += shared @ to.T

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
            Rows of a position or velocity observation, or of one at rest: the identity on their blocks.
        z : ndarray, shape (m,)
            Innovation.
        """
        p = self.p.reshape(ROW, ROW)
        for row, error in zip(h, z, strict=True):
            direct = row[:6] if row[:6].any() else row
            i = int(np.argmax(direct))
            p[i, i] += error * error
