"""A bare way to run the propagation kernel in the tests of this folder."""

from __future__ import annotations

import numpy as np

from gapless import attitude, earth
from gapless.inertial import propagate as at
from gapless.inertial.layout import ROW, Layout
from gapless.inertial.propagate import propagate
from gapless.simulate.path import Path, Segment
from gapless.trip.recording import Imu

DEG = np.pi / 180.0
SILENT = np.zeros(7)
"""No process noise, biases that do not decay."""
ORIGIN = (0.75, 0.2, 120.0)


def circuit(duration: float) -> Path:
    """Stop and go around the block with hills and banked turns, starting from rest."""
    lap = [
        Segment(3.0),
        Segment(10.0, 1.5, slope=0.03),
        Segment(6.0, turn_rate=15.0 * DEG, bank=0.05),
        Segment(20.0, slope=-0.04),
        Segment(6.0, turn_rate=15.0 * DEG, bank=0.05),
        Segment(8.0, 0.5),
        Segment(8.0, -0.5, slope=0.03),
        Segment(3.0, turn_rate=-20.0 * DEG),
        Segment(3.0, turn_rate=20.0 * DEG),
        Segment(12.0, turn_rate=15.0 * DEG, bank=0.05),
        Segment(10.0, -1.5, slope=-0.02),
    ]
    laps = int(np.ceil(duration / sum(s.duration for s in lap)))
    return Path.from_segments(lap * laps, ORIGIN, heading=0.5, roll_gradient=0.005)


class Run:
    """State of one run of the kernel, all of it in the open."""

    def __init__(
        self,
        lla: np.ndarray,
        v_n: np.ndarray,
        euler: np.ndarray,
        extras: tuple[str, ...] = (),
        noise: np.ndarray = SILENT,
        open_loop: bool = False,
    ) -> None:
        self.layout = Layout(extras)
        self.x = np.zeros(self.layout.n + 1)
        self.x[:3], self.x[3:6], self.x[6:10] = lla, v_n, attitude.from_euler(euler)
        self.memory = np.zeros(at.MEMORY_SIZE)
        self.p = np.zeros(ROW * ROW)
        self.error = np.zeros(self.layout.width if open_loop else 0)
        self.noise = noise

    @property
    def P(self) -> np.ndarray:
        n = self.layout.n
        return self.p.reshape(ROW, ROW)[:n, :n]

    def copy(self) -> Run:
        new = object.__new__(Run)
        new.layout, new.noise = self.layout, self.noise
        for name in ("x", "memory", "p", "error"):
            setattr(new, name, getattr(self, name).copy())
        return new

    def go(self, imu: Imu, first=0, last=None, period=0.0, tick=1e9, flush=False) -> int:
        """Samples first..last-1, or to the next tick; the index of the next sample."""
        scratch = np.full((2, ROW * ROW), np.nan)  # what the kernel does not write it must not read
        columns = (np.ascontiguousarray(c) for c in (imu.time, imu.dt, imu.dtheta, imu.dvel))
        last = len(imu.time) if last is None else last
        state = (self.x, self.memory, self.layout.width, self.p, scratch, self.error)
        return propagate(*state, self.layout.offsets, self.noise, *columns, first, last, period, tick, flush)

    def displacement(self, lla: np.ndarray) -> np.ndarray:
        """North, east, down of this run's position from a point [m]."""
        return earth.lla_to_ned(self.x[:3], lla)

    def turn_from(self, q_nb: np.ndarray) -> np.ndarray:
        """Rotation vector phi in NED with C_this = exp(phi x) C(q_nb) [rad], for small ones."""
        q = attitude.multiply(self.x[6:10], np.asarray(q_nb) * [1.0, -1.0, -1.0, -1.0])
        return 2.0 * q[1:] * np.sign(q[0])
