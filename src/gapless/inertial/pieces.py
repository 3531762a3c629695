"""Samples in pieces: cut at holes in the log, and inside a sample wherever a reading waits."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gapless._numba import kernel
from gapless.inertial import propagate as at
from gapless.inertial.increments import split
from gapless.trip.events import EPS, ImuBlock, Reading
from gapless.trip.recording import Array


class Piece(NamedTuple):
    """Samples first..last-1 of a block, none of them if a reading waits at the instant before.

    Parameters
    ----------
    block : ImuBlock
    first, last : int
    due : bool
        Whether a reading waits at the end.
    """

    block: ImuBlock
    first: int
    last: int
    due: bool


def without_holes(block: ImuBlock) -> Iterator[ImuBlock]:
    """The stretches of a block that have no hole inside.

    Parameters
    ----------
    block : ImuBlock

    Yields
    ------
    ImuBlock
    """
    holes = np.flatnonzero(_silence(block)) + 1
    if not len(holes):
        yield block
        return
    for first, last in pairwise([0, *holes.tolist(), len(block.time)]):
        yield block.rows(first, last)


def parted(clock: float, block: ImuBlock) -> float:
    """How long the IMU was silent before a block.

    Parameters
    ----------
    clock : float
        When the sample before it ended [s].
    block : ImuBlock

    Returns
    -------
    float
        [s]; 0 where nothing is missing: half an interval is the stamps' own.
    """
    silent = float(block.time[0] - block.dt[0]) - clock
    return silent if silent > 0.5 * float(block.dt[0]) else 0.0


def _silence(block: ImuBlock) -> NDArray[np.bool_]:
    """Whether something is missing before each sample but the first; as `parted`."""
    return np.asarray(block.time[1:] - block.dt[1:] - block.time[:-1] > 0.5 * block.dt[1:])


def pieces(block: ImuBlock, pending: Sequence[Reading], memory: Callable[[], Array]) -> Iterator[Piece]:
    """A block in pieces that end where readings are due.

    Parameters
    ----------
    block : ImuBlock
        Without holes.
    pending : sequence of Reading
        In the order of their times; looked at anew after each piece, for whoever takes the pieces
        takes the readings too.
    memory : callable
        What the sample before a cut left behind, as `propagate` keeps it and the sensors felt it.

    Yields
    ------
    Piece
    """
    start, n = 0, len(block.time)
    while start < n:
        if not pending or pending[0].time > block.time[-1] + EPS:
            yield Piece(block, start, n, False)
            return
        due = pending[0].time
        end = int(np.searchsorted(block.time, due + EPS, side="right"))
        if end > start:
            yield Piece(block, start, end, due <= block.time[end - 1] + EPS)
            start = end
            continue
        part = float(block.dt[start]) - (float(block.time[start]) - due)
        if part <= EPS:  # it holds for the instant before the sample began
            yield Piece(block, start, start, True)
            continue
        head, tail = _cut(block.rows(start, start + 1), due, part, memory())
        yield Piece(head, 0, 1, True)
        yield from pieces(tail, pending, memory)
        start += 1


def _cut(sample: ImuBlock, due: float, part: float, memory: Array) -> tuple[ImuBlock, ImuBlock]:
    """One sample as two, the first of length `part`."""
    first, rest = _halves(sample.dt, sample.dtheta, sample.dvel, memory, part)
    head = ImuBlock(np.full(1, due), first[0, :1], first[1:2], first[2:])
    return head, ImuBlock(sample.time, rest[0, :1], rest[1:2], rest[2:])


@kernel
def _halves(dt: Array, dtheta: Array, dvel: Array, memory: Array, part: float) -> tuple[Array, Array]:
    """Rows: length of the interval (repeated), dtheta, dvel; of the first part and of the rest."""
    first, rest, now = np.empty((3, 3)), np.empty((3, 3)), dt[0]
    before = memory[at.PREV_DT]
    first[0], rest[0] = part, now - part
    first[1] = split(dtheta[0], memory[at.PREV_THETA : at.PREV_THETA + 3], before, now, part)
    first[2] = split(dvel[0], memory[at.PREV_VEL : at.PREV_VEL + 3], before, now, part)
    rest[1], rest[2] = dtheta[0] - first[1], dvel[0] - first[2]
    return first, rest
