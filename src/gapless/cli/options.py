"""Options that several verbs share, and what they come to: a recording, a recipe, outages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

if TYPE_CHECKING:
    from gapless.scenarios import Outage
    from gapless.systems.recipe import System
    from gapless.trip.recording import Recording

Command = TypeVar("Command", bound=Callable[..., Any])

FOLDER = click.Path(file_okay=False, path_type=Path)
recording_argument = click.argument("recording", nargs=-1, required=True, type=click.Path(path_type=Path))
force_option = click.option("--force", is_flag=True, help="Replace files that gapless did not write, too.")
out_option = click.option("--out", type=FOLDER, required=True, metavar="DIR", help="Folder to write to.")
_OUTAGE = (
    click.option(
        "--outage", multiple=True, metavar="START:END",
        help="Withhold GNSS from START to END, in seconds after the first IMU sample. Repeatable.",
    ),
    click.option(
        "--outages", multiple=True, metavar="PLAN",
        help="Withhold GNSS at regular intervals: every=180,length=60,first=240 (seconds), or by another "
        "plan: at random, in turns, degraded (docs/bench.md). Repeatable.",
    ),
)  # fmt: skip
_RECIPE = (
    click.option(
        "--system", metavar="NAME",
        help="Built-in recipe (`gapless systems` lists them; auto is the one used), perhaps with "
        "-PART, +constraints or +calibrated behind it: wang2018-bridge.",
    ),
    click.option(
        "--config", type=click.Path(path_type=Path), metavar="FILE",
        help="TOML recipe of your own; docs/configuration.md lists its keys.",
    ),
    click.option(
        "--without", multiple=True, metavar="NAME",
        help="Leave out a constraint (zero_velocity, nonholonomic) or a sensor "
        "(position, velocity, odometer), the bridge or denoise. Repeatable.",
    ),
    click.option(
        "--clock", multiple=True, metavar="SENSOR=SECONDS",
        help="Clock offset of position, velocity or odometer, added to its stamps, "
        "instead of the one found in the data. Repeatable.",
    ),
    click.option(
        "--causal", is_flag=True,
        help="Find clock offsets and mounting on the way, never ahead of the moment.",
    ),
)  # fmt: skip


class Job(NamedTuple):
    """What the shared options ask for.

    Parameters
    ----------
    recording : Recording
    system : System
    outages : tuple of Outage
    causal : bool
    """

    recording: Recording
    system: System
    outages: tuple[Outage, ...]
    causal: bool


def outage_options(command: Command) -> Command:
    """Give a verb `--outage` and `--outages`.

    Parameters
    ----------
    command : callable

    Returns
    -------
    callable
    """
    return _with(command, _OUTAGE)


def job_options(command: Command) -> Command:
    """Give a verb a recording, outages and a recipe; `job` understands them.

    Parameters
    ----------
    command : callable

    Returns
    -------
    callable
    """
    return _with(command, (recording_argument, *_OUTAGE, *_RECIPE))


def _with(command: Command, options: Sequence[Callable[[Command], Command]]) -> Command:
    for option in reversed(options):
        command = option(command)
    return command


def job(
    recording: Sequence[Path],
    outage: Sequence[str],
    outages: Sequence[str],
    system: str | None,
    config: Path | None,
    without: Sequence[str],
    clock: Sequence[str],
    causal: bool,
) -> Job:
    """Read what the shared options name; the recipe first, since a slip in it shows sooner.

    Parameters
    ----------
    recording : sequence of Path
    outage, outages : sequence of str
    system : str, optional
    config : Path, optional
    without, clock : sequence of str
    causal : bool

    Returns
    -------
    Job

    Raises
    ------
    GaplessError
        If a name, a value, a file or the data are wrong.
    """
    recipe = _system(system, config, without, clock)

    from concurrent.futures import ThreadPoolExecutor

    from gapless.io import read
    from gapless.scenarios import plan

    with ThreadPoolExecutor(1) as reader:  # it waits for the disk and for pyarrow's own threads
        reading = reader.submit(read, *recording)
        from gapless.fold.navigator import load_kernels  # what navigates takes as long to load

        load_kernels()
        found = reading.result()
    return Job(found, recipe, plan([*outage, *outages], found), causal)


def _system(name: str | None, config: Path | None, without: Sequence[str], clock: Sequence[str]) -> System:
    from gapless.errors import ConfigError
    from gapless.systems.adjust import named, with_clock
    from gapless.systems.adjust import without as left_out

    if name is not None and config is not None:
        raise ConfigError("--system and --config both name a recipe; give one of them")
    recipe = named(str(config) if config is not None else name or "auto")
    recipe = left_out(recipe, *without)
    for text in clock:
        channel, _, value = text.partition("=")
        try:
            recipe = with_clock(recipe, channel.strip(), float(value))
        except ValueError:
            raise ConfigError(f"--clock {text}: write it like position=-0.15, in seconds") from None
    return recipe
