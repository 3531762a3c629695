"""A clock offset found finely, with errors that last: generalised least squares in time.

Readings less the inertial curve are what the receiver and the curve got wrong, plus the offset times the
rate of the curve. What they got wrong is white noise, an error that wanders for a minute, and the random
walk of a curve that is an integral; how much of each is what makes the residuals most likely. So the
deviation of the offset knows how few independent readings there are.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.alignment.clock import Curve, neighbours
from gapless.filters.whiten import whiten
from gapless.trip.recording import Array

BIN: Final = 1.0
"""Readings closer than this are taken together [s]: their errors are hardly independent."""
BLOCK: Final = 300.0
"""Stretches of which each has a level of its own [s]."""
LASTS: Final = 60.0
"""Correlation time of the error that wanders [s]."""
SMOOTH: Final = 0.3
"""Positions' wander over their white errors is taken to be no more: what a receiver's own filter makes smooth
follows its velocities from fix to fix, and their clock."""
FELT: Final = 3.0
"""The same of velocities against what was felt."""
_RATIOS: Final = (0.0, 0.3, 1.0, 3.0, 10.0)
"""Deviations of the wandering part over the white one that are tried."""
_WALKS: Final = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0)
"""Random walks [1/sqrt(s)] over the white deviation that are tried."""
_ALONE: Final = 7.0
"""Deviations (by the median) of a residual against its neighbours' beyond which it is a spike."""
_SHARES: Final = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0)
"""The same, where the random walk is known."""
_SPIKE: Final = 3.5
"""Whitened residuals beyond so many deviations count less."""


class Shift(NamedTuple):
    """An offset, and the errors that it was found among.

    Parameters
    ----------
    value, sd : float
        Added to stamps, and its standard deviation [s].
    drift, drift_sd : float
        By how much the offset grows in a second; the offset is that at `middle`.
    middle : float
        [s]
    white, wander : float
        Standard deviations of the readings' errors in one axis, of bins of a second.
    """

    value: float
    sd: float
    drift: float
    drift_sd: float
    middle: float
    white: float
    wander: float


class _Block(NamedTuple):
    """Bins of one stretch: residuals and regressors, columns by axis."""

    time: Array
    many: Array
    left: Array
    rate: Array
    scaled: Array
    turned: Array


def shift(
    curve: Curve, time: Array, value: Array, start: float, degree: int, felt: bool = False
) -> Shift | None:
    """Offset near a first guess.

    Parameters
    ----------
    curve : Curve
        Inertial motion on the IMU clock.
    time : ndarray, shape (k,)
        Stamps of the readings on their own clock [s].
    value : ndarray, shape (k, d)
        Readings.
    start : float
        The guess [s]; an error of a tenth of a second does no harm.
    degree : int
        Of the polynomial in time that a block may drift by beside its random walk.
    felt : bool
        Whether the curve is what an accelerometer felt, and may be too large or turned by some per cent.

    Returns
    -------
    Shift or None
        None where there is too little.
    """
    found: Shift | None = None
    time, value = _sound(curve, time, value, start)
    for _ in range(2):
        blocks = _blocks(curve, time, value, start if found is None else found.value)
        if sum(len(b.time) for b in blocks) < 20:
            return None
        before, (step, sd, drift, drift_sd, middle, white, wander) = (
            start if found is None else found.value,
            _fit(blocks, degree, felt),
        )
        found = Shift(before + step, sd, drift, drift_sd, middle, white, wander)
    return found


