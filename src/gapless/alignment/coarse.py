"""Initial attitude in motion: levelling corrected for GNSS acceleration, heading from GNSS course.

The last seconds of IMU are carried to one instant by the gyros, summed, and compared with the
velocity that GNSS gained meanwhile: what is left of the specific force is gravity. So the log may
start at standstill or at speed. Heading needs a course, so the vehicle must move.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, NamedTuple, Self

import numpy as np

from gapless import attitude, earth
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.units import DEG

MEMORY: Final = 14.0
"""Velocities are kept for so long [s]: from the standstill that a car drove off from."""
TOLD: Final = 0.35
"""Least sum of squares of the changes of acceleration that tell a reverse from a drive [m^2/s^3]."""
SURE: Final = 0.5
"""Share of them that must be felt, the same way or the other."""
SWIFT: Final = 4.5
"""A car this fast that shows neither drives forwards [m/s]; a slower one is waited for."""


class Start(NamedTuple):
    """An initial state.

    Parameters
    ----------
    time : float
        [s]
    lla : ndarray, shape (3,)
    v_n : ndarray, shape (3,)
    q_nb : ndarray, shape (4,)
    gyro_bias : ndarray or None
        From a standstill [rad/s].
    sd_position, sd_velocity, sd_heading : float
        [m], [m/s], [rad]; heading sd that of the course alone.
    evidence : str
        How it was found.
    """

    time: float
    lla: Array
    v_n: Array
    q_nb: Array
    gyro_bias: Array | None
    sd_position: float
    sd_velocity: float
    sd_heading: float
    evidence: str


@dataclass
class Aligner:
    """Waits for a velocity worth a heading.

    Parameters
    ----------
    mounting_yaw : float
        Yaw of the car's forward axis in the box, as far as it is known [rad].
    min_speed : float
        Slower than this, a course says too little [m/s].
    window : float
        Seconds of IMU used for levelling.
    """

    mounting_yaw: float = 0.0
    min_speed: float = 5.0
    window: float = 4.0
    blocks: deque[tuple[float, Array]] = field(default_factory=deque)
    velocities: deque[tuple[float, Array]] = field(default_factory=deque)
    fix: Reading | None = None
    anchor: Reading | None = None
    fast: int = 0
    still: float = 0.0
    still_since: float = math.inf
    turned: Array = field(default_factory=lambda: np.zeros(3))
    velocity_heard: bool = False

    def feel(self, time: float, rows: Array) -> None:
        """Take in samples.

        Parameters
        ----------
        time : float
            End of the last one [s].
        rows : ndarray, shape (k, 8)
            time, dt, dtheta, dvel.
        """
        self.blocks.append((time, rows))
        while self.blocks[0][0] < time - self._memory:
            self.blocks.popleft()

    @property
    def _memory(self) -> float:
        """Seconds of samples that are looked at, whatever the blocks they came in."""
        return max(2.0 * self.window + 2.0, MEMORY + 1.0)

    def hear(self, reading: Reading, now: float) -> Start | None:
        """Take in a reading; a start, once there is one.

        Parameters
        ----------
        reading : Reading
        now : float
            Time of the last sample taken in [s]; the start holds for it.

        Returns
        -------
        Start or None
        """
        if reading.channel == "position":
            self.fix = reading
            return None if self.velocity_heard else self._from_displacement(reading, now)
        if reading.channel == "velocity":
            self.velocity_heard = True
            return self._velocity(reading.time, reading.value, float(np.max(reading.sd[:2])), now)
        return None

    def _from_displacement(self, reading: Reading, now: float) -> Start | None:
        """Velocity of a receiver that reports none: the mean between fixes two seconds apart."""
        anchor = self.anchor
        if anchor is None or reading.time - anchor.time > 4.0:
            self.anchor = reading
            return None
        gap = reading.time - anchor.time
        if gap < 1.9:
            return None
        self.anchor = reading
        return self._velocity(reading.time, earth.lla_to_ned(reading.value, anchor.value) / gap, 1.5, now)

    def _velocity(self, time: float, v_n: Array, sd: float, now: float) -> Start | None:
        speed = math.hypot(v_n[0], v_n[1])
        self._standstill(time, speed)
        self.velocities.append((time, v_n))
        while self.velocities[0][0] < time - MEMORY:
            self.velocities.popleft()
        self.fast = self.fast + 1 if self.min_speed < speed < 80.0 else 0
        fresh = self.fix is not None and abs(time - self.fix.time) < 2.0
        if self.fast < 3 or not fresh:
            return None
        back = self._reverses()
        if back is None and speed < SWIFT:
            return None
        return self._start(time, v_n, sd, now, bool(back))

    def _standstill(self, time: float, speed: float) -> None:
        """Gyro bias from stretches that GNSS calls still."""
        if speed > 0.25:
            self.still_since = math.inf
            return
        if self.still_since == math.inf:
            self.still_since = time + 1.0
            return
        rows = self._rows(self.still_since, time)
        if len(rows):
            self.turned += rows[:, 2:5].sum(axis=0)
            self.still += float(rows[:, 1].sum())
            self.still_since = time

    def _rows(self, start: float, end: float) -> Array:
        rows = np.concatenate([block for _, block in self.blocks]) if self.blocks else np.zeros((0, 8))
        oldest = self.blocks[-1][0] - self._memory if self.blocks else 0.0
        return np.asarray(rows[(rows[:, 0] > max(start, oldest)) & (rows[:, 0] <= end)])

    def _start(self, time: float, v_n: Array, sd: float, now: float, back: bool) -> Start:
        assert self.fix is not None
        recent = [one for one in self.velocities if one[0] >= time - self.window - 1.0]
        t0, v0 = recent[0]
        bias = self.turned / self.still if self.still > 5.0 else None
        rows = self._rows(t0, time)
        gained = np.zeros(3)
        force = np.array([0.0, 0.0, -9.8])
        if len(rows) > 3 and time - t0 > 0.5:
            gained = (v_n - v0) / (time - t0)
            force = _carried(rows, np.zeros(3) if bias is None else bias)
        elif self.blocks:
            last = self._rows(now - 0.5, now)
            force = last[:, 5:8].sum(axis=0) / max(last[:, 1].sum(), 1e-9)
        course = math.atan2(v_n[1], v_n[0])
        heading = course - self.mounting_yaw + (math.pi if back else 0.0)
        roll, pitch = _level(force, gained, heading)
        q_nb = attitude.from_euler(np.array([roll, pitch, heading]))
        late, _ = _turn(self._rows(time, now), bias)
        lla = earth.ned_to_lla(v_n * (now - self.fix.time), self.fix.value)
        speed = math.hypot(v_n[0], v_n[1])
        return Start(
            now,
            lla,
            np.array(v_n),
            attitude.multiply(q_nb, late),
            bias,
            float(np.max(self.fix.sd)),
            max(sd, 0.1),
            math.hypot(sd / speed, 2.0 * DEG),
            f"course at {speed:.1f} m/s{', in reverse' if back else ''}, levelled over {time - t0:.1f} s",
        )

    def _reverses(self) -> bool | None:
        """Whether speed was gained while the box felt a push from the front; None where that is not clear.

        The slope of the car's hill is not known, but does not change as fast as the force along the car does.
        """
        ahead = np.array([math.cos(self.mounting_yaw), math.sin(self.mounting_yaw), 0.0])
        gains, pushes = [], []
        for (t0, v0), (t1, v1) in pairwise(self.velocities):
            rows = self._rows(t0, t1)
            if len(rows) < 3 or t1 - t0 < 0.05:
                continue
            gains.append((math.hypot(v1[0], v1[1]) - math.hypot(v0[0], v0[1])) / (t1 - t0))
            pushes.append(float(rows[:, 5:8].sum(axis=0) @ ahead) / float(rows[:, 1].sum()))
        if len(gains) < 4:
            return None
        gain, push = np.array(gains), np.array(pushes)
        step = float(np.mean([b[0] - a[0] for a, b in pairwise(self.velocities)]))
        told = float(np.square(gain - gain.mean()).sum()) * step
        felt = float((gain - gain.mean()) @ (push - push.mean())) * step
        return felt < 0.0 if told > TOLD and abs(felt) > SURE * told else None

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Aligner
        """
        new = type(self)(**vars(self))
        new.blocks, new.velocities = self.blocks.copy(), self.velocities.copy()
        new.turned = self.turned.copy()
        return new


