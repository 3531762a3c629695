"""A box whose gyros felt how it was tipped: it lies on another side now, and no car does.

Its attitude is known; what it sits in is not the car's axes as they were. A road leans by less than ten
degrees, a car on it little more. So where the vertical comes from another side of the box for good, while
the force agrees with it, the box is what was moved.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless._numba import kernel
from gapless.trip.recording import Array
from gapless.units import DEG
from gapless.witnesses.jolt import between

ANGLE: Final = 18.0 * DEG
"""No road leans so far from the usual one [rad]."""
AGREES: Final = 6.0 * DEG
"""The force leans less from the filter's vertical, or it is the filter that leans [rad]."""
LASTS: Final = 15
"""Ticks for which it must lie so."""
SLOWLY: Final = 0.002
"""Share of a tick in what is usual."""
KNOWN: Final = 100
"""Ticks after which that is known."""
FAST: Final = 0.7
"""A rate beyond this may be a hand's [rad/s]."""
LEAST: Final = 8.0 * DEG
"""What was turned fast by less is not spoken of [rad]."""
GRIP: Final = 9.0
"""No tyre holds a car in a turn beyond this [m/s^2]."""
COUNT, LEANING, SLIDES, BEFORE = 3, 4, 5, 6
"""Where in the memory of `sits` there are: ticks that told the usual vertical (which comes first), ticks for
which it has been another, the largest v x w of a fast turn [m/s^2], and the attitude before that."""


@kernel
def sits(m: Array, c_nb: Array, tilt: float, lean: float, speed: float, rate: Array) -> int:
    """Whether a box sits as usual, lies on another side, or was just turned as no car turns.

    Parameters
    ----------
    m : ndarray, shape (BEFORE + 9,)
        Changed in place.
    c_nb : ndarray, shape (3, 3)
    tilt : float
        How far the filter may be wrong about the vertical [rad].
    lean : float
        Of the mean force from that vertical [rad].
    speed : float
        [m/s]
    rate : ndarray, shape (3,)
        [rad/s]

    Returns
    -------
    int
        0, 1 or 2.
    """
    fast = np.sqrt(rate[0] ** 2 + rate[1] ** 2 + rate[2] ** 2)
    if fast > FAST:
        about = abs(c_nb[2, 0] * rate[0] + c_nb[2, 1] * rate[1] + c_nb[2, 2] * rate[2])
        m[SLIDES] = max(m[SLIDES], 1e-9, speed * about)
        return 0
    if m[SLIDES] > 0.0:
        slides, trace, share = m[SLIDES], 0.0, 0.0
        m[SLIDES] = 0.0
        for i in range(3):
            share += m[BEFORE + 6 + i] * c_nb[2, i]
            for j in range(3):
                trace += m[BEFORE + 3 * i + j] * c_nb[i, j]
        if 0.5 * (trace - 1.0) < np.cos(LEAST) and (slides > GRIP or share < np.cos(0.5 * ANGLE)):
            return 2
    for i in range(3):
        for j in range(3):
            m[BEFORE + 3 * i + j] = c_nb[i, j]
    if not lean < AGREES:
        return 0
    length = np.sqrt(m[0] ** 2 + m[1] ** 2 + m[2] ** 2)
    share = m[0] * c_nb[2, 0] + m[1] * c_nb[2, 1] + m[2] * c_nb[2, 2]
    if m[COUNT] >= KNOWN and share < length * np.cos(min(ANGLE + 3.0 * tilt, np.pi)):
        m[LEANING] += 1.0
        return 1 if m[LEANING] >= LASTS else 0
    m[LEANING] = 0.0
    m[COUNT] += 1.0
    for i in range(3):
        m[i] += max(SLOWLY, 1.0 / m[COUNT]) * (c_nb[2, i] - m[i])
    return 0


@dataclass
class Seat:
    """How a box sits.

    Parameters
    ----------
    memory : ndarray, shape (BEFORE + 9,)
        As `sits` keeps it.
    """

    memory: Array = field(default_factory=lambda: np.zeros(BEFORE + 9))

    def moved(self, c_nb: Array, tilt: float, lean: float, speed: float, rate: Array) -> Array | None:
        """What takes the axes of a box that was moved to those in which it sat; None while it sits as usual.

        Parameters
        ----------
        c_nb : ndarray, shape (3, 3)
        tilt, lean, speed, rate
            As for `sits`.

        Returns
        -------
        ndarray, shape (3, 3), or None
            Of a fast turn all of it; else the least one that brings the vertical back.
        """
        m = self.memory
        how = sits(m, c_nb, tilt, lean, speed, rate)
        if not how:
            return None
        m[LEANING] = 0.0
        before = m[BEFORE:].reshape(3, 3)
        return np.asarray(before.T @ c_nb) if how == 2 else between(c_nb[2], m[:3])

    def forget(self) -> None:
        """The filter began anew, in whatever axes the box has now."""
        self.memory[:] = 0.0

    def copy(self) -> Self:
        """An independent copy."""
        return type(self)(self.memory.copy())
