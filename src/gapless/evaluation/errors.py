"""Error of a solution against a truth, epoch by epoch of the truth."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gapless import earth
from gapless.attitude import from_euler, to_matrix, wrap
from gapless.evaluation.interpolation import interpolate
from gapless.evaluation.statistics import nees, sound
from gapless.filters.quantile import chi_square_quantile
from gapless.trip.motion import horizontal_velocity, motion, offset_ned
from gapless.trip.recording import Array, Columns, Gnss, Trajectory

VAST = 1e7
"""A standard deviation that is larger says nothing: one is nowhere on earth [m]."""


@dataclass(frozen=True, eq=False)
class Errors(Columns):
    """Solution minus truth at the truth's epochs; NaN where either is unknown.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Of the truth's epochs, on the IMU clock [s].
    position : ndarray, shape (n, 3)
        North, east, down [m].
    velocity : ndarray, shape (n, 3)
        North, east, down [m/s].
    attitude : ndarray, shape (n, 3)
        Roll, pitch, heading [rad], wrapped.
    along, cross : ndarray, shape (n,)
        Horizontal error along the truth's course and to the right of it [m].
    covariance : ndarray, shape (n, 2, 2)
        Of the north and east error as stated [m^2]: the solution's, plus the truth's own where
        the truth states one.
    speed, distance : ndarray, shape (n,)
        Of the truth [m/s, m]; distance since its first epoch.
    """

    position: Array
    velocity: Array
    attitude: Array
    along: Array
    cross: Array
    covariance: Array
    speed: Array
    distance: Array

    @property
    def horizontal(self) -> Array:
        """Length of the horizontal position error [m], shape (n,)."""
        return np.hypot(self.position[:, 0], self.position[:, 1])

    @property
    def nees(self) -> Array:
        """Normalised squared horizontal error, two degrees of freedom, shape (n,)."""
        return np.where(self.usable, nees(self.position[:, :2], self.covariance), np.nan)

    def bound(self, probability: float = 0.95) -> Array:
        """Semi-major axis of the stated error ellipse.

        Parameters
        ----------
        probability : float
            That the ellipse should hold.

        Returns
        -------
        ndarray, shape (n,)
            [m]
        """
        scale = np.sqrt(chi_square_quantile(probability, 2))
        return np.asarray(scale * np.sqrt(_largest_eigenvalue(self.covariance)))

    def inside(self, probability: float = 0.95) -> NDArray[np.bool_]:
        """Whether the stated error ellipse holds the truth.

        Parameters
        ----------
        probability : float
            That it should.

        Returns
        -------
        ndarray of bool, shape (n,)
            False where the error is unknown, or what is stated is no covariance.
        """
        return np.asarray(self.nees <= chi_square_quantile(probability, 2))

    @property
    def usable(self) -> NDArray[np.bool_]:
        """Whether what is stated is a covariance, neither singular nor beyond the earth; shape (n,)."""
        size = np.diagonal(self.covariance, axis1=1, axis2=2).max(axis=1)
        return np.asarray(sound(self.covariance) & (size < VAST * VAST))

    @property
    def unstated(self) -> int:
        """Epochs with a known error and no usable covariance."""
        return int((np.isfinite(self.horizontal) & ~self.usable).sum())

    def coverage(self, probability: float = 0.95) -> float:
        """Share of the epochs with a known error that the stated ellipse holds.

        Parameters
        ----------
        probability : float
            That it should.

        Returns
        -------
        float
            An epoch without a usable covariance is outside; NaN where no epoch has one.
        """
        known = np.isfinite(self.horizontal)
        return float(self.inside(probability)[known].mean()) if (known & self.usable).any() else math.nan


def _largest_eigenvalue(c: Array) -> Array:
    with np.errstate(invalid="ignore", over="ignore"):
        mean = 0.5 * (c[:, 0, 0] + c[:, 1, 1])
        return np.asarray(mean + np.hypot(0.5 * (c[:, 0, 0] - c[:, 1, 1]), c[:, 0, 1]))


def _horizontal_covariance(trajectory: Trajectory) -> Array:
    c = np.empty((len(trajectory), 2, 2))
    with np.errstate(over="ignore"):  # whatever a solution states
        c[:, 0, 0], c[:, 1, 1] = trajectory.sd[:, 0] ** 2, trajectory.sd[:, 1] ** 2
    c[:, 0, 1] = c[:, 1, 0] = trajectory.horizontal
    return c


def solution_errors(solution: Trajectory, truth: Trajectory, clock_offset: float = 0.0) -> Errors:
    """Errors of a solution at the epochs of a truth.

    Parameters
    ----------
    solution : Trajectory
        On the IMU clock; interpolated linearly, not over gaps above 1.5 s.
    truth : Trajectory
        Its rows with a position are the epochs.
    clock_offset : float
        What has to be added to the truth's stamps to land on the IMU clock [s].

    Returns
    -------
    Errors
    """
    truth = truth.take(np.isfinite(truth.lla).all(axis=1))
    time = truth.time + clock_offset
    found = interpolate(solution, time)
    position = offset_ned(found.lla, truth.lla)
    moved = motion(time, horizontal_velocity(time, truth.lla, truth.v_n))
    cos, sin = np.cos(moved.course), np.sin(moved.course)
    own = np.nan_to_num(_horizontal_covariance(truth), nan=0.0)
    return Errors(
        time=time,
        position=position,
        velocity=found.v_n - truth.v_n,
        attitude=wrap(found.euler - truth.euler),
        along=cos * position[:, 0] + sin * position[:, 1],
        cross=cos * position[:, 1] - sin * position[:, 0],
        covariance=_horizontal_covariance(found) + own,
        speed=moved.speed,
        distance=moved.distance,
    )


def gnss_truth(gnss: Gnss, position_offset: float = 0.0, velocity_offset: float = 0.0) -> Trajectory:
    """GNSS fixes as a trajectory of the antenna on the IMU clock, to serve as truth.

    Parameters
    ----------
    gnss : Gnss
        Withheld fixes included.
    position_offset, velocity_offset : float
        What has to be added to the logged stamps to land on the IMU clock [s].

    Returns
    -------
    Trajectory
        At the position epochs; the velocity, which may be late by another amount, interpolated.
    """
    gnss = gnss.take(np.isfinite(gnss.lla).all(axis=1))
    n = len(gnss)
    time = gnss.time + position_offset
    spare = np.full((n, 3), np.nan)
    sd = np.column_stack([gnss.sd_position, gnss.sd_velocity, spare])
    source = np.full(n, "gnss")
    late = Trajectory(gnss.time + velocity_offset, gnss.lla, gnss.v_n, spare, sd, np.zeros(n), source)
    v_n = interpolate(late, time).v_n if n else gnss.v_n
    return Trajectory(time, gnss.lla, v_n, spare, sd, np.zeros(n), source)


def at_antenna(solution: Trajectory, lever_arm: Array) -> Trajectory:
    """A solution moved from the IMU to the antenna (positions; the velocity stays the IMU's).

    Parameters
    ----------
    solution : Trajectory
        With attitude.
    lever_arm : ndarray, shape (3,) or (n, 3)
        Antenna from the IMU, FRD [m]; one, or one for each row.

    Returns
    -------
    Trajectory
    """
    if not np.any(lever_arm):
        return solution
    arms = np.broadcast_to(np.asarray(lever_arm, float), (len(solution), 3))
    arm = np.einsum("nij,nj->ni", to_matrix(from_euler(solution.euler)), arms)
    lat, height = solution.lla[:, 0], solution.lla[:, 2]
    r_m, r_n = earth.radii(np.sin(lat))
    east = arm[:, 1] / ((r_n + height) * np.cos(lat))
    moved = solution.lla + np.column_stack([arm[:, 0] / (r_m + height), east, -arm[:, 2]])
    return replace(solution, lla=moved)