def _turn(rows: Array, bias: Array | None) -> tuple[Array, Array]:
    """Rotation over the rows as a quaternion, and the attitude before each of them."""
    q = np.array([1.0, 0.0, 0.0, 0.0])
    before = np.empty((len(rows), 4))
    thetas = rows[:, 2:5] - rows[:, 1:2] * (np.zeros(3) if bias is None else bias)
    for i, step in enumerate(attitude.from_rotation_vector(thetas)):
        before[i] = q
        q = attitude.multiply(q, step)
    return q, before


def _carried(rows: Array, bias: Array) -> Array:
    """Mean specific force in the body axes of the end."""
    q, before = _turn(rows, bias)
    c = attitude.to_matrix(before)
    total = np.einsum("kij,kj->i", c, rows[:, 5:8])
    return np.asarray(attitude.to_matrix(q).T @ total / rows[:, 1].sum())


def _level(force: Array, gained: Array, heading: float) -> tuple[float, float]:
    """Roll and pitch at which a specific force explains the acceleration, the heading given.

    With the heading frame h (forward, right, down), f_h = (a_x, a_y, -g) must equal
    C_y(pitch) C_x(roll) f_b: solved for roll first, then pitch.
    """
    ch, sh = math.cos(heading), math.sin(heading)
    a_x, a_y = ch * gained[0] + sh * gained[1], -sh * gained[0] + ch * gained[1]
    down = -9.81 + gained[2]
    planar = math.hypot(force[1], force[2])
    # right: f_y cos r - f_z sin r = a_y ; its two solutions differ by half a turn, take the upright one
    roll = math.atan2(-force[1], -force[2]) + math.asin(max(-1.0, min(1.0, a_y / planar)))
    below = force[1] * math.sin(roll) + force[2] * math.cos(roll)
    # forward: f_x cos p + below sin p = a_x ; down: -f_x sin p + below cos p = down
    pitch = math.atan2(a_x * below - down * force[0], a_x * force[0] + down * below)
    return roll, pitch
