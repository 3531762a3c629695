"""The manner of a navigator: what may change on its way; all else is settled before it starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gapless.measurements.base import Constraint
from gapless.trip.recording import Array


@dataclass(frozen=True)
class Manner:
    """What of a navigator may change on its way, as rehearsals advise.

    Parameters
    ----------
    noise : ndarray, shape (7,)
        Process noise.
    constraints : mapping of str to Constraint
        Those whose parameters count; what they remember does not.
    voices : tuple of int
        Which bridges are listened to.
    scale : float
        Factor on the covariance of positions that is stated while GNSS is silent.
    """

    noise: Array
    constraints: Mapping[str, Constraint]
    voices: tuple[int, ...]
    scale: float = 1.0
