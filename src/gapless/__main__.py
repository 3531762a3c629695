"""The process `gapless`, and `python -m gapless`: the command line, deaf to nothing while it loads."""

from __future__ import annotations

import os
import signal
from typing import Any


def main() -> None:
    """Run the command line; a Ctrl-C while it is still loading ends it in one line, as later on."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _leave)

    from gapless.cli import main as run

    run()


def _leave(number: int, frame: Any) -> None:
    """As `gapless.cli.interrupt.leave_at_once`, which is not loaded yet."""
    try:
        os.write(2, b"gapless: interrupted; no file was changed\n")
    finally:
        os._exit(130)


if __name__ == "__main__":
    main()
