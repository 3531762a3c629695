"""Smoothed staircases as piecewise polynomials: what a driver commands, with exact derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_SMOOTHSTEP = np.array([0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0])
"""0 to 1 over 0..1, ascending powers; its first three derivatives vanish at both ends."""


@dataclass(frozen=True, eq=False)
class Piecewise:
    """A piecewise polynomial of time.

    Parameters
    ----------
    knots : ndarray, shape (m + 1,)
        Start of each piece and end of the last [s]; beyond the ends the outer pieces go on.
    coefficients : ndarray, shape (m, d + 1)
        Ascending powers of t - knots[j].
    """

    knots: Array
    coefficients: Array

    def __call__(self, t: ArrayLike) -> Array:
        """Values at given times.

        Parameters
        ----------
        t : array_like
            [s], any shape.

        Returns
        -------
        ndarray, of that shape
        """
        t = np.asarray(t, float)
        piece = np.clip(np.searchsorted(self.knots, t, "right") - 1, 0, len(self.knots) - 2)
        tau = t - self.knots[piece]
        value = np.zeros_like(t)
        for c in np.ascontiguousarray(self.coefficients.T)[::-1]:
            value = value * tau + c[piece]
        return value

    def derivative(self) -> Piecewise:
        """Its derivative by time, exactly.

        Returns
        -------
        Piecewise
        """
        powers = np.arange(1, self.coefficients.shape[1])
        return Piecewise(self.knots, self.coefficients[:, 1:] * powers)

    def antiderivative(self, initial: float) -> Piecewise:
        """Its integral over time, exactly.

        Parameters
        ----------
        initial : float
            Value at the first knot.

        Returns
        -------
        Piecewise
            Continuous.
        """
        rising = self.coefficients / np.arange(1, self.coefficients.shape[1] + 1)
        length = np.diff(self.knots)[:, None]
        grown = np.sum(rising * length ** np.arange(1, rising.shape[1] + 1), axis=1)
        start = initial + np.concatenate([[0.0], np.cumsum(grown)[:-1]])
        return Piecewise(self.knots, np.column_stack([start, rising]))


def staircase(durations: ArrayLike, values: ArrayLike, width: float) -> Piecewise:
    """Constant levels, one after another, with every corner rounded by a polynomial of seventh degree.

    A corner is symmetric about its time, so the integral over both neighbours is that of the sharp
    steps, and three times continuously differentiable.

    Parameters
    ----------
    durations : array_like, shape (k,)
        Of the levels [s], > 0.
    values : array_like, shape (k,)
        The levels.
    width : float
        How long a corner takes [s]; less where a neighbouring level is held for less.

    Returns
    -------
    Piecewise
    """
    durations, values = np.asarray(durations, float), np.asarray(values, float)
    corner = np.flatnonzero(np.diff(values))
    time = np.cumsum(durations)[corner]
    run = np.diff(time, prepend=0.0, append=np.sum(durations))
    span = np.minimum(width, np.minimum(run[:-1], run[1:]))
    knots = np.zeros(2 * len(corner) + 2)
    knots[1:-1:2], knots[2:-1:2], knots[-1] = time - span / 2.0, time + span / 2.0, np.sum(durations)
    coefficients = np.zeros((2 * len(corner) + 1, len(_SMOOTHSTEP)))
    coefficients[0, 0] = values[0]
    coefficients[2::2, 0] = values[corner + 1]
    rise = (values[corner + 1] - values[corner])[:, None]
    coefficients[1::2] = rise * _SMOOTHSTEP / span[:, None] ** np.arange(len(_SMOOTHSTEP))
    coefficients[1::2, 0] = values[corner]
    return Piecewise(np.maximum.accumulate(knots), coefficients)
