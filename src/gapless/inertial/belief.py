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
GRAVITY: Final = 9.8
"""For what a tilt does [m/s^2]."""
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
        tilt = min(off / (SECONDS * GRAVITY), 0.3)
        heading = min(off / max(float(np.hypot(*self.v_n[:2])), 5.0), 1.0)
        p[(6, 7, 8), (6, 7, 8)] += np.square([tilt, tilt, heading])
        for name in ("gyro_bias", "accel_bias"):
            index = np.arange(blocks[name].start, blocks[name].stop)
            p[index, index] += 0.1 * ceiling[index]

    def turn(self, angle: float) -> None:
        """Turn the heading by what accelerations show; how far that is off, and why, is not known.

        Parameters
        ----------
        angle : float
            Clockwise [rad].
        """
        half = 0.5 * angle
        self.x[6:10] = product((np.cos(half), 0.0, 0.0, np.sin(half)), tuple(self.x[6:10]))
        p = self.p.reshape(ROW, ROW)
        p[8, 8] += np.square(0.3 * angle) + np.square(10.0 * DEG)
        down = self.C_nb[2]
        p[(9, 10, 11), (9, 10, 11)] += np.square(down * min(abs(angle) / SECONDS, 3.0 * DEG))
        if "mounting" in self.layout:
            yaw = self.layout.blocks["mounting"].start + 1
            p[yaw, yaw] += angle * angle

    def drift(self, rate: Array) -> None:
        """Doubt the gyros' zeros by what they say at rest, and the heading by what that made of it.

        Parameters
        ----------
        rate : ndarray, shape (3,)
            [rad/s]
        """
        p = self.p.reshape(ROW, ROW)
        p[(9, 10, 11), (9, 10, 11)] += np.square(rate)
        p[8, 8] += np.square(SECONDS * float(np.linalg.norm(rate)))

    def remount(self, slip: Array) -> float:
        """Doubt how the box sits in the car, for the car seems to slip.

        Or a gyro's zero has leapt, and the heading with it: then the slip grows, and a mounting that alone
        was in doubt would follow it.

        Parameters
        ----------
        slip : ndarray, shape (2,)
            Innovation of the constraint: right, down [m/s].

        Returns
        -------
        float
            By how much the box would have to be turned [rad].
        """
        if "mounting" not in self.layout:
            return 0.0
        turn = slip / max(float(np.hypot(*self.v_n[:2])), 2.0)
        p, first = self.p.reshape(ROW, ROW), self.layout.blocks["mounting"].start
        p[first, first] += turn[1] ** 2
        p[first + 1, first + 1] += turn[0] ** 2
        p[8, 8] += turn[0] ** 2
        p[(9, 10, 11), (9, 10, 11)] += np.square(self.C_nb[2] * turn[0] / SECONDS)
        return float(np.hypot(*turn))

    def tipped(self, off: float, since: float) -> None:
        """Doubt the vertical in the box, and all that came of it: a force that was none was integrated.

        Parameters
        ----------
        off : float
            What it made of the velocity [m/s].
        since : float
            In so many seconds.
        """
        n, p, size = self.layout.n, self.P, off / since
        for axis, (tilted, by) in enumerate(((7, -1.0), (6, 1.0), (8, 0.0))):
            u = np.zeros(n)  # psi x f for an attitude that is off by psi
            u[axis], u[3 + axis], u[tilted] = 0.5 * since**2, since, by / GRAVITY
            p += np.outer(u, u) * np.square(size if by else 0.3 * size)
        if "mounting" in self.layout:
            pitch = self.layout.blocks["mounting"].start
            p[pitch, pitch] += np.square(size / GRAVITY)

    def knocked(self, turn: Array, since: float, gained: Array, ceiling: Array) -> None:
        """Go on after the box was turned: in its former axes, in doubt of how well these are known.

        Parameters
        ----------
        turn : ndarray, shape (3, 3)
            Takes what is felt now to the axes of before.
        since : float
            For so long it has been taken for what it was not [s].
        gained : ndarray, shape (3,)
            Force too much that was integrated meanwhile, in the axes of before [m/s^2].
        ceiling : ndarray, shape (n,)
            Variance of each state when nothing is known of it; biases come back to a quarter of it.
        """
        wrong = self.C_nb @ gained
        off, moved = wrong * since, 0.5 * wrong * since * since
        step = np.zeros(self.layout.n)
        step[:3], step[3:6] = -moved, -off
        inject(self.x, step)
        for at_ in (at.PREV_THETA, at.PREV_VEL):
            self.memory[at_ : at_ + 3] = turn @ self.memory[at_ : at_ + 3]
        p, blocks = self.p.reshape(ROW, ROW), self.layout.blocks
        p[(0, 1, 2), (0, 1, 2)] += np.square(0.3 * float(np.linalg.norm(moved)) + 0.3)
        p[(3, 4, 5), (3, 4, 5)] += np.square(0.2 * float(np.linalg.norm(off)) + 0.2)
        p[(6, 7, 8), (6, 7, 8)] += np.square(np.array([4.0, 4.0, 15.0]) * DEG)
        for name, share in (("gyro_bias", 0.25), ("accel_bias", 0.25), ("mounting", 0.1)):
            if name in blocks:
                index = np.arange(blocks[name].start, blocks[name].stop)
                p[index, index] += share * ceiling[index]

    def reseated(self, turn: Array, ceiling: Array) -> None:
        """Go on in the former axes of a box whose attitude was known all the time, not so how it sits.

        Parameters
        ----------
        turn : ndarray, shape (3, 3)
            Takes what is felt now to the axes of before.
        ceiling : ndarray, shape (n,)
            Variance of each state when nothing is known of it; what is in the box comes back to a share.
        """
        self.x[6:10] = attitude.from_matrix(self.C_nb @ turn.T)
        for at_ in (at.PREV_THETA, at.PREV_VEL):
            self.memory[at_ : at_ + 3] = turn @ self.memory[at_ : at_ + 3]
        p, blocks, turned = self.P, self.layout.blocks, np.eye(self.layout.n)
        for name in ("gyro_bias", "accel_bias"):  # these turn with the box
            turned[blocks[name], blocks[name]] = turn
            self.block(name)[:] = turn @ self.block(name)
        p[:] = turned @ p @ turned.T
        for name, share in (("gyro_bias", 0.05), ("accel_bias", 0.05), ("mounting", 0.3)):
            if name in blocks:
                index = np.arange(blocks[name].start, blocks[name].stop)
                p[index, index] += share * ceiling[index]

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
