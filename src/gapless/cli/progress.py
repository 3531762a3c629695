"""How far a run has got, for people who watch it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click


@contextmanager
def progress(label: str, duration: float) -> Iterator[Callable[[float], None] | None]:
    """A bar on stderr where that is a terminal.

    Parameters
    ----------
    label : str
    duration : float
        What 100 % is [s of the recording].

    Yields
    ------
    callable or None
        To be told the time that was reached [s]; None where nobody watches.
    """
    if not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=max(1, round(duration)), label=label, file=sys.stderr, width=30) as bar:
        yield lambda reached: bar.update(round(reached) - bar.pos)
        bar.update(bar.length - bar.pos if bar.length else 0)
