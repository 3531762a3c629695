"""One channel's standing: heard, silenced, or believed against the filter."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple, Self

import numpy as np

from gapless.trip.recording import Array
from gapless.witnesses.increments import APART, DOUBT, Increments, Slack

BRIEF: Final = 3.0
"""A spike is over as soon as a reading fits again; what lied for longer must show that it follows [s]."""
SETTLED: Final = 3.0
"""For so long must what was silenced have followed the motion before it is heard again [s]."""
FORGETS: Final = 10.0
"""After such a silence of its own a channel is heard like a new one [s]."""
LEAPS: Final = 0.4
"""What is beyond what is allowed at once, and was less before, has leapt."""
UNNOTICED: Final = 3.0
"""A lie goes unnoticed for so long at least [s]."""
RETURNED: Final = 8.0
"""So long after it came back a channel has just come back [s]."""
MANY, ALIVE = 10, 1.0
"""No velocity beyond the second [m/s] is the same to the bit so often: noise is in it."""
REPEATS: Final = 2.0
"""A reading that is the same to the bit for so long is a copy, and has no noise of its own [s]."""
COPY_DOUBT: Final = 0.4
"""Deviations that are left to a copy's noise: what one step of a coarse grid hides."""
COPY_SHARE: Final = 0.15
"""Share of the slack that is left to a copy."""

INSISTS: Final = 2.5
"""What follows the motion and surprises the filter for so long, without a break, is right [s]."""
GROWS: Final = 2.5
"""What a force that was none does to the surprises of a velocity, while they are believed [1]."""
KNOWN: Final = 2.0
"""By so much longer for each time that it was silenced: a receiver that lied before may do so again."""
WANES: Final = 0.6
"""Below this share of the largest surprise of its kind, it passes."""
OFTEN: Final = 3
"""So many readings at least make that."""

Ruling = Literal["use", "silence", "believe", "turn"]


