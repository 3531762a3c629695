"""The witnesses' bench: who is heard, what is said of it, and what is doubted meanwhile."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.witnesses.increments import Slack
from gapless.witnesses.sign import Sign
from gapless.witnesses.testimony import Ruling, Said, Testimony

PATIENCE: Final = {"position": 25.0, "velocity": 20.0, "odometer": 60.0}
"""By channel: for so long must what follows the motion contradict the filter to be believed [s]."""
HORIZONTAL: Final = {"position": slice(0, 3), "velocity": slice(0, 2), "odometer": slice(0, 1)}
"""Components that are compared; a vertical velocity is what receivers are worst at."""
FELT: Final = {"velocity": 2.0, "odometer": 1.5}
"""Acceleration that inertial sensors may get wrong without being broken [m/s^2]."""
SUSPECT: Final = 0.15
"""Share of that which is left to a receiver whose other channel is silenced."""
AGREED: Final = 2.5
"""A channel that was believed so lately is a witness [s]."""
LAXITY: Final = 0.3
"""Error of a velocity that is beyond what its deviation says [m/s]."""
RESTS, DRIVES = 0.5, 3.0
"""A reading below the first says that the car stands, a filter above the second that it does not [m/s]."""


@dataclass
class Bench:
    """The testimonies of all channels.

    Parameters
    ----------
    corrected : ndarray, shape (n,)
        Sum of all corrections of the error states.
    """

    corrected: Array
    channels: dict[str, Testimony] = field(default_factory=dict)
    fitted: dict[str, float] = field(default_factory=dict)
    offset: Array = field(default_factory=lambda: np.zeros(3))
    sign: Sign = field(default_factory=Sign)

    def hear(self, reading: Reading, o: Observation, nis: float, bound: float, belief: Belief) -> Ruling:
        """Rule on a reading before it is used.

        Parameters
        ----------
        reading : Reading
        o : Observation
            Of it.
        nis, bound : float
            z' S^-1 z, and beyond what it is surprising.
        belief : Belief

        Returns
        -------
        str
            As `Testimony.hear`.
        """
        channel, part = reading.channel, HORIZONTAL.get(reading.channel)
        if part is None or not math.isfinite(nis):
            return "use"
        mine = self.channels.get(channel)
        if mine is None:
            size = part.stop
            mine = self.channels[channel] = Testimony(size, PATIENCE[channel])
        value = (o.z + o.H @ self.corrected)[part]
        fits = nis <= bound
        said = Said(
            reading.time, reading.value, value, o.R.diagonal()[part], fits, self._rests(reading, belief)
        )
        ruling = mine.hear(said, self._slack(channel, belief), self._contradicted(channel, reading.time))
        if fits and ruling == "use":
            self.fitted[channel] = reading.time
        if channel == "position":
            doubtful = ruling == "silence" and mine.follows < reading.time
            self.offset = o.z.copy() if doubtful else np.zeros(3)
        return ruling

    def _slack(self, channel: str, belief: Belief) -> Slack:
        """What is left to the filter."""
        if channel == "position":
            p = belief.P
            sd = math.sqrt(max(float(p[3, 3] + p[4, 4]), 0.0))
            witnessed = self._believed("velocity", belief.time) or self._believed("odometer", belief.time)
            return Slack(3.0 * sd + LAXITY, 0.0 if witnessed else FELT["velocity"])
        other = self.channels.get("position")
        suspect = channel == "velocity" and other is not None and not other.heard
        return Slack(FELT[channel] * (SUSPECT if suspect else 1.0))

    def _rests(self, reading: Reading, belief: Belief) -> bool:
        """Whether it says that the car stands where the filter drives."""
        if reading.channel == "position":
            return False
        said = math.hypot(*reading.value[:2]) if reading.channel == "velocity" else abs(reading.value[0])
        return said < RESTS and math.hypot(*belief.v_n[:2]) > DRIVES

    def _contradicted(self, channel: str, time: float) -> bool:
        """Whether another channel that sees the same is with the filter."""
        if channel == "position":
            return False
        place = self.channels.get("position")
        if channel == "velocity" and place is not None and not place.following(time):
            return True  # one receiver: it does not know its speed while its place stands about
        return any(self._believed(name, time) for name in PATIENCE if name != channel)

    def _believed(self, channel: str, time: float) -> bool:
        mine = self.channels.get(channel)
        return mine is not None and mine.heard and time - self.fitted.get(channel, -math.inf) < AGREED

    def forget(self) -> None:
        """The filter began anew: nothing that was compared with it counts."""
        self.channels, self.fitted, self.offset = {}, {}, np.zeros(3)

    def copy(self) -> Self:
        """An independent copy (arrays of its own are never changed in place)."""
        channels = {name: one.copy() for name, one in self.channels.items()}
        return type(self)(self.corrected, channels, dict(self.fitted), self.offset, self.sign.copy())
