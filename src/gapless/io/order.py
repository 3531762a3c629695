"""Rows in the order of their stamps: copies, late rows, stray stamps; and clocks that start anew.

A row that came late left a hole where it belongs, and is put there. Where time goes back and there is no
hole, the clock was set back or started anew: two stretches of time lie over each other, and sorting
would shuffle them into one.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from gapless.io.clock import HEAD, nominal_interval
from gapless.io.log import Log
from gapless.trip.recording import Array, Note

_SPARE: Final = 0.1
"""Share of rows out of order beyond which a log is refused."""
_REACH: Final = 20
"""Most rows that a late row and those around it make up: loggers' queues hold a few."""
_HOLE: Final = 0.25
"""By how many usual intervals a hole is longer than the late rows that fill it, at least: one where stamps
are even, none where two stretches of time lie over each other."""
_ROOM: Final = 0.75
"""Least distance, in usual intervals, from the row before a stray row to the one after it."""


def in_order(log: Log, notes: list[Note]) -> Log:
    """Rows once each, their stamps never going back.

    Parameters
    ----------
    log : Log
        Stamps all finite, two rows or more.
    notes : list of Note
        Appended to.

    Returns
    -------
    Log
        Stamps may still repeat, with other values.

    Raises
    ------
    RecordingError
        If the clock started anew or was set back, two clocks' rows stand among each other, or stamps
        go back again and again.
    """
    log = _without_copies(log, notes)
    back = np.diff(log["time"]) < 0.0
    if back.any():
        if back.sum() > max(2.0, _SPARE * len(log)):
            _refuse_mixed(log, back)
        log = _mended(log, notes)
    return log


def one_an_epoch(log: Log, notes: list[Note]) -> Log:
    """Rows whose stamp is later than that of the row before; of several with one stamp the first.

    Parameters
    ----------
    log : Log
        Stamps that do not go back.
    notes : list of Note
        Appended to.

    Returns
    -------
    Log

    Raises
    ------
    RecordingError
        If more than a tenth of the rows share a stamp with the one before.
    """
    again = np.diff(log["time"], prepend=-np.inf) == 0.0
    bad = int(again.sum())
    if bad > max(2.0, _SPARE * len(log)) or len(log) - bad < 2:
        log.refuse(
            f"{bad} of {len(log)} stamps repeat with other values, this one first",
            "two devices, or two messages an epoch, are in one file: keep one row an epoch",
            int(np.argmax(again)),
        )
    if bad:
        notes.append(log.note("rows whose stamp repeats with other values dropped", bad))
        return log.take(~again)
    return log


def parts(log: Log, starts: NDArray[np.int64]) -> str:
    """How to part a log, in the user's row numbers.

    Parameters
    ----------
    log : Log
    starts : ndarray of int
        Rows that begin a part, but for the first.

    Returns
    -------
    str
    """
    edges = [0, *starts[:3].tolist(), len(log)]
    if len(starts) > 3:
        edges[-1] = int(starts[3])
    rows = [f"{log.number(a)} to {log.number(b - 1)}" for a, b in pairwise(edges)]
    more = ", and so on" if len(starts) > 3 else ""
    apart = f"rows {', '.join(rows)}{more} are drives apart"
    return f"part the log there, and the other logs at the same moment: {apart}"


def _without_copies(log: Log, notes: list[Note]) -> Log:
    """Rows that are not copies of the one before or, where time went back, of any before."""
    time = log["time"]
    step = np.diff(time)
    if (step > 0.0).all():
        return log
    copy = np.zeros(len(log), bool)
    again = 1 + np.flatnonzero(step == 0.0)
    copy[again] = _same(log, again, again - 1)
    if (step < 0.0).any():
        behind = _behind(time)
        _, index, count = np.unique(time, return_inverse=True, return_counts=True)
        some = np.flatnonzero(count[index] > 1)
        keys = [np.nan_to_num(column[some], nan=np.inf) for column in log.columns.values()]
        some = some[np.lexsort([some, *keys])]
        copy[some[1:]] |= _same(log, some[1:], some[:-1]) & behind[some[1:]]
    bad = int(copy.sum())
    if not bad or len(log) - bad < 2:
        return log
    notes.append(log.note("rows that repeat one before dropped", bad))
    return log.take(~copy)