def wandering(curve: Curve, time: Array, value: Array, walk: float) -> tuple[float, float]:
    """What of positions' errors is white, and what wanders, held against a path whose own drift is known.

    Parameters
    ----------
    curve : Curve
        Path on the IMU clock [m].
    time : ndarray, shape (k,)
        Stamps, their offset added [s].
    value : ndarray, shape (k, 2)
        Positions [m].
    walk : float
        Random walk of the path [m/sqrt(s)].

    Returns
    -------
    white, wander : float
        Standard deviations in one axis [m], the former of means over a second; NaN where there is too little.
    """
    blocks = _blocks(curve, *_sound(curve, time, value, 0.0), 0.0)
    if sum(len(b.time) for b in blocks) < 100:
        return np.nan, np.nan
    spare = [np.ones(len(b.time)) for b in blocks]
    free = min(
        (_solve(blocks, spare, 0, time[0], False, r, w) for r in _RATIOS for w in _WALKS),
        key=lambda one: one.cost,
    )
    white = float(np.median(free.scales))
    found = [(_solve(blocks, spare, 0, time[0], False, r, walk / white), r) for r in _SHARES]
    best, ratio = min(found, key=lambda one: one[0].cost)
    scale = float(np.median(best.scales))
    return scale, ratio * scale


def _sound(curve: Curve, time: Array, value: Array, offset: float) -> tuple[Array, Array]:
    """Readings without those whose residual stands off its neighbours': a spike is no news."""
    if len(time) < 5:
        return time, value
    model = [np.interp(time + offset, curve.time, c) for c in curve.value.T]
    left = value - np.column_stack(model)
    off = np.linalg.norm(left - neighbours(left), axis=1)
    sound = off <= max(_ALONE * 1.4826 * float(np.median(off)), 1e-9)
    return time[sound], value[sound]


def _blocks(curve: Curve, time: Array, value: Array, offset: float) -> list[_Block]:
    """Means of residuals and of the curve's rate in bins, by stretches without a gap of the curve."""
    at = time + offset
    slope = np.gradient(curve.value, curve.time, axis=0)
    there = (at > curve.time[0]) & (at < curve.time[-1])
    holes = np.flatnonzero(np.diff(curve.time) > 1.0)
    for a, b in zip(curve.time[holes], curve.time[holes + 1], strict=True):
        there &= (at <= a) | (at >= b)
    at, value = at[there], value[there]
    if len(at) < 2:
        return []
    columns = range(value.shape[1])
    model = np.column_stack([np.interp(at, curve.time, curve.value[:, i]) for i in columns])
    left, model = value - model, model - model.mean(axis=0)
    rate = np.column_stack([np.interp(at, curve.time, slope[:, i]) for i in columns])
    piece = np.searchsorted(curve.time[holes], at)
    span = at[-1] - at[0]
    length = span / max(1, round(span / BLOCK)) + 1e-6
    block = np.floor((at - at[0]) / length).astype(int) * (len(holes) + 1) + piece
    made = []
    for one in np.unique(block):
        k = np.flatnonzero(block == one)
        cell = np.unique(np.floor((at[k] - at[k[0]]) / BIN).astype(int), return_inverse=True)[1]
        count = np.bincount(cell).astype(float)
        if len(count) < 10:
            continue
        mean = [np.bincount(cell, x) / count for x in (at[k], *left[k].T, *rate[k].T, *model[k].T)]
        d = left.shape[1]
        off, slopes, whole = (np.column_stack(mean[1 + i * d : 1 + (i + 1) * d]) for i in range(3))
        made.append(_Block(mean[0], count, off, slopes, whole, whole[:, ::-1] * np.array([-1.0, 1.0])))
    return made


def _fit(
    blocks: list[_Block], degree: int, felt: bool
) -> tuple[float, float, float, float, float, float, float]:
    """Most likely errors, then offset and drift with their deviations."""
    many = sum(len(b.time) for b in blocks)
    middle = sum(float(b.time.sum()) for b in blocks) / many
    spare = [np.ones(len(b.time)) for b in blocks]
    tried = [(r, w) for r in _RATIOS for w in _WALKS if max(r, 8.0 * w) <= (FELT if felt else SMOOTH)]
    found = [(_solve(blocks, spare, degree, middle, felt, r, w), r, w) for r, w in tried]
    best, ratio, walk = min(found, key=lambda one: one[0].cost)
    for _ in range(2):
        strays = [(np.abs(e).max(axis=1) / _SPIKE) ** 2 for e in best.whitened]
        spare = [np.maximum(s, e) for s, e in zip(spare, strays, strict=True)]
        best = _solve(blocks, spare, degree, middle, felt, ratio, walk)
    scale, (sd, drift_sd) = float(np.median(best.scales)), _deviations(best)
    return best.value[0], sd, best.value[1], drift_sd, middle, scale, scale * ratio


