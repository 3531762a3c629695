"""The recent past of a navigator: for readings that come late, and for those that should not have been."""

from __future__ import annotations

from typing import Final

from gapless.fold.state import State
from gapless.trip.events import EPS, Event, ImuBlock, Reading

REACH: Final = 0.5
"""So much longer than `lateness` is the last part of a long block [s]."""
SPARSE: Final = 1.0
"""Least time between states that are kept for longer than readings are late [s]."""


class Past:
    """States before each recent block, and what was fed since: enough to put a late reading in its place.

    Parameters
    ----------
    lateness : float
        How far back readings reach [s]; at least the last block is kept.
    memory : float
        How far back what a liar said is taken back [s]. Beyond `lateness` states are `SPARSE` apart.
    """

    def __init__(self, lateness: float, memory: float = 0.0) -> None:
        self.lateness, self.memory = lateness, max(memory, lateness)
        self.entries: list[tuple[State, list[Event]]] = []

    def parts(self, block: ImuBlock) -> tuple[ImuBlock, ...]:
        """A long block in two: what late readings reach need not be run again together with all before it.

        Parameters
        ----------
        block : ImuBlock

        Returns
        -------
        tuple of ImuBlock
        """
        end = int(block.time.searchsorted(block.time[-1] - self.lateness - REACH))
        if end == 0 or block.time[end] - block.time[0] < REACH:
            return (block,)
        return block.rows(0, end), block.rows(end, len(block.time))

    def before(self, state: State, block: ImuBlock) -> None:
        """Keep the state before a block, and the block.

        Parameters
        ----------
        state : State
            A copy, which nobody else will change.
        block : ImuBlock
        """
        self.entries.append((state, [block]))
        while len(self.entries) > 1 and self.entries[1][0].clock < state.clock - self.memory:
            self.entries.pop(0)
        self._thin(state.clock - self.lateness)

    def _thin(self, before: float) -> None:
        """Of states that no late reading goes back to, keep few: the last that went out of reach, if far."""
        k = len(self.entries) - 1
        while k > 0 and self.entries[k][0].clock >= before:
            k -= 1
        if k > 0 and self.entries[k][0].clock - self.entries[k - 1][0].clock < SPARSE:
            self.entries[k - 1][1].extend(self.entries.pop(k)[1])

    def heard(self, readings: tuple[Reading, ...]) -> None:
        """Keep readings with the latest block.

        Parameters
        ----------
        readings : tuple of Reading
        """
        if self.entries:
            oldest = self.entries[0][0].clock
            kept = tuple(r for r in readings if r.time > oldest)
            if kept:
                self.entries[-1][1].append(kept)

    def rewind(self, time: float) -> tuple[State, list[Event]] | None:
        """The latest state kept from before a time, and all that was fed after it.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        (State, list of Event) or None
            None where the time is beyond what is kept. What is returned is forgotten.
        """
        k = len(self.entries) - 1
        while k >= 0 and self.entries[k][0].clock >= time:
            k -= 1
        if k < 0:
            return None
        state, events = self.entries[k][0], [e for _, fed in self.entries[k:] for e in fed]
        del self.entries[k:]
        return state, events

    def back(self, time: float) -> tuple[State, list[Event]]:
        """As `rewind`, but never in vain: as far back as there is.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        (State, list of Event)
        """
        found = self.rewind(max(time, self.entries[0][0].clock + EPS))
        assert found is not None
        return found

    def copy(self) -> Past:
        """An independent copy; states are never changed once kept, so they are shared.

        Returns
        -------
        Past
        """
        new = Past(self.lateness, self.memory)
        new.entries = [(state, list(events)) for state, events in self.entries]
        return new


def sorted_out(fed: list[Event], late: tuple[Reading, ...]) -> tuple[list[ImuBlock], tuple[Reading, ...]]:
    """Blocks, and all readings that were fed or came late.

    Parameters
    ----------
    fed : list of Event
    late : tuple of Reading

    Returns
    -------
    (list of ImuBlock, tuple of Reading)
    """
    blocks = [event for event in fed if isinstance(event, ImuBlock)]
    return blocks, (*(r for event in fed if not isinstance(event, ImuBlock) for r in event), *late)
