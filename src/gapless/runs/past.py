"""The past navigated once more: with all of it known, readings need not come late."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from gapless.fold.feed import in_order, merged
from gapless.fold.navigator import Navigator
from gapless.fold.settings import Settings
from gapless.trip.recording import Recording

ENOUGH = 600.0
"""Seconds of navigation after which a pass learns little more."""
THIN = 0.45
"""Least time between the GNSS epochs that it takes [s]."""


def again(
    past: Recording, built: Settings, offsets: Mapping[str, float], enough: float = ENOUGH
) -> Navigator:
    """Navigate what was logged so far.

    Parameters
    ----------
    past : Recording
    built : Settings
    offsets : mapping of str to float
        By channel, as `gapless.fold.feed.events` takes them.
    enough : float
        Seconds after the first alignment at which it ends.

    Returns
    -------
    Navigator
        At the end of it.
    """
    navigator = Navigator(replace(built, lateness=0.0))
    for event in merged(past.imu, in_order(past, offsets, THIN)):
        navigator.step(event)
        if navigator.aligned and navigator.time > navigator.journal.alignments[0][0] + enough:
            break
    return navigator