class Said(NamedTuple):
    """A reading as witnesses see it.

    Parameters
    ----------
    time : float
        [s]
    logged : ndarray
        As it was logged: bits that repeat are told by it.
    raw : ndarray, shape (m,)
        The same in the unit of the innovation.
    value : ndarray, shape (m,)
        Innovation plus corrections so far, so that differences are those against the inertial motion.
    var : ndarray, shape (m,)
        Of its noise.
    fits : bool
        Whether the filter would not be surprised by it.
    nis : float
        How surprised it is: z' S^-1 z.
    rests : bool
        Whether it says that the car stands where the filter drives.
    """

    time: float
    logged: Array
    raw: Array
    value: Array
    var: Array
    fits: bool
    nis: float
    rests: bool = False

    @property
    def compared(self) -> tuple[float, Array, Array, Array]:
        """What `Increments` compare."""
        return self.time, self.value, self.raw, self.var


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
    since : float
        Since when it has repeated itself to the bit [s].
    excess : float
        Of its last reading from what was felt, over what is allowed.
    lying : float
        Since when what it said is not to be trusted, if it is silenced [s].
    repeats : int
        How often in a row.
    lies : int
        How often it was silenced.
    surprises, surprised, worst, first : int, float, float, float
        Surprising readings in a row, since when [s], the largest z' S^-1 z of them, and the first.
    began : float
        When it spoke first, or again after it had long not spoken [s].
    returned : bool
        Whether it had spoken before that.
    insisted : float
        For how long it had surprised the filter when it was believed against it last [s].
    proved : float
        When it last followed a motion while that was in doubt [s].
    logged : ndarray
        Its last reading.
    past : Increments
    """

    size: int
    patience: float
    silent: float = math.inf
    follows: float = -math.inf
    since: float = -math.inf
    excess: float = 0.0
    lying: float = math.inf
    repeats: int = 0
    lies: int = 0
    surprises: int = 0
    surprised: float = math.inf
    worst: float = 0.0
    first: float = 0.0
    insisted: float = 0.0
    began: float = -math.inf
    returned: bool = False
    proved: float = -math.inf
    logged: Array = field(default_factory=lambda: np.zeros(0))
    past: Increments = field(default_factory=lambda: Increments(0))

    def __post_init__(self) -> None:
        if self.past.size != self.size:
            self.past = Increments(self.size)

    @property
    def heard(self) -> bool:
        """Whether it is not silenced."""
        return self.silent == math.inf

    def copies(self, time: float) -> bool:
        """Whether it repeats itself to the bit."""
        return time - self.since >= REPEATS

    def following(self, time: float) -> bool:
        """Whether it has followed the motion for a while, heard or not."""
        return self.heard or time - self.follows >= SETTLED

    def needless(self, time: float, logged: Array) -> bool:
        """Whether a reading that fits need not be held against others: one was, a moment ago.

        Parameters
        ----------
        time : float
            [s]
        logged : ndarray
            As it was logged.

        Returns
        -------
        bool
            Never while the channel is silenced, or repeats itself.
        """
        if not self.heard or time - self.past.last >= APART or np.array_equal(logged, self.logged):
            return False
        self.logged, self.since, self.repeats = logged, time, 1
        self.surprises, self.surprised, self.worst = 0, time, 0.0
        return True

    def leapt(self, nis: float) -> bool:
        """Whether its surprises began as large as they are: what was felt wrongly grows.

        Parameters
        ----------
        nis : float
            z' S^-1 z now.

        Returns
        -------
        bool
        """
        return self.surprises > 0 and nis < GROWS * self.first

    def returning(self, time: float) -> bool:
        """Whether it has just come back from a silence of its own.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        if time - self.past.last > FORGETS:
            return self.past.n > 0
        return self.returned and time - self.began < RETURNED

    def silence(self, time: float) -> Ruling:
        """What it says now is known for a lie.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        str
            "silence".
        """
        if self.heard:
            self.silent = self.follows = self.lying = time
        return "silence"

    def _lied_since(self, said: Said, odd: bool, accused: bool, before: float) -> float:
        """Since when what it said is not to be trusted.

        From where it began to repeat itself, or from a while before it was found out; all, if it had just
        come back. What leaps was true until then, and what is suspected need not lie.
        """
        if said.time - self.began < RETURNED:
            return self.began
        if self.copies(said.time):
            return self.since
        unnoticed = accused or (odd and before > LEAPS)
        return said.time - UNNOTICED if unnoticed else said.time

    def hear(
        self,
        said: Said,
        slack: Slack,
        denied: bool = False,
        contradicted: bool = False,
        accused: bool = False,
        suspected: float = math.inf,
    ) -> Ruling:
        """Rule on a reading.

        Parameters
        ----------
        said : Said
        slack : Slack
            Left to the filter.
        denied, contradicted : bool
            Whether others are with the filter: one that is heard and insists is then silenced, not believed;
            one that was silenced is not believed however long it insists.
        accused : bool
            Whether it tells the story of a channel that lied.
        suspected : float
            Since when the other channel of the same receiver has been silenced [s]: it is not heard before
            it has followed some motion since.

        Returns
        -------
        str
            "use", "silence" or "believe": the filter is what is wrong.
        """
        if said.time - self.past.last > FORGETS:
            spoke = self.past.n > 0
            fresh = type(self)(self.size, self.patience, lies=self.lies, began=said.time, returned=spoke)
            vars(self).update(vars(fresh))
        before = self.excess
        odd = self._odd(said, slack) or accused
        if odd:
            self.past.forget()
        elif not self.heard or suspected < math.inf:
            since = self.follows if suspected == math.inf else max(suspected, self.follows)
            if self.proved < since and self.past.moved(*said.compared, slack, since):
                self.proved = said.time
        unproved = suspected < math.inf and self.proved < suspected
        self.past.keep(*said.compared)
        if self.heard:
            if odd or unproved:
                self.silent = self.follows = said.time
                self.lying = self._lied_since(said, odd, accused, before)
                self.lies += odd
            return "silence" if odd or unproved else self._insists(said, denied)
        if odd or said.rests or self.copies(said.time):  # a copy follows nothing
            self.follows = said.time
        return "silence" if accused or unproved or self._dead(said) else self._again(said, contradicted)

    def _odd(self, said: Said, slack: Slack) -> bool:
        """Whether it did not change as was felt."""
        if self.logged.shape != said.logged.shape or (said.logged != self.logged).any():
            self.since, self.repeats = said.time, 0
        self.logged, self.repeats = said.logged, self.repeats + 1
        doubt = DOUBT
        if self.copies(said.time):
            if not said.fits or self._dead(said):
                return True
            doubt, slack = COPY_DOUBT, Slack(COPY_SHARE * slack.rate, COPY_SHARE * slack.bend)
        self.excess = self.past.excess(*said.compared, slack, doubt)
        return self.excess > 1.0

    def _dead(self, said: Said) -> bool:
        """Whether it is a velocity that has repeated itself for too often."""
        many = self.size == 2 and self.repeats > MANY and self.copies(said.time)
        return many and float(np.hypot(*said.logged[:2])) > ALIVE

    def _insists(self, said: Said, denied: bool) -> Ruling:
        """Whether a channel that is heard has surprised the filter for too long to be an accident."""
        if said.fits or self.surprised == math.inf:
            self.surprises, self.surprised, self.worst = 0, said.time, 0.0
            return "use"
        self.first = said.nis if self.surprises == 0 else self.first
        self.surprises, self.worst = self.surprises + 1, max(self.worst, said.nis)
        patience = INSISTS * (1.0 + KNOWN * min(self.lies, 5))
        if self.surprises < OFTEN or said.time - self.surprised < patience:
            return "use"
        if (
            self.returning(said.time) or said.nis < WANES * self.worst
        ):  # a receiver's mistake passes, a filter's does not by itself
            return "use"
        self.insisted = said.time - self.surprised
        self.surprises, self.surprised, self.worst = 0, said.time, 0.0
        if denied:
            self.silent = self.follows = said.time
            self.lying = said.time - self.insisted
            self.lies += 1
            return "silence"
        return "believe"

    def _again(self, said: Said, contradicted: bool) -> Ruling:
        """Whether a silenced channel is heard again."""
        lasted, followed = said.time - self.silent, said.time - self.follows
        if said.fits and (lasted < BRIEF or followed >= SETTLED):
            self.silent = math.inf
            return "use"
        late = self.follows - self.silent > BRIEF  # it was led astray meanwhile: the way back is short
        enough = followed >= (SETTLED if late else self.patience) and self.proved > self.follows
        if enough and not contradicted:
            self.silent, self.insisted = math.inf, lasted
            return "believe"
        return "silence"

    def copy(self) -> Self:
        """An independent copy."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        new.past = self.past.copy()
        return new