class _Solved(NamedTuple):
    """Least squares: whitened residuals of each block, and the regressors beside them, axis by axis."""

    cost: float
    value: tuple[float, float]
    cov: Array
    scales: Array
    whitened: list[Array]
    parts: list[Array]


def _solve(
    blocks: list[_Block],
    spare: list[Array],
    degree: int,
    middle: float,
    felt: bool,
    ratio: float,
    walk: float,
) -> _Solved:
    """Offset and drift by least squares, each block's scale its own, and minus twice the log-likelihood."""
    parts, logs, wanted = [], 0.0, 5 if felt else 3
    d = blocks[0].left.shape[1]
    for block, extra in zip(blocks, spare, strict=True):
        t = block.time
        own = np.vander((t - t.mean()) / max(np.ptp(t), 1.0), degree + 1)
        columns = [own]
        for axis in range(d):
            rate = block.rate[:, axis]
            columns += [block.left[:, axis], rate, rate * (t - middle)]
            columns += [block.scaled[:, axis], block.turned[:, axis]] if felt else []
        white, log_det = whiten(t, extra, ratio, LASTS, walk, np.column_stack(columns))
        logs += d * log_det
        q, r = np.linalg.qr(white[:, : degree + 1])
        logs += 2.0 * d * np.log(np.abs(np.diag(r))).sum()
        white = white[:, degree + 1 :]
        parts += np.hsplit(white - q @ (q.T @ white), d)
    scales, sizes = np.ones(len(blocks)), [len(b.time) * d - d * (degree + 1.0) for b in blocks]
    many = wanted - 1
    value: Array = np.zeros(many)
    cov = np.asarray(np.eye(many))
    for _ in range(4):
        normal, right = np.zeros((many, many)), np.zeros(many)
        for k, white in enumerate(parts):
            a = white[:, 1:] / scales[k // d]
            normal += a.T @ a
            right += a.T @ (white[:, 0] / scales[k // d])
        normal += np.diag(
            [1e-12, 1e6, *[400.0] * (many - 2)]
        )  # no clock runs wrong by more than a thousandth; a scale by 5 %
        cov = np.asarray(np.linalg.inv(normal))
        value = cov @ right
        off = [w[:, 0] - w[:, 1:] @ value for w in parts]
        squares = np.array([sum(float(e @ e) for e in off[k * d : k * d + d]) for k in range(len(blocks))])
        scales = np.sqrt(np.maximum(squares / np.array(sizes), 1e-12))
    cost = logs + float(2.0 * np.array(sizes) @ np.log(scales))
    whitened = [np.column_stack([off[k * d + i] for i in range(d)]) / scales[k] for k in range(len(blocks))]
    return _Solved(cost, (float(value[0]), float(value[1])), cov, scales, whitened, parts)


def _deviations(best: _Solved) -> tuple[float, float]:
    """Of offset and drift, where residuals are not white all the same (Newey and West 1987)."""
    cov, middle = best.cov, np.zeros_like(best.cov)
    for k, (scale, off) in enumerate(zip(best.scales, best.whitened, strict=True)):
        d = off.shape[1]
        u = np.sum([best.parts[k * d + i][:, 1:] * off[:, i : i + 1] for i in range(d)], axis=0) / scale
        reach = min(int(LASTS / BIN), len(u) - 1)
        for lag in range(reach + 1):
            both = u[lag:].T @ u[: len(u) - lag]
            middle += (1.0 - lag / (reach + 1.0)) * (both + both.T) * (0.5 if lag == 0 else 1.0)
    sd = np.sqrt(np.maximum(np.diag(cov), np.diag(cov @ middle @ cov)))
    return float(sd[0]), float(sd[1])
