"""`gapless inspect`: what is in a recording, and what fusion would decide."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from gapless.cli.options import job, job_options
from gapless.cli.screen import say


@click.command(short_help="Show what is in a recording and what fusion decides.")
@job_options
def inspect(**chosen: Any) -> None:
    """Show what is in a RECORDING and every decision that fusing it would take.

    Takes the options of fuse that bear on decisions, and writes no file.
    """
    from gapless.cli.describe import describe, notes
    from gapless.cli.progress import progress

    work = job(**chosen)
    say(*describe(work.recording), *notes(work.recording), "")

    from gapless.reports.summary import summarise
    from gapless.reports.terminal import summary_lines
    from gapless.runs.fuse import fuse

    with progress("deciding", work.recording.duration) as tell:
        solution = fuse(work.recording, work.system, work.outages, 1.0, work.causal, tell)
    told = summarise(replace(solution, notes=solution.notes[len(work.recording.notes) :]))
    nothing: dict[str, Any] = {"states": {}, "innovations": {}, "scores": None, "outages": []}
    say(*summary_lines(told | nothing, head=False))
