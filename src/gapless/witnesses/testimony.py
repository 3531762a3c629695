"""One channel's standing: heard, silenced, or believed against the filter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple, Self

import numpy as np

from gapless.trip.recording import Array
from gapless.witnesses.increments import DOUBT, Increments, Slack

BRIEF: Final = 3.0
"""A spike is over as soon as a reading fits again; what lied for longer must show that it follows [s]."""
SETTLED: Final = 3.0
"""For so long must what was silenced have followed the motion before it is heard again [s]."""
FORGETS: Final = 10.0
"""After such a silence of its own a channel is heard like a new one [s]."""
REPEATS: Final = 2.0
"""A reading that is the same to the bit for so long is a copy, and has no noise of its own [s]."""
COPY_DOUBT: Final = 0.4
"""Deviations that are left to a copy's noise: what one step of a coarse grid hides."""
COPY_SHARE: Final = 0.15
"""Share of the slack that is left to a copy."""

Ruling = Literal["use", "silence", "believe"]


class Said(NamedTuple):
    """A reading as witnesses see it.

    Parameters
    ----------
    time : float
        [s]
    raw : ndarray
        As it was logged: bits that repeat are told by it.
    value : ndarray, shape (m,)
        Innovation plus corrections so far, so that differences are those against the inertial motion.
    var : ndarray, shape (m,)
        Of its noise.
    fits : bool
        Whether the filter would not be surprised by it.
    rests : bool
        Whether it says that the car stands where the filter drives.
    """

    time: float
    raw: Array
    value: Array
    var: Array
    fits: bool
    rests: bool = False


@dataclass
class Testimony:
    """Whether a channel is heard.

    Parameters
    ----------
    size : int
        Components of its readings that are compared.
    patience : float
        A channel that follows the motion but contradicts the filter is believed after this [s].
    silent : float
        Since when it is silenced [s]; inf while it is heard.
    follows : float
        Since when a silenced channel has followed the motion [s].
    """

    size: int
    patience: float
    silent: float = math.inf
    follows: float = -math.inf
    since: float = -math.inf
    raw: Array = field(default_factory=lambda: np.zeros(0))
    told: bool = False
    past: Increments = field(default_factory=lambda: Increments(0))

    def __post_init__(self) -> None:
        if self.past.size != self.size:
            self.past = Increments(self.size)

    @property
    def heard(self) -> bool:
        """Whether it is not silenced."""
        return self.silent == math.inf

    def following(self, time: float) -> bool:
        """Whether it has followed the motion for a while, heard or not."""
        return self.heard or time - self.follows >= SETTLED

    def hear(self, said: Said, slack: Slack, contradicted: bool) -> Ruling:
        """Rule on a reading.

        Parameters
        ----------
        said : Said
        slack : Slack
            Left to the filter.
        contradicted : bool
            Whether others are with the filter: then it is not believed however long it insists.

        Returns
        -------
        str
            "use", "silence" or "believe": the filter is what is wrong.
        """
        if said.time - self.past.last > FORGETS:
            self.__init__(self.size, self.patience)  # type: ignore[misc]
        odd = self._odd(said, slack)
        if self.heard:
            if odd:
                self.silent = self.follows = said.time
                self.past.forget()
            self.past.keep(said.time, said.value, said.var)
            return "silence" if odd else "use"
        if odd or said.rests or said.time - self.since >= REPEATS:  # a copy follows nothing
            self.follows = said.time
            self.past.forget()
        self.past.keep(said.time, said.value, said.var)
        return self._again(said, contradicted)

    def _odd(self, said: Said, slack: Slack) -> bool:
        """Whether it did not change as was felt."""
        if self.raw.shape != said.raw.shape or (said.raw != self.raw).any():
            self.since = said.time
        self.raw = said.raw
        doubt = DOUBT
        if said.time - self.since >= REPEATS:
            doubt, slack = COPY_DOUBT, Slack(COPY_SHARE * slack.rate, COPY_SHARE * slack.bend)
        return self.past.excess(said.time, said.value, said.var, slack, doubt) > 1.0

    def _again(self, said: Said, contradicted: bool) -> Ruling:
        """Whether a silenced channel is heard again."""
        lasted, followed = said.time - self.silent, said.time - self.follows
        if said.fits and (lasted < BRIEF or followed >= SETTLED):
            self.silent = math.inf
            return "use"
        late = self.follows - self.silent > BRIEF  # it was led astray meanwhile: the way back is short
        if followed >= (SETTLED if late else self.patience) and not contradicted:
            self.silent = math.inf
            return "believe"
        return "silence"

    def copy(self) -> Self:
        """An independent copy."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        new.past = self.past.copy()
        return new
