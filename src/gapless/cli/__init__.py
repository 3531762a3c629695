"""The command line: one file per verb, and nothing heavy imported before a verb runs."""

from __future__ import annotations

import gc
import sys
from typing import Any

import click

from gapless.cli import interrupt, screen
from gapless.cli.bench import bench
from gapless.cli.convert import convert
from gapless.cli.fuse import fuse
from gapless.cli.inspect import inspect
from gapless.cli.report import report
from gapless.cli.reproduce import reproduce
from gapless.cli.simulate import simulate
from gapless.cli.sweep import sweep
from gapless.cli.systems import systems
from gapless.errors import GaplessError
from gapless.version import __version__

REFUSED = 2
"""Exit code where the input, the options or the disk cannot serve."""


class Verbs(click.Group):
    """A group of verbs that ends in one line, not in a traceback, where a user can mend it."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Verbs in the order in which one needs them, not of the alphabet.

        Parameters
        ----------
        ctx : click.Context

        Returns
        -------
        list of str
        """
        return list(self.commands)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a verb; turn what it refuses into a line on stderr and an exit code.

        Parameters
        ----------
        ctx : click.Context

        Returns
        -------
        object
            What the verb returns.
        """
        try:
            with interrupt.listening():
                return super().invoke(ctx)
        except GaplessError as error:
            _leave(ctx, str(error), REFUSED)
        except OSError as error:
            named = f"{error.filename}: " if error.filename else ""
            _leave(ctx, f"{named}{error.strerror or error}", REFUSED)
        except KeyboardInterrupt:
            _leave(ctx, interrupt.UNCHANGED, interrupt.INTERRUPTED)


def _leave(ctx: click.Context, line: str, code: int) -> None:
    screen.say(f"gapless: {' '.join(line.split())}", err=True)
    ctx.exit(code)


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 80})
@click.version_option(__version__, message="%(prog)s %(version)s")
def gapless() -> None:
    """Fuse an IMU with GNSS, and keep navigating when GNSS goes silent.

    A first try, without data of your own:

    \b
      gapless simulate --out drive
      gapless inspect drive
      gapless fuse drive --outage 240:300 --out solution
    """  # noqa: D301 - click's mark for lines that stay as they are, not a backslash


for _verb in (inspect, fuse, systems, bench, reproduce, report, simulate, convert, sweep):
    gapless.add_command(_verb)


def main() -> None:
    """Run the process `gapless`, sparing it what only a longer life would need.

    numba imports scipy.linalg wherever it finds it, 0.13 s, for matrix products that no kernel of
    ours uses; nothing else in this process wants it, so it is not found. A run leaves no cycles worth
    collecting, neither on its way nor at its end: 0.25 s of two.
    """
    interrupt.prepare()
    screen.prepare()
    sys.modules.setdefault("scipy", None)  # type: ignore[arg-type]
    gc.disable()
    try:
        gapless(prog_name="gapless")
    finally:
        gc.freeze()
        screen.finish()
