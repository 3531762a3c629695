"""The replay of a stretch in several manners, a slice at a time: no live sample waits for all of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Final, NamedTuple

from gapless.fold.manner import Manner
from gapless.fold.navigator import Navigator
from gapless.rehearsal.judge import Rehearsed, Trial
from gapless.rehearsal.stretch import Stretch
from gapless.trip.events import Event, ImuBlock

ROWS: Final = 1.0
"""Rows of a replay are so far apart [s]: what is looked for is how far it went astray in a minute."""


class Attempt(NamedTuple):
    """One candidate, as it is tried.

    Parameters
    ----------
    bridge, preset : str
        As in `Trial`.
    manner : Manner
    """

    bridge: str
    preset: str
    manner: Manner


class Replay:
    """Copies of the navigator that go through a stretch without GNSS, one after the other.

    Parameters
    ----------
    stretch : Stretch
        Not changed any more.
    attempts : sequence of Attempt
    end : float
        Of the stretch [s].

    Attributes
    ----------
    cost : int
        Samples to be replayed in all.
    """

    def __init__(self, stretch: Stretch, attempts: Sequence[Attempt], end: float) -> None:
        self.stretch, self.attempts, self.end = stretch, tuple(attempts), end
        self.cost = stretch.samples * len(self.attempts)
        self.trials: list[Trial] = []
        self.done = 0
        self._left: list[Event] = []
        self._navigator: Navigator | None = None

    @cached_property
    def _script(self) -> list[Event]:
        return self.stretch.script()

    def advance(self, share: float) -> None:
        """Go on until some share of all samples has been replayed.

        Parameters
        ----------
        share : float
            0 to 1.
        """
        wanted = round(share * self.cost)
        while self.done < wanted:
            self.done += self._slice(wanted - self.done)
            if not self._left:
                self._judge()

    def finish(self) -> Rehearsed:
        """Replay what is left.

        Returns
        -------
        Rehearsed
        """
        self.advance(1.0)
        return Rehearsed(self.stretch.start, self.end, tuple(self.trials))

    def copy(self) -> Replay:
        """One that begins anew: it ends in the same bits.

        Returns
        -------
        Replay
        """
        return Replay(self.stretch, self.attempts, self.end)

    def _slice(self, most: int) -> int:
        """Step so many samples at most, and the readings that follow them; how many they were."""
        if self._navigator is None:
            self._navigator, self._left = self.stretch.navigator.fork(), list(self._script)
            self._navigator.settings = replace(self._navigator.settings, row=ROWS)
            self._navigator.adopt(self.attempts[len(self.trials)].manner)
            self._navigator.keeps_learning = False
        taken = 0
        while self._left and (taken == 0 or not isinstance(self._left[0], ImuBlock)):
            event = self._left.pop(0)
            if isinstance(event, ImuBlock):
                taken = min(len(event.time), most)
                if taken < len(event.time):
                    self._left.insert(0, event.rows(taken, len(event.time)))
                event = event.rows(0, taken)
            self._navigator.step(event)
        return taken

    def _judge(self) -> None:
        assert self._navigator is not None
        who = self.attempts[len(self.trials)]
        apart = self.stretch.apart(self._navigator.journal.trajectory())
        self.trials.append(Trial(who.bridge, who.preset, *apart))
        self._navigator = None
