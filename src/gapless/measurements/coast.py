"""Ticks in one go: samples, constraints and rows compiled into one call, for as long as nothing surprises.

It does what a navigator does on ticks, with the same parts, and hands back wherever Python is needed: a
constraint that is a surprise, for a rule to judge; a bridge that wants to be told.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gapless._numba import inline, inlined, kernel
from gapless.events import EPS
from gapless.filters.update import assess, correct
from gapless.inertial.belief import inject
from gapless.inertial.layout import ROW
from gapless.inertial.propagate import ROUND, TICK_DT, TICK_W, propagate
from gapless.inertial.trail import full, note
from gapless.measurements.stillness import rests
from gapless.measurements.vehicle import slip
from gapless.measurements.zero_velocity import zero_velocity
from gapless.recording import Array

_propagate, _inject = inlined(propagate), inlined(inject)
_assess, _correct = inlined(assess), inlined(correct)
_zero_velocity, _slip = inlined(zero_velocity), inlined(slip)

STANDSTILL, SLIP = 0, 1
"""The constraints that are compiled, in their order."""
SIZES: Final = {"zero_velocity": 6, "nonholonomic": 2}
"""What they are called, and how many numbers they observe."""
TICKS, ROWS, UPDATES, WHY = 0, 1, 2, 4
"""Indices of what `coast` counts: ticks, rows, updates of each constraint; and why it came back."""
ALL_RUN, ROOM, SURPRISE, BRIDGES = 0, 1, 2, 4
"""Why it came back: samples are used up, there is no room for more, a constraint surprises (2 and 3), bridges
are to be told. With the last two a tick is not over yet."""
GNSS, BRIDGE, OTHERS, OWN = 0, 1, 2, 3
"""Indices of when what was heard last: fixes, bridges, other holds, the compiled constraints."""
SOURCES: Final = ("gnss", "bridge", "constraints", "ins")
"""What holds a row, by its number."""
NEXT, LAST, EVERY, SCALE = 0, 1, 2, 3
"""Indices of what a row needs: when it is due, time of the last one, their distance, factor on P."""
SHARED, STATE = 2, 11
"""First columns of a row after time and source: covariance on top of P's, state; then P's kept elements."""


@kernel
def coast(
    x: Array,
    memory: Array,
    width: int,
    n: int,
    p: Array,
    scratch: Array,
    error: Array,
    offsets: NDArray[np.int64],
    noise: Array,
    time: Array,
    dt: Array,
    dtheta: Array,
    dvel: Array,
    first: int,
    last: int,
    period: float,
    tick: float,
    flush: bool,
    store: Array,
    ends: NDArray[np.int64],
    length: float,
    corrected: Array,
    still: Array,
    still_memory: Array,
    slips: Array,
    slip_memory: Array,
    bounds: Array,
    latest: Array,
    due: float,
    heard: Array,
    row: Array,
    shared: Array,
    kept: NDArray[np.int64],
    rows: Array,
    found: Array,
    motion: Array,
    count: NDArray[np.int64],
) -> int:
    """Run samples first..last-1 with all that is due on ticks.

    Parameters
    ----------
    x, memory, width, p, scratch, error, offsets, noise, time, dt, dtheta, dvel, first, last
        As for `propagate`; feedback only.
    n : int
        Error states.
    period, tick, flush
        As for `propagate`.
    store, ends, length, corrected
        As `Trail` keeps them.
    still, slips : ndarray, shape (8,), (7,), or (0,)
        Tuning of the two constraints; empty where one is off.
    still_memory, slip_memory : ndarray
        Their memories.
    bounds : ndarray, shape (2,)
        What z' S^-1 z does not surprise.
    latest : ndarray, shape (2,)
        Time of the last innovation written of each [s].
    due : float
        Bridges are to be told from then on [s].
    heard : ndarray, shape (5,)
        When what was heard last [s]; changed in place.
    row : ndarray, shape (4,)
        See the constants; changed in place.
    shared : ndarray, shape (3, 3)
        Covariance of the position on top of P's [m^2].
    kept : ndarray of int
        Elements of P that a row keeps.
    rows : ndarray, shape (k, 12 + n + kept)
        Rows written; room for k ticks.
    found : ndarray, shape (2, k, 44)
        Innovations written: time, z' S^-1 z, z, S.
    motion : ndarray, shape (8,)
        End and length of the last tick [s], what was felt in it.
    count : ndarray of int, shape (5,)
        See the constants.

    Returns
    -------
    int
        Index of the next sample.
    """
    count[:] = 0
    k = first
    while k < last:
        if count[TICKS] == rows.shape[0] or (length > 0.0 and full(store, ends)):
            count[WHY] = ROOM
            break
        k = _propagate(
            x, memory, width, p, scratch, error, offsets, noise,
            time, dt, dtheta, dvel, k, last, period, tick, flush,
        )  # fmt: skip
        now, lasted = time[k - 1], memory[TICK_DT]
        ticked = lasted >= tick - ROUND
        if length > 0.0 and (ticked or (flush and k == last)):
            note(store, ends, length, corrected, now, x[3:6])
        if not ticked:
            break
        count[TICKS] += 1
        motion[0], motion[1], motion[2:] = now, lasted, memory[TICK_W:] / lasted
        memory[TICK_DT:] = 0.0
        felt = motion[2:]
        if still.size > 0 and rests(x, p, ROW, now, lasted, felt, still, still_memory):
            z, h, r = _zero_velocity(x, n, felt, still[0], still[1])
            if not _take(STANDSTILL, now, x, p, n, z, h, r, bounds, latest, corrected, heard, found, count):
                count[WHY] = SURPRISE + STANDSTILL
                break
        if slips.size > 0 and now - slip_memory[0] >= slips[4] - 1e-3:
            forward, z, h, r = _slip(x, offsets, n, slips[6:], slips[5], felt, slips[0], slips[1], slips[2])
            if forward >= slips[3]:
                slip_memory[0] = now
                if not _take(SLIP, now, x, p, n, z, h, r, bounds, latest, corrected, heard, found, count):
                    count[WHY] = SURPRISE + SLIP
                    break
        if now >= due:
            count[WHY] = BRIDGES
            break
        _write(now, x, p, heard, row, shared, kept, rows, count)
    return k


@inline
def _take(
    which: int,
    time: float,
    x: Any,
    p: Any,
    n: int,
    z: Any,
    h: Any,
    r: Any,
    bounds: Any,
    latest: Any,
    corrected: Any,
    heard: Any,
    found: Any,
    count: Any,
) -> bool:
    """Update, unless it is a surprise."""
    m = z.size
    nis, s, hp = _assess(p, ROW, n, z, h, r)
    if not nis <= bounds[which]:
        return False
    if time > latest[which]:
        k = count[UPDATES + which]
        latest[which], found[which, k, 0], found[which, k, 1] = time, time, nis
        for i in range(m):
            found[which, k, 2 + i] = z[i]
            for j in range(m):
                found[which, k, 2 + m + m * i + j] = s[i, j]
        count[UPDATES + which] = k + 1
    dx = _correct(p, ROW, n, z, h, r, s, hp, 1.0)
    _inject(x, dx)
    for i in range(3):
        corrected[i] += dx[3 + i]
    heard[OWN + which] = time
    return True


@inline
def _write(
    now: float, x: Any, p: Any, heard: Any, row: Any, shared: Any, kept: Any, rows: Any, count: Any
) -> None:
    """Write a row where one is due."""
    if now < row[NEXT] - EPS:
        return
    row[NEXT] = max(row[NEXT] + row[EVERY], now + 0.5 * row[EVERY])
    if now <= row[LAST]:
        return
    row[LAST] = now
    k, n = count[ROWS], x.size
    held = 3
    if now - heard[GNSS] < 1.6:
        held = 0
    elif now - heard[BRIDGE] < 1.6:
        held = 1
    elif now - max(heard[OTHERS], heard[OWN + STANDSTILL], heard[OWN + SLIP]) < 1.0:
        held = 2
    rows[k, 0], rows[k, 1] = now, held
    more = row[SCALE] - 1.0 if held > 0 else 0.0
    for i in range(3):
        for j in range(3):
            rows[k, SHARED + 3 * i + j] = shared[i, j] + more * p[i * ROW + j]
    for i in range(n):
        rows[k, STATE + i] = x[i]
    for i in range(kept.size):
        rows[k, STATE + n + i] = p[kept[i]]
    count[ROWS] = k + 1