def _same(log: Log, rows: NDArray[np.int64], others: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether rows hold the same, cell by cell; an empty cell equals an empty one."""
    same = np.ones(len(rows), bool)
    for column in log.columns.values():
        a, b = column[rows], column[others]
        same &= (a == b) | (np.isnan(a) & np.isnan(b))
    return same


def _behind(time: Array) -> NDArray[np.bool_]:
    """Rows whose time was there already: before the latest, or level with it and right after such a row."""
    latest = np.maximum.accumulate(time)[:-1]
    behind = np.concatenate([[False], time[1:] < latest])
    behind[1:] |= (time[1:] == latest) & behind[:-1]
    return behind


def _mended(log: Log, notes: list[Note]) -> Log:
    """Late rows in their places, single stray stamps gone; anything else is a clock that started anew."""
    usual = _usual(log["time"])
    found, moved = _late_in_place(log, usual)
    found = found.take(~_far_off(found["time"], usual))
    found, more = _late_in_place(found, usual)
    found = found.take(~_strays(found, usual))
    moved, bad = moved + more, len(log) - len(found)
    if bad > max(2.0, _SPARE * len(log)) or len(found) < 2:
        _refuse_mixed(log, np.diff(log["time"]) < 0.0)
    if moved:
        notes.append(log.note("rows that were not in the order of their stamps put in order", moved))
    if bad:
        notes.append(log.note("rows whose stamp is out of line with those around it dropped", bad))
    return found


def _usual(time: Array) -> float:
    """The nominal interval of stamps that go back here and there."""
    step = np.diff(time[: HEAD + 1])
    middle = float(np.median(step[step > 0.0])) if (step > 0.0).any() else 0.0
    step = step[(step >= 0.0) & (step <= _REACH * middle)]
    return nominal_interval(np.cumsum(np.append(0.0, step))) if len(step) else 0.0


def _late_in_place(log: Log, usual: float) -> tuple[Log, int]:
    """Rows that came late put where they left a hole, and how many rows changed places."""
    time, order = log["time"], np.arange(len(log))
    for a, b in _tangles(time):
        if _fits(time, a, b, usual):
            order[a:b] = a + np.argsort(time[a:b], kind="stable")
    return log.take(order), int((order != np.arange(len(order))).sum())


def _strays(log: Log, usual: float) -> NDArray[np.bool_]:
    """Late rows around which the others go on as if it were not there; it refuses those that do not."""
    time, stray = log["time"], np.zeros(len(log), bool)
    for a, b in _tangles(time):
        late = a + np.flatnonzero(_late(time[a:b]))
        if (np.append(time, np.inf)[late + 1] < time[late - 1] + _ROOM * usual).any():
            _refuse_restart(log, usual)
        stray[late] = True
    return stray


def _late(time: Array) -> NDArray[np.bool_]:
    """Rows earlier than one before."""
    return time < np.maximum.accumulate(time)


def _far_off(time: Array, usual: float) -> NDArray[np.bool_]:
    """Single rows far from those before and after, which follow each other."""
    before, after = np.concatenate([[-np.inf], time[:-1]]), np.append(time[1:], np.inf)
    later = np.append(time[2:], [-np.inf, -np.inf])
    far = _REACH * usual
    ahead = (time > after + far) & (time > later)
    behind = time < before - far
    return np.asarray((ahead | behind) & (after >= before))


def _tangles(time: Array) -> list[tuple[int, int]]:
    """Smallest stretches of rows, from and until, that sorting would stay within."""
    before = np.maximum.accumulate(time)[:-1]
    after = np.minimum.accumulate(time[::-1])[::-1][1:]
    edges = np.concatenate([[0], 1 + np.flatnonzero(before <= after), [len(time)]])
    long = np.flatnonzero(np.diff(edges) > 1)
    return [(int(edges[k]), int(edges[k + 1])) for k in long]


def _fits(time: Array, a: int, b: int, usual: float) -> bool:
    """Whether each late row of a to b has a hole among the others where it belongs."""
    if b - a > _REACH:
        return False
    rows = time[max(a - 1, 0) : b]
    late = _late(rows)
    there = rows[~late] if a else np.concatenate([[-np.inf], rows[~late]])
    hole = np.searchsorted(there, rows[late], side="right")
    place, count = np.unique(hole, return_counts=True)
    return bool((there[place] - there[place - 1] >= (count + _HOLE) * usual).all())


def _refuse_restart(log: Log, usual: float) -> NoReturn:
    time = log["time"]
    back = 1 + np.flatnonzero(np.diff(time) < -_REACH * usual)
    if not len(back):
        back = 1 + np.flatnonzero(np.diff(time) < 0.0)
    k = int(back[0])
    log.refuse(
        f"the clock starts anew or was set back here: time goes back by {time[k - 1] - time[k]:.6g} s, "
        f"from {time[k - 1]:.6f} to {time[k]:.6f}",
        parts(log, back),
        k,
    )


def _refuse_mixed(log: Log, back: NDArray[np.bool_]) -> NoReturn:
    what = f"time goes back again and again, in {int(back.sum())} of {len(log)} rows, here first"
    cure = "log each row with the time of its measurement, in that order"
    if _two_clocks(log["time"]):
        cure = "rows of two devices or two runs stand among each other: keep those of one"
    log.refuse(what, cure, int(np.argmax(back)) + 1)


def _two_clocks(time: Array) -> bool:
    """Whether rows fall into two rows of stamps, each of which only goes on."""
    ahead, behind, few = -np.inf, -np.inf, 0
    for t in time.tolist():
        if t >= ahead:
            ahead = t
        elif t >= behind:
            behind, few = t, few + 1
        else:
            return False
    return few > _SPARE * len(time)
