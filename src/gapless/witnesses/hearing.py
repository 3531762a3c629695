"""The hearing of all witnesses: who is believed, what is said of it, and what is doubted meanwhile."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

import numpy as np

from gapless.inertial.belief import Belief
from gapless.measurements.base import Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.units import DEG
from gapless.witnesses.askew import SPAN, Askew
from gapless.witnesses.channels import Channels
from gapless.witnesses.jolt import Jolts
from gapless.witnesses.rest import Rest
from gapless.witnesses.seat import Seat
from gapless.witnesses.sign import Sign
from gapless.witnesses.testimony import INSISTS, Ruling, Said, Testimony

HORIZONTAL: Final = {"position": slice(0, 3), "velocity": slice(0, 2), "odometer": slice(0, 1)}
"""Components that are compared; a vertical velocity is what receivers are worst at."""
FITTING: Final = 18.0 * DEG
"""What is askew by less may be a clock, as long as velocities fit [rad]."""
RADIUS: Final = 6.371e6
"""Of the earth, for differences of seconds [m]."""
NOWHERE: Final = np.zeros(3)
"""Fixes are where the filter is."""
SURE: Final = 2.0
"""A silence for so long is no accident [s]."""
FAR: Final = 10.0
"""What was said is taken back no further [s]."""
RESTS, DRIVES = 0.5, 3.0
"""A reading below the first says that the car stands, a filter above the second that it does not [m/s]."""


class FoundOut(Exception):
    """A receiver's channel was silenced for good: what it said of late is taken back.

    Parameters
    ----------
    channel : str
    since, until : float
        Its readings are not heard, these included [s].
    """

    def __init__(self, channel: str, since: float, until: float) -> None:
        super().__init__(channel)
        self.channel, self.since, self.until = channel, since, until


@dataclass
class Hearing:
    """The testimonies of all channels.

    Parameters
    ----------
    corrected : ndarray, shape (n,)
        Sum of all corrections of the error states.
    """

    corrected: Array
    channels: Channels = field(default_factory=Channels)
    rest: Rest = field(default_factory=Rest)
    offset: Array = field(default_factory=lambda: NOWHERE)
    sign: Sign = field(default_factory=Sign)
    jolts: Jolts = field(default_factory=Jolts)
    seat: Seat = field(default_factory=Seat)
    origin: Array | None = None
    turned: float = 0.0
    strayed: bool = False
    askew: Askew = field(default_factory=Askew)
    at_odds: dict[str, tuple[float, float]] = field(default_factory=dict)
    disowned: dict[str, FoundOut] = field(default_factory=dict)
    lie: FoundOut | None = None

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
        mine = self.channels.testimony(channel, part.stop)
        fits = nis <= bound
        lie = self.disowned.get(channel)
        known = lie is not None and lie.since <= reading.time <= lie.until
        if fits and not known and mine.needless(reading.time, reading.value):
            return self._in_passing(channel, reading)
        value = (o.z + o.H @ self.corrected)[part]
        raw = self._metres(reading) if channel == "position" else reading.value[part]
        var = o.R.diagonal()[part]
        self._tell(channel, reading.time, raw, math.sqrt(max(var[:2].tolist())))
        said = Said(reading.time, reading.value, raw, value, var, fits, nis, self._rests(reading, belief))
        if channel == "position":  # what drifts off while the car stands is the receiver, until it fits
            self.strayed = not fits and (self.strayed or self.rest.lately(reading.time))
        silenced = not mine.heard
        against = self.channels.against(said, channel, o.z, belief, self.strayed)
        ruling = mine.hear(
            said, self.channels.slack(channel, belief), *against, self.channels.suspected(channel)
        )
        if channel == "velocity":
            ruling = self._turned(said, ruling)
        if known:
            ruling = mine.silence(reading.time)
        elif ruling == "silence" and channel != "odometer":
            self._found_out(channel, mine, reading.time, -math.inf if lie is None else lie.until)
        if fits and ruling == "use":
            self.channels.fitted[channel] = reading.time
        if channel == "position":
            if silenced and mine.heard:
                self.channels.story.forget()
            doubtful = ruling == "silence" and mine.follows < reading.time
            self.offset = o.z.copy() if doubtful else NOWHERE
        return ruling

    def _found_out(self, channel: str, mine: Testimony, time: float, before: float) -> None:
        """Take back what a receiver said that has been silenced for longer than by an accident."""
        if mine.silent > before and time - mine.silent >= SURE and mine.lying < mine.silent:
            self.lie = FoundOut(channel, max(mine.lying, time - FAR), time)

    def disown(self, lie: FoundOut) -> None:
        """Go through readings again without those of a liar.

        Parameters
        ----------
        lie : FoundOut
        """
        self.disowned = {**self.disowned, lie.channel: lie}

    def _in_passing(self, channel: str, reading: Reading) -> Ruling:
        """Use a reading that fits between two that are heard."""
        self.channels.fitted[channel] = reading.time
        if channel == "velocity":
            self.channels.story.moved(reading.time, reading.value[:2])
        elif channel == "position":
            self.strayed, self.offset = False, NOWHERE
        return "use"

    def _tell(self, channel: str, time: float, raw: Array, sd: float) -> None:
        """The receiver's own story goes on."""
        if channel == "velocity":
            self.channels.story.moved(time, raw)
        elif channel == "position":
            self.channels.story.stood(time, raw[:2], sd)

    def _turned(self, said: Said, ruling: Ruling) -> Ruling:
        """Whether accelerations are felt from another side than they are seen."""
        if ruling == "silence" or said.time - self.askew.time < 0.9:
            return ruling
        change = self.channels.of["velocity"].past.change(said.time, said.value, said.raw, SPAN)
        if change is None:
            return ruling
        self.askew.hear(said.time, *change)
        self.turned = self.askew.angle
        if abs(self.turned) < (FITTING if said.fits else 0.0) or not self.turned:
            return ruling
        self.forget()
        return "turn"

    def in_vain(self, name: str, time: float, fits: bool) -> tuple[float, bool]:
        """For how long a constraint has surprised the filter: what it rests on moved, if that is too long.

        Parameters
        ----------
        name : str
            Of the constraint.
        time : float
            [s]
        fits : bool
            Whether it is no surprise now.

        Returns
        -------
        since : float
            [s]; 0 where it is not too long.
        news : bool
            Whether to do something about it: once in so long.
        """
        since, told = self.at_odds.get(name, (time, time))
        if fits or name not in self.at_odds:
            since = told = time
        long = time - since >= INSISTS
        news = long and time - told >= INSISTS
        self.at_odds[name] = since, time if news else told
        return (time - since if long else 0.0), news

    def _metres(self, reading: Reading) -> Array:
        """A position in metres from the first one; only differences count."""
        if self.origin is None:
            self.origin = reading.value
        north, east, up = (reading.value - self.origin).tolist()
        east = math.remainder(east, 2.0 * math.pi) * math.cos(reading.value[0])
        return np.array([RADIUS * north, RADIUS * east, -up])

    def _rests(self, reading: Reading, belief: Belief) -> bool:
        """Whether it says that the car stands where the filter drives."""
        if reading.channel == "position":
            return False
        said = math.hypot(*reading.value[:2]) if reading.channel == "velocity" else abs(reading.value[0])
        return said < RESTS and math.hypot(*belief.v_n[:2]) > DRIVES

    def forget(self) -> None:
        """The filter began anew: nothing that was compared with it counts."""
        self.channels.forget()
        self.at_odds, self.offset = {}, NOWHERE
        self.askew.forget()
        self.jolts.forget()

    def copy(self) -> Self:
        """An independent copy (arrays of its own are never changed in place)."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        new.channels, new.rest = self.channels.copy(), self.rest.copy()
        new.at_odds, new.askew = dict(self.at_odds), self.askew.copy()
        new.sign, new.jolts, new.seat = self.sign.copy(), self.jolts.copy(), self.seat.copy()
        return new
