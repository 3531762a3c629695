"""Silences of an IMU log that are too long to be a part of one drive."""

from __future__ import annotations

from typing import Final

import numpy as np

from gapless.io.log import Log
from gapless.io.order import parts

MOST_SILENCE: Final = 900.0
"""Longest silence within a recording [s]. A clock set to another time zone leaps by multiples of this, and
after a pause as long a drive begins anew, with nothing left of what was known."""


def check_silence(log: Log) -> None:
    """Refuse an IMU log that is silent for a quarter of an hour or more.

    Parameters
    ----------
    log : Log
        Stamps that do not go back.

    Raises
    ------
    RecordingError
    """
    step = np.diff(log["time"])
    long = 1 + np.flatnonzero(step >= MOST_SILENCE)
    if len(long):
        k = int(long[0])
        log.refuse(
            f"time leaps ahead by {in_words(float(step[k - 1]))} here: a clock that was set, or a long pause",
            parts(log, long),
            k,
        )


def in_words(seconds: float) -> str:
    """Seconds, and in brackets hours, days or years where they are many.

    Parameters
    ----------
    seconds : float

    Returns
    -------
    str
    """
    for unit, length in (("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0)):
        if seconds >= length:
            return f"{seconds:.10g} s ({seconds / length:.3g} {unit})"
    return f"{seconds:.4g} s"
