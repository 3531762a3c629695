"""A run that is told its attitude, as simulations in papers are."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self, cast

import numpy as np

from gapless import attitude
from gapless.alignment.coarse import Aligner, Start
from gapless.fold.settings import Settings
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.systems.recipe import System
from gapless.trip.events import Reading
from gapless.trip.recording import Array, Recording
from gapless.trip.solution import Solution


@dataclass
class Told:
    """Takes the place of an `Aligner`: starts at the first fix, from an attitude that is given.

    Parameters
    ----------
    q_nb : ndarray, shape (4,)
        Attitude at the first fix.
    sd : float
        Standard deviation of its heading [rad].
    fix : Reading, optional
        Position that was heard.
    """

    q_nb: Array
    sd: float
    fix: Reading | None = field(default=None)

    def feel(self, time: float, rows: Array) -> None:
        """Take in samples, which tell nothing new.

        Parameters
        ----------
        time : float
            [s]
        rows : ndarray
        """

    def hear(self, reading: Reading, now: float) -> Start | None:
        """Start with the first velocity that follows a position.

        Parameters
        ----------
        reading : Reading
        now : float
            Time of the last sample [s].

        Returns
        -------
        Start or None
        """
        if reading.channel == "position":
            self.fix = reading
            return None
        if reading.channel != "velocity" or self.fix is None:
            return None
        position, velocity = float(np.max(self.fix.sd)), float(np.max(reading.sd))
        said = f"told, {np.rad2deg(self.sd):.2g} deg"
        return Start(
            now, self.fix.value, np.array(reading.value), self.q_nb, None, position, velocity, self.sd, said
        )

    def copy(self) -> Self:
        """An independent copy.

        Returns
        -------
        Told
        """
        return replace(self)


def fuse_from(
    recording: Recording,
    truth: Recording,
    system: System,
    outages: tuple[Outage, ...],
    error: float,
    seed: int,
    rate: float = 10.0,
) -> Solution:
    """Navigate a simulated recording from its true attitude, a little misaligned.

    Parameters
    ----------
    recording : Recording
        Its first samples are at standstill, as those of the papers' simulations are.
    truth : Recording
        The same with its reference, of which the first attitude is taken.
    system : System
    outages : tuple of Outage
    error : float
        Standard deviation of the misalignment per axis [rad].
    seed : int
        Draws it.
    rate : float
        Rows of the solution per second.

    Returns
    -------
    Solution
    """
    assert truth.reference is not None
    tilt = error * np.random.default_rng([seed, 1]).standard_normal(3)
    true = attitude.from_euler(truth.reference.euler[0])
    told = Told(attitude.multiply(attitude.from_rotation_vector(tilt), true), error)

    def from_there(settings: Settings) -> Settings:
        sd = {**settings.initial_sd, "attitude": error}
        return replace(settings, aligner=cast(Aligner, told), initial_sd=sd)

    return fuse(recording, system, outages, rate, finish=from_there)
