"""What goes wrong with sensors, planted in simulated recordings, and what each fault is to be compared with.

    log = base("any", 480.0, seed=3)
    planted = plant(["repeats"], log, [200.0], seed=3)

`planted.faulted` is what would have been logged, `planted.spared` what a filter is to be held against
that knew of the fault: the issue of a fault is never worse than doing without what lies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from gapless.errors import ConfigError
from gapless.simulate.faults import inertial, odometer, receiver, stated
from gapless.simulate.faults.base import DRIVES, Fault, Planted
from gapless.simulate.faults.base import plant as _plant
from gapless.simulate.faults.drives import PROFILES, base
from gapless.trip.recording import Recording

__all__ = ["DRIVES", "FAULTS", "PROFILES", "Fault", "Planted", "base", "plant"]

FAULTS: Final[Mapping[str, Fault]] = {**receiver.KINDS, **odometer.KINDS, **inertial.KINDS, **stated.KINDS}
"""Kinds of faults by name."""


def plant(kinds: Sequence[str], log: Recording, times: Sequence[float], seed: int) -> Planted:
    """Plant faults in a simulated recording, one after the other.

    Parameters
    ----------
    kinds : sequence of str
        Names in `FAULTS`.
    log : Recording
        With its truth as reference.
    times : sequence of float
        When each is to begin [s]; some begin later, where the car drives, stands or reverses, and some
        have a time of their own.
    seed : int
        Draws how bad they are and how long they last; the name of a kind is part of it.

    Returns
    -------
    Planted

    Raises
    ------
    ConfigError
        If there is no such kind.
    """
    for kind in kinds:
        if kind not in FAULTS:
            raise ConfigError(f"no fault {kind!r}; the faults are {', '.join(FAULTS)}")
    return _plant([(kind, FAULTS[kind]) for kind in kinds], log, times, seed)
