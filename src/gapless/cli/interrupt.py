"""Ctrl-C: heard at any moment, and for no longer than it can change anything.

A `KeyboardInterrupt` that meets compiled code can turn into another error there, or be lost: so the
signal is remembered beside being raised, and whatever ends a verb afterwards is the interrupt's doing.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

from click.exceptions import Exit

INTERRUPTED: Final = 130
"""Exit code after Ctrl-C, as shells have it: 128 + SIGINT."""
UNCHANGED: Final = "interrupted; no file was changed"
_SOON: Final = 0.02
"""After so long [s] an interrupt is raised again that could not be raised where it came."""

_heard = _late = False


def leave_at_once(number: int, frame: Any) -> None:
    """Answer a Ctrl-C that comes before a verb has begun: there is nothing to tidy up.

    Parameters
    ----------
    number : int
    frame : object
    """
    try:
        os.write(2, f"gapless: {UNCHANGED}\n".encode())
    finally:
        os._exit(INTERRUPTED)


def prepare() -> None:
    """Leave at once from here on, if this process hears Ctrl-C at all."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, leave_at_once)


@contextmanager
def listening() -> Iterator[None]:
    """Raise `KeyboardInterrupt` while a verb works; hear nothing more once it has ended.

    Only a process that was prepared for it is changed, and not one that something else runs.

    Yields
    ------
    None
    """
    global _heard, _late
    _heard = _late = False
    if signal.getsignal(signal.SIGINT) is not leave_at_once:
        yield
        return
    sys.unraisablehook = _unraisable
    signal.signal(signal.SIGINT, _answer)
    try:
        with plainly():
            yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def plainly() -> Iterator[None]:
    """Make an interrupt of whatever an interrupt has become on its way.

    Yields
    ------
    None

    Raises
    ------
    KeyboardInterrupt
    """
    try:
        yield
    except Exit:  # it was answered already
        raise
    except Exception:
        check()
        raise


def check() -> None:
    """Raise the interrupt that something swallowed.

    Raises
    ------
    KeyboardInterrupt
    """
    if _heard:
        raise KeyboardInterrupt


def too_late() -> None:
    """Hear nothing from here on: the files of this run are there."""
    global _late
    _late = True


def is_late() -> bool:
    """Whether the files of this run are there.

    Returns
    -------
    bool
    """
    return _late


def _answer(number: int, frame: Any) -> None:
    global _heard
    if not _late:
        _heard = True
        raise KeyboardInterrupt


def _unraisable(event: Any) -> None:
    """An interrupt met a destructor or the like, where nothing can be raised."""
    if isinstance(event.exc_value, KeyboardInterrupt):
        again = threading.Timer(_SOON, signal.raise_signal, (signal.SIGINT,))
        again.daemon = True
        again.start()
    elif not _heard:
        sys.__unraisablehook__(event)
