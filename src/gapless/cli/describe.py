"""What is in a recording, as lines for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gapless.trip.recording import Columns, Recording


def describe(recording: Recording) -> list[str]:
    """Sensors of a recording with their rates, spans and gaps.

    Parameters
    ----------
    recording : Recording

    Returns
    -------
    list of str
        At most 80 columns wide, but for a long name.
    """
    from gapless.reports.numbers import duration

    lines = [f"{recording.name} · {duration(recording.duration)}"]
    lines.append(f"  {'sensor':<11}{'rows':>9}{'rate':>10}{'from s':>14}{'to s':>14}  gaps")
    for name, columns in _sensors(recording):
        lines.append(_line(name, columns))
    if recording.reference is not None:
        lines.append(f"  reference: {_contents(recording)}, on the {recording.reference_clock.upper()} clock")
    if recording.grade is not None:
        lines.append(f"  sensor grade stated: {recording.grade}")
    return lines


def notes(recording: Recording) -> list[str]:
    """What was mended or noticed while reading.

    Parameters
    ----------
    recording : Recording

    Returns
    -------
    list of str
        Empty if nothing was.
    """
    import textwrap

    lines = [f"  {n.where}: {n.what}" + (f" ({n.count})" if n.count else "") for n in recording.notes]
    wrapped = [part for line in lines for part in textwrap.wrap(line, 80, subsequent_indent=" " * 6)]
    return ["", "Noticed", *wrapped] if lines else []


def _sensors(recording: Recording) -> Iterator[tuple[str, Columns]]:
    for name in ("imu", "gnss", "odometer", "reference"):
        columns = getattr(recording, name)
        if columns is not None:
            yield name, columns


def _line(name: str, columns: Columns) -> str:
    import numpy as np

    time = columns.time
    if len(time) < 2:
        return f"  {name:<11}{len(time):>9}"
    steps = np.diff(time)
    usual = float(np.median(steps))
    gaps = steps[steps > max(3.0 * usual, usual + 0.5)]
    told = f"{len(gaps)}, longest {gaps.max():.1f} s" if len(gaps) else "none"
    rate = f"{1.0 / usual:.4g} Hz" if usual > 0.0 else "?"
    return f"  {name:<11}{len(time):>9}{rate:>10}{time[0]:>14.2f}{time[-1]:>14.2f}  {told}"


def _contents(recording: Recording) -> str:
    import numpy as np

    truth = recording.reference
    assert truth is not None
    parts = ["position"]
    parts += ["velocity"] * bool(np.isfinite(truth.v_n).any())
    parts += ["attitude"] * bool(np.isfinite(truth.euler).any())
    return ", ".join(parts)
