"""An analytic path: speed, heading, slope and bank as smooth functions of time, and where they lead.

The path is that of a vehicle's rear axle, whose velocity points along the vehicle's forward axis at
every instant: it never slips sideways, and the non-holonomic constraint holds exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gapless import earth
from gapless.errors import ConfigError
from gapless.simulate.piecewise import Piecewise, staircase

Array = NDArray[np.float64]

_CORNER = 1.5
"""How long a change of acceleration or turn rate takes [s]."""
_HILL_CORNER = 4.0
"""How long a change of slope or bank takes [s]: at 15 m/s and 4 % it lifts by less than 0.4 m/s^2."""
_STEP = 0.01
"""Spacing of the table of positions [s]; the cubic between its rows is good to 1e-8 m."""


def gauss_legendre(order: int) -> tuple[Array, Array, Array]:
    """Nodes, weights and partial integrals of Gauss-Legendre quadrature on [0, 1].

    Parameters
    ----------
    order : int
        Number of nodes s; polynomials up to degree 2 s - 1 are integrated exactly.

    Returns
    -------
    nodes, weights : ndarray, shape (s,)
    partial : ndarray, shape (s, s)
        `partial @ f(nodes)` is the integral of f from 0 to each node (the matrix A of the Gauss
        collocation method; Hairer, Norsett & Wanner 1993, sec. II.7).
    """
    x, w = np.polynomial.legendre.leggauss(order)
    nodes = 0.5 * (x + 1.0)
    powers = np.arange(1, order + 1)
    vandermonde = nodes[:, None] ** (powers - 1)
    return nodes, 0.5 * w, (nodes[:, None] ** powers / powers) @ np.linalg.inv(vandermonde)


@dataclass(frozen=True)
class Segment:
    """A stretch of a drive with constant commands; corners between stretches are rounded.

    Parameters
    ----------
    duration : float
        [s], > 0.
    acceleration : float
        Rate of change of the speed [m/s^2].
    turn_rate : float
        Rate of change of the heading [rad/s], positive to the right.
    slope : float
        Pitch of the road [rad], positive uphill.
    bank : float
        Roll of the road [rad], positive with the right side down.
    """

    duration: float
    acceleration: float = 0.0
    turn_rate: float = 0.0
    slope: float = 0.0
    bank: float = 0.0


@dataclass(frozen=True, eq=False)
class Path:
    """Motion of the rear axle.

    Parameters
    ----------
    speed : Piecewise
        Along the forward axis [m/s].
    heading, pitch, bank : Piecewise
        [rad]; the heading is not wrapped.
    origin : ndarray, shape (3,)
        Latitude, longitude [rad], height [m] at time 0.
    roll_gradient : float
        Roll out of a turn per lateral acceleration [rad / (m/s^2)].
    """

    speed: Piecewise
    heading: Piecewise
    pitch: Piecewise
    bank: Piecewise
    origin: Array
    roll_gradient: float = 0.0

    @classmethod
    def from_segments(
        cls,
        segments: Sequence[Segment],
        origin: ArrayLike,
        heading: float = 0.0,
        speed: float = 0.0,
        roll_gradient: float = 0.0,
    ) -> Path:
        """A path that obeys commands one after another.

        Parameters
        ----------
        segments : sequence of Segment
        origin : array_like, shape (3,)
            Latitude, longitude [rad], height [m] at time 0.
        heading, speed : float
            At time 0 [rad], [m/s].
        roll_gradient : float
            Roll out of a turn per lateral acceleration [rad / (m/s^2)].

        Returns
        -------
        Path

        Raises
        ------
        ConfigError
            If there is no segment, or one does not last.
        """
        if not segments or min(s.duration for s in segments) <= 0.0:
            raise ConfigError("a path needs segments of positive duration; check the profile")
        last = [s.duration for s in segments]
        acceleration = staircase(last, [s.acceleration for s in segments], _CORNER)
        turn_rate = staircase(last, [s.turn_rate for s in segments], _CORNER)
        slope = staircase(last, [s.slope for s in segments], _HILL_CORNER)
        bank = staircase(last, [s.bank for s in segments], _HILL_CORNER)
        return cls(
            acceleration.antiderivative(speed),
            turn_rate.antiderivative(heading),
            slope,
            bank,
            np.asarray(origin, float),
            roll_gradient,
        )

    @property
    def duration(self) -> float:
        """Length in time [s]."""
        return float(self.speed.knots[-1])

    @cached_property
    def _derivatives(self) -> tuple[tuple[Piecewise, ...], ...]:
        return tuple(_with_derivatives(f) for f in (self.speed, self.heading, self.pitch, self.bank))

    def along(self, t: Array) -> tuple[Array, Array]:
        """Speed and its rate of change.

        Parameters
        ----------
        t : ndarray
            [s], any shape.

        Returns
        -------
        speed, acceleration : ndarray, of that shape
            [m/s], [m/s^2].
        """
        speed = self._derivatives[0]
        return speed[0](t), speed[1](t)

    def euler(self, t: Array) -> tuple[Array, Array, Array]:
        """Roll, pitch, heading of the vehicle with their first and second derivatives.

        Parameters
        ----------
        t : ndarray, shape (...)
            [s]

        Returns
        -------
        angles, rates, accelerations : ndarray, shape (3, ...)
            [rad], [rad/s], [rad/s^2]. The roll is the bank less `roll_gradient` times the lateral
            acceleration v dpsi/dt.
        """
        v, a, jerk = (f(t) for f in self._derivatives[0][:3])
        heading, w, dw, ddw = (f(t) for f in self._derivatives[1])
        pitch, dpitch, ddpitch = (f(t) for f in self._derivatives[2][:3])
        bank, dbank, ddbank = (f(t) for f in self._derivatives[3][:3])
        k = self.roll_gradient
        return (
            np.stack([bank - k * v * w, pitch, heading]),
            np.stack([dbank - k * (a * w + v * dw), dpitch, w]),
            np.stack([ddbank - k * (jerk * w + 2.0 * a * dw + v * ddw), ddpitch, dw]),
        )

    def _velocity(self, t: Array) -> Array:
        v, pitch, heading = self.speed(t), self.pitch(t), self.heading(t)
        level = v * np.cos(pitch)
        return np.stack([level * np.cos(heading), level * np.sin(heading), -v * np.sin(pitch)])

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Offsets of latitude, longitude, height from the origin and their rates, every `_STEP`."""
        count = int(np.ceil(self.duration / _STEP - 1e-9)) + 1
        grid = _STEP * np.arange(count, dtype=np.float64)
        nodes, weights, partial = gauss_legendre(4)
        v_n = self._velocity(grid[:-1, None] + _STEP * nodes)
        offsets = np.zeros((3, count))
        offsets[2], height = _integrate(-v_n[2], weights, partial)
        lat = np.zeros_like(height)
        for _ in range(4):  # Picard: each round gains four digits, as the radii hardly change
            rates = geodetic_rates(v_n, self.origin[0] + lat, self.origin[2] + height)
            offsets[0], lat = _integrate(rates[0], weights, partial)
        rates = geodetic_rates(v_n, self.origin[0] + lat, self.origin[2] + height)
        offsets[1], _ = _integrate(rates[1], weights, partial)
        here = self.origin[:, None] + offsets
        return offsets, geodetic_rates(self._velocity(grid), here[0], here[2])

    def position(self, t: Array) -> Array:
        """Where the rear axle is.

        Parameters
        ----------
        t : ndarray, shape (...)
            [s], from 0 to `duration`.

        Returns
        -------
        ndarray, shape (3, ...)
            Latitude, longitude [rad], height [m].
        """
        offsets, rates = self._table
        t = np.asarray(t, float)
        j = np.clip((t / _STEP).astype(np.int64), 0, offsets.shape[1] - 2)
        u = t / _STEP - j
        start, end = offsets[:, j], offsets[:, j + 1]
        r0, r1 = _STEP * rates[:, j], _STEP * rates[:, j + 1]
        rise = end - start
        moved = start + u * (r0 + u * (3.0 * rise - 2.0 * r0 - r1 + u * (r0 + r1 - 2.0 * rise)))
        return np.asarray(self.origin.reshape(3, *(1,) * t.ndim) + moved)


def geodetic_rates(v_n: Array, lat: Array, height: Array) -> Array:
    """Rates of change of latitude, longitude and height.

    Parameters
    ----------
    v_n : ndarray, shape (3, ...)
        North, east, down [m/s].
    lat, height : ndarray, shape (...)
        [rad], [m]

    Returns
    -------
    ndarray, shape (3, ...)
        [rad/s], [rad/s], [m/s]; Groves (2013), eq. 2.111.
    """
    r_m, r_n = earth.radii(np.sin(lat))
    return np.stack([v_n[0] / (r_m + height), v_n[1] / ((r_n + height) * np.cos(lat)), -v_n[2]])


def _with_derivatives(f: Piecewise) -> tuple[Piecewise, ...]:
    first = f.derivative()
    second = first.derivative()
    return f, first, second, second.derivative()


def _integrate(rate: Array, weights: Array, partial: Array) -> tuple[Array, Array]:
    """Running integral of a rate given at the nodes of each step: at the grid and at the nodes."""
    grid = np.concatenate([[0.0], np.cumsum(_STEP * (rate @ weights))])
    return grid, grid[:-1, None] + _STEP * (rate @ partial.T)
