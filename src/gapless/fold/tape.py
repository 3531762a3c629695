"""What a smoother must know of the way forward: each step, each correction, each row, in order."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gapless.filters.smoother import Correction
from gapless.inertial.belief import Belief
from gapless.inertial.layout import NAV, ROW, Layout
from gapless.trip.recording import Array


class Row(NamedTuple):
    """A row of the journal with all of its covariance.

    Parameters
    ----------
    time : float
        [s]
    x : ndarray, shape (n + 1,)
        Nominal state.
    p : ndarray, shape (n, n)
    shared : ndarray, shape (3, 3)
        As the journal takes it.
    source : str
    """

    time: float
    x: Array
    p: Array
    shared: Array
    source: str


Entry = Array | Correction | Row
"""A transition matrix, an update or a row."""


class Tape:
    """Records a navigator at work; one that starts anew records nothing of what went before.

    Parameters
    ----------
    layout : Layout
    """

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.entries: list[Entry] = []

    def stepped(self, belief: Belief) -> None:
        """Take the transition of the covariance step that was just made.

        Parameters
        ----------
        belief : Belief
            Its working space still holds the transition.
        """
        n, kept = self.layout.n, belief.scratch[1]
        phi = np.diag(kept[NAV * ROW : NAV * ROW + n])
        phi[:NAV] = kept[: NAV * ROW].reshape(NAV, ROW)[:, :n]
        self.entries.append(phi)

    def corrected(self, h: Array, hp: Array, s: Array, z: Array) -> None:
        """Take an update, before it is made.

        Parameters
        ----------
        h, hp : ndarray, shape (m, n)
            H and H P.
        s : ndarray, shape (m, m)
        z : ndarray, shape (m,)
        """
        gain = np.asarray(np.linalg.solve(s, hp).T, float)
        self.entries.append(Correction(h, gain, s, z))

    def forgot(self, everything: bool, course: bool = False) -> None:
        """Note that position, velocity and attitude start anew.

        Parameters
        ----------
        everything : bool
            All other states too.
        course : bool
            The heading is a course less the mounting yaw, and shares its error.
        """
        phi = np.zeros(2 * (self.layout.n,)) if everything else np.eye(self.layout.n)
        phi[:NAV] = 0.0
        if course and not everything and "mounting" in self.layout:
            phi[NAV - 1, self.layout.blocks["mounting"].start + 1] = -1.0
        self.entries.append(phi)

    def missed(self, silence: float) -> None:
        """Note that the IMU was silent for long: positions went on with the velocity.

        Parameters
        ----------
        silence : float
            [s]
        """
        phi = np.eye(self.layout.n)
        phi[:3, 3:6] = silence * np.eye(3)
        self.entries.append(phi)

    def row(self, time: float, belief: Belief, shared: Array, source: str) -> None:
        """Take a row.

        Parameters
        ----------
        time : float
        belief : Belief
        shared : ndarray, shape (3, 3)
        source : str
        """
        self.entries.append(Row(time, belief.x.copy(), belief.P.copy(), shared, source))
