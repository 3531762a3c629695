"""Clock offset of a sensor against the IMU, from the shape of the motion.

Within windows of some seconds the inertial velocity (or path) is exact but for a slow drift; so the
sensor's readings, less a low polynomial, must fit the inertial curve, and they do at one shift in
time only. The shift is found by scanning and refined by the parabola through the best three. It is
the *equivalent instantaneous* offset: it contains half an epoch where the receiver averages.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless import attitude
from gapless.trip.motion import Sums, offset_ned
from gapless.trip.recording import Array, Imu, Trajectory

STEP = 0.02
"""Spacing of the scan [s]."""

NEAR = 4.0
"""Readings lead an inertial velocity by their mean over about so long [s]."""
LED = 1.0
"""Spacing of these means [s]."""


class Offset(NamedTuple):
    """What must be added to a sensor's stamps to land on the IMU clock.

    Parameters
    ----------
    value : float
        [s]
    sd : float
        One standard deviation [s]; inf where the motion says nothing.
    gain : float
        Misfit without the offset over misfit with it (RMS ratio).
    epochs : int
        Readings used.
    """

    value: float
    sd: float
    gain: float
    epochs: int

    def later(self, seconds: float) -> Offset:
        """The same for stamps that had so much added to them before [s]."""
        return self._replace(value=self.value + seconds)


class Curve(NamedTuple):
    """A motion known but for a slow drift.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Increasing [s].
    value : ndarray, shape (n, d)
        Inertial velocity or path.
    """

    time: Array
    value: Array


def offset(
    curve: Curve,
    time: Array,
    value: Array,
    degree: int,
    span: float = 1.5,
    windows: tuple[float, ...] = (20.0,),
    correlation: float = 1.0,
) -> Offset:
    """Shift in time at which readings fit a curve.

    Parameters
    ----------
    curve : Curve
        Inertial motion on the IMU clock.
    time : ndarray, shape (k,)
        Stamps of the readings on their own clock [s].
    value : ndarray, shape (k, d)
        Readings.
    degree : int
        Of the polynomial in time that each window may drift by: 1 for velocity, 2 for a path.
    span : float
        Largest offset looked for [s].
    windows : tuple of float
        Lengths of the windows [s]; each length goes over all readings.
    correlation : float
        Correlation time of the readings' errors [s], for the standard deviation.

    Returns
    -------
    Offset
        sd from the curvature of the summed misfit.
    """
    shifts = np.arange(-span, span + 0.5 * STEP, STEP)
    inside = (time > curve.time[0] + span) & (time < curve.time[-1] - span)
    time, value = without_spikes(time[inside], value[inside])
    misfits, counts = [], []
    for rows in (r for window in windows for r in _windows(time, curve.time, window, span)):
        misfits.append(_misfit(curve, time[rows], value[rows], shifts, degree))
        counts.append(len(rows))
    if not misfits:
        return Offset(0.0, np.inf, 1.0, 0)
    share = min(1.0, float(np.median(np.diff(time))) / correlation) / len(windows)
    return _best(shifts, np.array(misfits), np.array(counts, float), share)


def neighbours(value: Array) -> Array:
    """The median of each reading and the two to either side.

    Parameters
    ----------
    value : ndarray, shape (k, d)

    Returns
    -------
    ndarray, shape (k, d)
    """
    padded = np.pad(value, ((2, 2), (0, 0)), mode="edge")
    return np.asarray(np.median(np.stack([padded[i : i + len(value)] for i in range(5)]), axis=0))


def without_spikes(time: Array, value: Array) -> tuple[Array, Array]:
    """Readings without those that stand far off their neighbours.

    Parameters
    ----------
    time : ndarray, shape (k,)
    value : ndarray, shape (k, d)

    Returns
    -------
    time, value : ndarray
        Without readings more than ten deviations (median absolute, and at least ten units) off
        the median of five.
    """
    if len(time) < 5:
        return time, value
    off = np.abs(value - neighbours(value))
    limit = np.maximum(10.0 * 1.4826 * np.median(off, axis=0), 10.0)
    sound = (off <= limit).all(axis=1)
    return time[sound], value[sound]


def _windows(time: Array, clock: Array, window: float, span: float) -> list[NDArray[np.int64]]:
    """Rows of each window that holds enough readings and no gap of the IMU."""
    rows = []
    for start in np.arange(time[0], time[-1] - 0.5 * window, window) if len(time) else []:
        index = np.flatnonzero((time >= start) & (time < start + window))
        a, b = np.searchsorted(clock, [start - span, start + window + span])
        if len(index) >= 8 and b - a > 2 and np.max(np.diff(clock[a:b])) < 1.0:
            rows.append(index)
    return rows


def _misfit(curve: Curve, time: Array, value: Array, shifts: Array, degree: int) -> Array:
    """Mean squared misfit of one window at every shift, the polynomial taken out."""
    u = (time - time.mean()) / max(np.ptp(time), 1e-9)
    q, _ = np.linalg.qr(np.vander(u, degree + 1))
    at = (time[:, None] + shifts[None, :]).ravel()
    total = np.zeros(len(shifts))
    for axis in range(value.shape[1]):
        model = np.interp(at, curve.time, curve.value[:, axis]).reshape(len(time), -1)
        left = value[:, axis : axis + 1] - model
        left -= q @ (q.T @ left)
        total += np.mean(left**2, axis=0)
    return total


def _best(shifts: Array, misfits: Array, counts: Array, share: float) -> Offset:
    """Least weighted misfit over the windows; windows that never fit weigh little."""
    noise = misfits.min(axis=1)
    scale = noise + np.median(noise)
    weight = counts / scale
    cost = weight @ misfits / weight.sum()
    k = int(np.argmin(cost))
    if k in (0, len(shifts) - 1):
        return Offset(float(shifts[k]), np.inf, 1.0, int(counts.sum()))
    bend = cost[k - 1] - 2.0 * cost[k] + cost[k + 1]
    value = float(shifts[k] + 0.5 * STEP * (cost[k - 1] - cost[k + 1]) / max(bend, 1e-30))
    independent = counts.sum() * share
    curvature = bend / STEP**2
    sd = float(np.sqrt(2.0 * cost[k] / max(curvature * independent, 1e-30)))
    zero = float(np.interp(0.0, shifts, cost))
    return Offset(value, sd, float(np.sqrt(zero / cost[k])), int(counts.sum()))


def velocity_curve(path: Trajectory, accel_bias: Array, imu: Imu) -> Curve:
    """Horizontal inertial velocity but for a slow drift: specific force turned by a known attitude.

    Parameters
    ----------
    path : Trajectory
        Attitude over time.
    accel_bias : ndarray, shape (n, 3)
        Accelerometer bias at the path's times [m/s^2].
    imu : Imu

    Returns
    -------
    Curve
        North, east [m/s] at the path's times; no correction of a filter is in it.
    """
    felt = Sums.of(imu, imu.dvel).at(path.time)
    spent = Sums.of(imu, imu.dt[:, None]).at(path.time)
    step = np.diff(felt, axis=0) - accel_bias[:-1] * np.diff(spent, axis=0)
    c = attitude.to_matrix(attitude.from_euler(path.euler))
    turned = 0.5 * np.einsum("kij,kj->ki", c[:-1] + c[1:], step)[:, :2]
    return Curve(path.time, np.concatenate([np.zeros((1, 2)), np.cumsum(turned, axis=0)]))


def path_curve(path: Trajectory) -> Curve:
    """Horizontal path but for a slow drift: the integral of a filter's velocity.

    Parameters
    ----------
    path : Trajectory

    Returns
    -------
    Curve
        North, east [m].
    """
    v = path.v_n[:, :2]
    step = 0.5 * (v[1:] + v[:-1]) * np.diff(path.time)[:, None]
    return Curve(path.time, np.concatenate([np.zeros((1, 2)), np.cumsum(step, axis=0)]))


def way(lla: Array) -> Array:
    """North and east that were gone from fix to fix, added up, as the integral of a velocity is.

    Parameters
    ----------
    lla : ndarray, shape (k, 3)

    Returns
    -------
    ndarray, shape (k, 2)
        [m]; over some kilometres an offset in one plane differs by decimetres.
    """
    steps = offset_ned(lla[1:], lla[:-1])[:, :2]
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])


def swinging(curve: Curve, path: Trajectory, arm: Array, order: int) -> Curve:
    """A curve of the antenna from that of the box.

    Parameters
    ----------
    curve : Curve
        At the path's times.
    path : Trajectory
        Attitude over time.
    arm : ndarray, shape (3,)
        Antenna from the IMU, FRD [m].
    order : int
        0 for a path, to which C l is added; 1 for a velocity, to which its rate is.

    Returns
    -------
    Curve
    """
    if not np.any(arm):
        return curve
    there = (attitude.to_matrix(attitude.from_euler(path.euler)) @ np.asarray(arm, float))[:, :2]
    return Curve(curve.time, curve.value + (np.gradient(there, path.time, axis=0) if order else there))


def led(curve: Curve, antenna: Curve, time: Array, value: Array) -> Curve:
    """A path along an inertial velocity that readings lead: what it drifts by is taken off.

    The drift is a local mean of what readings say more, to either side alike: a filter's would be late, and
    lateness is what is looked for.

    Parameters
    ----------
    curve : Curve
        Inertial velocity but for a slow drift.
    antenna : Curve
        The same of the antenna, whose readings they are.
    time : ndarray, shape (k,)
        Of the readings, on the clock of the curve [s].
    value : ndarray, shape (k, d)
        Readings.

    Returns
    -------
    Curve
        [m]
    """
    inside = (time > curve.time[0]) & (time < curve.time[-1])
    time, value = without_spikes(time[inside], value[inside])
    knots = np.arange(curve.time[0], curve.time[-1] + LED, LED)
    v = np.empty_like(curve.value)
    for axis in range(value.shape[1]):
        more = value[:, axis] - np.interp(time, antenna.time, antenna.value[:, axis])
        v[:, axis] = curve.value[:, axis] + np.interp(curve.time, knots, smooth(time, more, knots, NEAR))
    step = 0.5 * (v[1:] + v[:-1]) * np.diff(curve.time)[:, None]
    return Curve(curve.time, np.concatenate([np.zeros((1, v.shape[1])), np.cumsum(step, axis=0)]))


def smooth(time: Array, value: Array, knots: Array, width: float) -> Array:
    """Local lines through readings, at some times.

    Parameters
    ----------
    time, value : ndarray, shape (k,)
    knots : ndarray, shape (n,)
        Increasing [s].
    width : float
        Deviation of the weight about a knot [s].

    Returns
    -------
    ndarray, shape (n,)
        Where there is no reading near, as at the knot before.
    """
    found = np.zeros(len(knots))
    for k, at in enumerate(knots):
        a, b = np.searchsorted(time, [at - 3.0 * width, at + 3.0 * width])
        u, y = time[a:b] - at, value[a:b]
        w = np.exp(-0.5 * (u / width) ** 2)
        s0, s1, s2 = w.sum(), w @ u, w @ u**2
        d = s0 * s2 - s1**2
        if d > 1e-6:
            found[k] = (s2 * (w @ y) - s1 * (w @ (u * y))) / d
        elif k:
            found[k] = found[k - 1]
    return found
