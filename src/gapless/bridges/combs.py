"""The comb at a speed: what all speeds have in common, and by how much this one is known to differ.

Lines of an engine are where its gear puts them, and a gear is driven at certain speeds; the wheels' own
grow and fade as they pass resonances of the car. So there is not one comb but one at each speed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from gapless.bridges.comb import DOUBT, Memory, shrunk, without_trend
from gapless.bridges.knots import shares
from gapless.bridges.template import Comb
from gapless.trip.recording import Array


@dataclass(frozen=True, eq=False)
class Combs:
    """The combs of a car.

    Parameters
    ----------
    common : Comb
        Of all speeds.
    others : ndarray, shape (knots, 6, orders)
        Heights at the knots less the common ones, shrunk by their standard errors.
    """

    common: Comb
    others: Array

    @classmethod
    def of(cls, memory: Memory) -> Self:
        """What a memory tells.

        Parameters
        ----------
        memory : Memory

        Returns
        -------
        Combs
        """
        left = memory.left()
        count, raw = left.common()
        seen = (left.count + DOUBT)[:, None, :]
        own = (left.total + DOUBT * raw) / seen  # unseen, it is the common one
        own = without_trend(own.reshape(-1, own.shape[-1])).reshape(own.shape)
        others = shrunk(own - raw, left.variance[:, None] / seen)
        return cls(left.comb(count, raw), others)

    def at(self, speed: float) -> Comb:
        """The comb at a speed.

        Parameters
        ----------
        speed : float
            [m/s]

        Returns
        -------
        Comb
        """
        here = np.tensordot(shares(np.array([speed]))[0], self.others, axes=1)
        return replace(self.common, height=self.common.height + here)
