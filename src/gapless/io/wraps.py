"""Clocks that count to a fixed number and begin again at zero: the GPS week, the day, counters of 32 bits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from gapless.io.log import Log
from gapless.trip.recording import Array, Note

WRAPS: Final = {
    604800.0: "a GPS week",
    86400.0: "a day",
    2.0**32 * 1e-6: "32 bits of microseconds",
    2.0**32 * 1e-3: "32 bits of milliseconds",
}
"""What a clock counts to [s], and what that is."""
_SURE: Final = 2e-3
"""Silence, in units of the whole count, across which a step back of it all but that is taken for its end."""


def unwrapped(logs: Mapping[str, Log]) -> tuple[dict[str, Log], list[Note]]:
    """Stamps that go on where a clock's count ended and began again.

    A log that lies wholly after the end, while the IMU's reaches across it, is moved by the same count,
    and so is the IMU's where it is the other way round.

    Parameters
    ----------
    logs : mapping of str to Log
        "imu" among them; `time` [s], empty cells allowed. Logs without a time are left alone.

    Returns
    -------
    logs : dict of str to Log
    notes : list of Note
    """
    found, notes = dict(logs), list[Note]()
    counts = set[float]()
    for sensor, log in logs.items():
        if "time" not in log:
            continue
        for count, name in WRAPS.items():
            time, first = _unwrapped(found[sensor]["time"], count)
            if first is not None:
                counts.add(count)
                what = f"the clock counts {name} and began again at row {log.number(first)}"
                added = f"; {count:.10g} s added from there on"
                notes.append(log.note(what + added, len(time) - first))
                found[sensor] = _stamped(found[sensor], time)
    for count in counts:
        notes += _together(found, logs, count)
    return found, notes


def _stamped(log: Log, time: Array) -> Log:
    return replace(log, columns={**log.columns, "time": time})


def _unwrapped(time: Array, count: float) -> tuple[Array, int | None]:
    """Stamps with the count added after each end of it, and the first row that it was added to."""
    known = np.flatnonzero(np.isfinite(time))
    step = np.diff(time[known])
    ended = (step < 0.0) & (step > -count) & (step < (_SURE - 1.0) * count)
    if not ended.any():
        return time, None
    undone = (step > (1.0 - _SURE) * count) & (step < (1.0 + _SURE) * count)  # rows exchanged across the end
    turns = np.cumsum(ended.astype(float) - (undone & (np.cumsum(ended) > 0)))
    added = np.zeros(len(time))
    added[known[1:]] = count * turns
    return time + added, int(known[1:][ended][0])


def _together(found: dict[str, Log], logs: Mapping[str, Log], count: float) -> list[Note]:
    """Logs moved by a count so that they lie beside the others, where only some hold its end."""
    notes = []
    whole = [s for s, log in logs.items() if "time" in log and found[s] is log]
    across = [s for s in found if found[s] is not logs[s]]
    low, high = (
        edge([edge(found[s]["time"][np.isfinite(found[s]["time"])]) for s in across]) for edge in (min, max)
    )
    for sensor in whole:
        time = logs[sensor]["time"]
        known = time[np.isfinite(time)]
        if not len(known) or (known[-1] >= low and known[0] <= high):
            continue
        if known[-1] + count >= low and known[0] + count <= high:
            found[sensor] = _stamped(logs[sensor], time + count)
            what = f"begins after the clock's count of {WRAPS[count]} ended; {count:.10g} s added"
            notes.append(logs[sensor].note(what, len(time)))
    return notes
