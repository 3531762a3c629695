"""Fixed-interval smoothing without an inverse: the adjoint filter of Bryson and Frazier.

The Rauch-Tung-Striebel smoother in Bierman's form (Bierman 1973; Bryson and Frazier 1963): what all
later observations say is carried backwards as a vector and a matrix,

    x_s = x - P lambda        P_s = P - P Lambda P

for filtered or predicted x and P alike. Nothing is inverted but the small S of each observation, so
states without noise or variance do no harm, and process noise need not be known: whatever was added to
P on the way is already in it. With a closed loop the estimate of the error is zero after each feedback
and the formulas hold as they stand: lambda never meets the nominal state.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from gapless.trip.recording import Array

ROUNDING: Final = 1e-8
"""Of a filter's variance: a smaller smoothed one is a difference of two numbers that are nearly equal,
and lost to rounding. Smoothed deviations are stated down to a ten-thousandth of the filter's."""


class Correction(NamedTuple):
    """One update, as it was done with its optimal gain.

    Parameters
    ----------
    h : ndarray, shape (m, n)
    gain : ndarray, shape (n, m)
        K = P H' S^-1.
    s : ndarray, shape (m, m)
        H P H' + R.
    z : ndarray, shape (m,)
        Innovation.
    """

    h: Array
    gain: Array
    s: Array
    z: Array


class Adjoint:
    """What everything later says about a moment, on its way back in time.

    Parameters
    ----------
    n : int
        Number of error states.
    """

    def __init__(self, n: int) -> None:
        self.vector = np.zeros(n)
        self.matrix = np.zeros((n, n))

    def through_step(self, phi: Array) -> None:
        """Back over x' = phi x + noise: lambda = phi' lambda', Lambda = phi' Lambda' phi.

        Parameters
        ----------
        phi : ndarray, shape (n, n)
            Rows of zeros forget what was known of a state.
        """
        self.vector = phi.T @ self.vector
        self.matrix = phi.T @ self.matrix @ phi

    def through_correction(self, c: Correction) -> None:
        """Back over an update (Bierman 1977, eq. X.5.10, written for any number of rows).

        lambda = (I - K H)' lambda' - H' S^-1 z, Lambda = (I - K H)' Lambda' (I - K H) + H' S^-1 H.

        Parameters
        ----------
        c : Correction
        """
        inverse = np.linalg.inv(c.s)
        seen = self.matrix @ c.gain
        core = c.gain.T @ seen + inverse
        cross = seen @ c.h
        self.vector = self.vector - c.h.T @ (c.gain.T @ self.vector + inverse @ c.z)
        whole = self.matrix - cross - cross.T + c.h.T @ core @ c.h
        self.matrix = 0.5 * (whole + whole.T)

    def smooth(self, p: Array) -> tuple[Array, Array]:
        """Correction of an estimate and its covariance by all that is later.

        Parameters
        ----------
        p : ndarray, shape (n, n)
            Of the filter.

        Returns
        -------
        dx : ndarray, shape (n,)
            To be injected.
        p_s : ndarray, shape (n, n)
        """
        smaller = p - p @ self.matrix @ p
        smaller = 0.5 * (smaller + smaller.T)
        np.fill_diagonal(smaller, np.maximum(np.diagonal(smaller), ROUNDING * np.diagonal(p)))
        return -(p @ self.vector), smaller
