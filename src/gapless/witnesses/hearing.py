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
from gapless.witnesses.increments import Slack
from gapless.witnesses.jolt import Jolts
from gapless.witnesses.receiver import Story
from gapless.witnesses.sign import Sign
from gapless.witnesses.testimony import INSISTS, Ruling, Said, Testimony

PATIENCE: Final = {"position": 27.0, "velocity": 20.0, "odometer": 60.0}
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
SOON, SETTLES = 3.0, 30.0
"""So soon within this after the box was found to have moved [s]."""
ZERO: Final = 0.1 * DEG
"""A gyro's zero that is off by so much has moved [rad/s]."""
LATELY: Final = 5.0
"""What a receiver drifted off by while the car stood shows so soon after it drives off [s]."""
APART: Final = 1.0
"""Words of rest less apart are of one rest [s]."""
FITTING: Final = 18.0 * DEG
"""What is askew by less may be a clock, as long as velocities fit [rad]."""
ACCUSED: Final = 1.5
"""Positions that go with velocities that were silenced so long ago are silenced too [s]."""
SHARED: Final = 2.0
"""Fixes of a standing car less apart are one [s]."""
LOST: Final = 25.0
"""A filter that denies a receiver's consistent story of a drive for so long is what is wrong [s]."""
RADIUS: Final = 6.371e6
"""Of the earth, for differences of seconds [m]."""
NOWHERE: Final = np.zeros(3)
"""Fixes are where the filter is."""
PROBATION: Final = 20.0
"""How far off a receiver may be when it comes back [m]."""
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
    channels: dict[str, Testimony] = field(default_factory=dict)
    fitted: dict[str, float] = field(default_factory=dict)
    offset: Array = field(default_factory=lambda: NOWHERE)
    sign: Sign = field(default_factory=Sign)
    jolts: Jolts = field(default_factory=Jolts)
    origin: Array | None = None
    turned: float = 0.0
    moved: float = -math.inf
    strayed: bool = False
    stood: float = math.inf
    rested: tuple[float, float, Array, int] = field(default_factory=lambda: (0.0, -math.inf, np.zeros(3), 0))
    askew: Askew = field(default_factory=Askew)
    story: Story = field(default_factory=Story)
    at_odds: dict[str, float] = field(default_factory=dict)
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
        mine = self.channels.get(channel)
        if mine is None:
            size = part.stop
            mine = self.channels[channel] = Testimony(size, PATIENCE[channel])
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
            self.strayed = not fits and (self.strayed or reading.time - self.rested[1] < LATELY)
        slack, suspected = self._slack(channel, belief), self._suspected(channel)
        ruling = mine.hear(said, slack, *self._against(said, channel, o.z, belief), suspected)
        if channel == "velocity":
            ruling = self._turned(said, ruling)
        if known:
            ruling = mine.silence(reading.time)
        elif ruling == "silence" and channel != "odometer":
            self._found_out(channel, mine, reading.time, -math.inf if lie is None else lie.until)
        if fits and ruling == "use":
            self.fitted[channel] = reading.time
        if channel == "position":
            doubtful = ruling == "silence" and mine.follows < reading.time
            self.offset = o.z.copy() if doubtful else NOWHERE
        return ruling

    def _found_out(self, channel: str, mine: Testimony, time: float, before: float) -> None:
        """Take back what a receiver said that has been silenced for longer than by an accident."""
        if mine.silent > before and time - mine.silent >= SURE:
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
        self.fitted[channel] = reading.time
        if channel == "velocity":
            self.story.moved(reading.time, reading.value[:2])
        elif channel == "position":
            self.strayed, self.offset = False, NOWHERE
        return "use"

    def _tell(self, channel: str, time: float, raw: Array, sd: float) -> None:
        """The receiver's own story goes on."""
        if channel == "velocity":
            self.story.moved(time, raw)
        elif channel == "position":
            self.story.stood(time, raw[:2], sd)

    def beside_the_road(self, time: float) -> bool:
        """Whether a receiver that tells one story of a drive has been silenced for too long: we are lost.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        both = [one for name, one in self.channels.items() if name in ("position", "velocity")]
        if not both or any(one.heard or one.copies(time) for one in both) or not self.story.drove:
            return False
        enough = SOON if time - self.moved < SETTLES else LOST
        return time - max(self.story.since, *(one.silent for one in both)) > enough

    def _turned(self, said: Said, ruling: Ruling) -> Ruling:
        """Whether accelerations are felt from another side than they are seen."""
        if ruling == "silence" or said.time - self.askew.time < 0.9:
            return ruling
        change = self.channels["velocity"].past.change(said.time, said.value, said.raw, SPAN)
        if change is None:
            return ruling
        self.askew.hear(said.time, *change)
        self.turned = self.askew.angle
        if abs(self.turned) < (FITTING if said.fits else 0.0) or not self.turned:
            return ruling
        self.forget()
        return "turn"

    def drifts(self, time: float, rate: Array, belief: Belief) -> Array | None:
        """Mean rate of a car that GNSS sees stand, where it is more than a gyro's zero may be.

        Parameters
        ----------
        time : float
            [s]
        rate : ndarray, shape (3,)
            Left of the gyros' at rest [rad/s].
        belief : Belief

        Returns
        -------
        ndarray, shape (3,), or None
            [rad/s], once in `INSISTS` seconds.
        """
        if not self.seen(time) or time - self.rested[1] > APART:
            self.rested = time, time, np.zeros(3), 0
        since, _, total, n = self.rested
        self.rested = since, time, total + rate, n + 1
        if time - since < INSISTS:
            return None
        mean = self.rested[2] / self.rested[3]
        self.rested = time, time, np.zeros(3), 0
        known = np.sqrt(belief.P.diagonal()[9:12])
        return mean if bool((np.abs(mean) > ZERO + 4.0 * known).any()) else None

    def in_vain(self, name: str, time: float, fits: bool) -> float:
        """For how long a constraint has surprised the filter, once that is too long: what it rests on moved.

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
        float
            [s], once; else 0.
        """
        since = self.at_odds.get(name, math.inf)
        long = time - since >= INSISTS
        if fits or long or since == math.inf:
            self.at_odds[name] = time
        return time - since if long and not fits else 0.0

    def seen(self, time: float) -> bool:
        """Whether GNSS is with the filter.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        return any(self._believed(channel, time) for channel in ("position", "velocity"))

    def acquit(self, channel: str) -> None:
        """Hear a channel again, for it was the filter that was wrong.

        Parameters
        ----------
        channel : str
        """
        if channel in self.channels:
            self.channels[channel].silent = math.inf

    def resting(self, time: float, rests: bool) -> float:
        """Factor on the variance of a fix: those of a standing car have their error in common.

        Parameters
        ----------
        time : float
            [s]
        rests : bool
            Whether it stands.

        Returns
        -------
        float
            1 plus the seconds that it has stood, over `SHARED`: all fixes of a rest together count as a few.
        """
        self.stood = min(self.stood, time) if rests else math.inf
        place = self.channels.get("position")
        silenced = place is not None and not place.heard  # one that was silenced must fit by its own word
        return 1.0 + (time - self.stood) / SHARED if rests and not silenced else 1.0

    def probation(self, reading: Reading) -> float:
        """Variance on top of that of a fix: a receiver that comes back may be far off, and glide.

        Parameters
        ----------
        reading : Reading
            A position.

        Returns
        -------
        float
            Of some seconds' worth of fixes [m^2]; 0 but for these.
        """
        mine = self.channels.get("position")
        if mine is None or not mine.returning(reading.time):
            return 0.0
        return PROBATION**2 / min(reading.interval, 1.0)

    def _metres(self, reading: Reading) -> Array:
        """A position in metres from the first one; only differences count."""
        if self.origin is None:
            self.origin = reading.value
        step = (reading.value - self.origin) * RADIUS
        return np.array([step[0], step[1] * math.cos(reading.value[0]), self.origin[2] - reading.value[2]])

    def _slack(self, channel: str, belief: Belief) -> Slack:
        """What is left to the filter."""
        if channel == "position":
            p = belief.P
            sd = math.sqrt(max(float(p[3, 3] + p[4, 4]), 0.0))
            witnessed = self._believed("velocity", belief.time) or self._believed("odometer", belief.time)
            return Slack(3.0 * sd + LAXITY, 0.0 if witnessed else FELT["velocity"])
        return Slack(FELT[channel] * (SUSPECT if self._suspected(channel) < math.inf else 1.0))

    def _suspected(self, channel: str) -> float:
        """Since when a receiver's place has been silenced, for its speed [s]."""
        place = self.channels.get("position")
        return math.inf if channel != "velocity" or place is None else place.silent

    def _rests(self, reading: Reading, belief: Belief) -> bool:
        """Whether it says that the car stands where the filter drives."""
        if reading.channel == "position":
            return False
        said = math.hypot(*reading.value[:2]) if reading.channel == "velocity" else abs(reading.value[0])
        return said < RESTS and math.hypot(*belief.v_n[:2]) > DRIVES

    def _against(self, said: Said, channel: str, z: Array, belief: Belief) -> tuple[bool, bool, bool]:
        """Whether others are with the filter against one that is heard, against one that was silenced.

        And whether it is a position that tells the story of velocities that were silenced.
        """
        time = said.time
        if channel == "position":
            speed = self.channels.get("velocity")
            lied = speed is not None and time - speed.silent > ACCUSED and not speed.following(time)
            glides = self.story.torn and self.channels["position"].returning(time)
            return self.strayed, False, glides or (lied and time - self.story.since > ACCUSED)
        place = self.channels.get("position")
        if channel == "velocity" and place is not None and not place.following(time):
            return True, True, False  # one receiver: it does not know its speed while its place stands about
        if channel == "velocity" and self.story.torn:
            return True, True, False
        others = any(self._believed(name, time) for name in PATIENCE if name != channel)
        if channel == "odometer":
            return others or self.channels[channel].leapt(said.nis), others, False
        return others and self._rolled(time, z, belief), others, False

    def _rolled(self, time: float, z: Array, belief: Belief) -> bool:
        """Whether a velocity is about another speed, mostly, and wheels that turn do not see it."""
        wheels = self.channels.get("odometer")
        if wheels is None or not self._believed("odometer", time) or wheels.copies(time):
            return False
        v = belief.v_n[:2]
        return abs(math.hypot(*(v + z[:2])) - math.hypot(*v)) > 0.5 * math.hypot(*z[:2])

    def _believed(self, channel: str, time: float) -> bool:
        mine = self.channels.get(channel)
        return mine is not None and mine.heard and time - self.fitted.get(channel, -math.inf) < AGREED

    def forget(self) -> None:
        """The filter began anew: nothing that was compared with it counts."""
        self.channels, self.fitted, self.at_odds, self.offset = {}, {}, {}, NOWHERE
        self.askew.forget()
        self.jolts.forget()

    def copy(self) -> Self:
        """An independent copy (arrays of its own are never changed in place)."""
        new = object.__new__(type(self))
        vars(new).update(vars(self))
        new.channels = {name: one.copy() for name, one in self.channels.items()}
        new.fitted, new.at_odds = dict(self.fitted), dict(self.at_odds)
        new.askew = self.askew.copy()
        new.story = self.story.copy()
        new.sign, new.jolts = self.sign.copy(), self.jolts.copy()
        return new
