"""Text for whoever runs a command: for any encoding, without control characters, or for nobody at all."""

from __future__ import annotations

import codecs
import errno
import os
import re
import sys
from typing import Any, Final, TextIO

import click

from gapless.cli import interrupt
from gapless.errors import ConfigError

_STAND_INS: Final = {
    "\u00a0": " ", "\u202f": " ", "\u2009": " ", "\u2212": "-", "\u2013": "-", "\u2014": "-", "\u2026": "...",
    "\u2018": "'", "\u2019": "'", "\u201c": '"', "\u201d": '"', "·": "-", "±": "+/-", "°": " deg",
    "\u00d7": "x", "²": "^2", "³": "^3", "√": "sqrt", "\u03c3": "sigma", "χ": "chi", "µ": "u", "μ": "u",
    "≤": "<=", "≥": ">=", "→": "->", "≈": "~", "Δ": "d", "φ": "phi", "∞": "inf", "⁻": "^-", "¹": "1",
}  # fmt: skip
"""What is written where an encoding has no such character; "?" for all others."""
_CONTROL: Final = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
"""What moves the cursor, colours, hides or turns round what stands beside it, or is no character."""


def say(*lines: str, err: bool = False) -> None:
    """Print lines; whatever a name holds, each stays one line of plain characters.

    Parameters
    ----------
    *lines : str
    err : bool
        On stderr. One that cannot be written to says nothing and ends nothing.

    Raises
    ------
    ConfigError
        If stdout takes no more, for another reason than that its reader has gone: that ends the command
        quietly and well.
    """
    stream = sys.stderr if err else sys.stdout
    text = "\n".join(_CONTROL.sub("?", line) for line in lines)
    encoding = getattr(stream, "encoding", None) or "utf-8"
    try:
        click.echo(text.encode(encoding, _HANDLER).decode(encoding), err=err)
    except OSError as error:
        _silence(2 if err else 1)
        if err:
            return
        if error.errno == errno.EPIPE:
            raise click.exceptions.Exit(0) from None
        written = "; the files are written" * interrupt.is_late()
        raise ConfigError(f"standard output: {error.strerror or error}{written}") from None


def prepare() -> None:
    """Make sure of three open streams, and that any text can be written to them."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            _silence(number)
            setattr(sys, name, _opened(number))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors=_HANDLER)


def finish() -> None:
    """Leave nothing for the interpreter's end to complain about."""
    for number, stream in ((1, sys.stdout), (2, sys.stderr)):
        try:
            stream.flush()
        except (OSError, ValueError):
            _silence(number)


def _silence(number: int) -> None:
    """Connect a file descriptor to where everything vanishes."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    if nowhere != number:
        os.dup2(nowhere, number)
        os.close(nowhere)


def _opened(number: int) -> TextIO:
    return os.fdopen(number, "r" if number == 0 else "w", encoding="utf-8", closefd=False)


def _stand_in(error: UnicodeError) -> tuple[str | bytes, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    bad: Any = error.object[error.start : error.end]
    return "".join(_STAND_INS.get(c, "?") for c in bad), error.end


_HANDLER: Final = "gapless-stand-in"
codecs.register_error(_HANDLER, _stand_in)
