"""All channels' testimonies, and who of them is with whom."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Self

from gapless.inertial.belief import Belief
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.witnesses.increments import Slack
from gapless.witnesses.receiver import Story
from gapless.witnesses.testimony import Said, Testimony

PATIENCE: Final = {"position": 27.0, "velocity": 20.0, "odometer": 60.0}
"""By channel: for so long must what follows the motion contradict the filter to be believed [s]."""
FELT: Final = {"velocity": 2.0, "odometer": 1.5}
"""Acceleration that inertial sensors may get wrong without being broken [m/s^2]."""
SUSPECT: Final = 0.15
"""Share of that which is left to a receiver whose other channel is silenced."""
AGREED: Final = 2.5
"""A channel that was believed so lately is a witness [s]."""
LAXITY: Final = 0.3
"""Error of a velocity that is beyond what its deviation says [m/s]."""
AGREE: Final = 1.0
"""For so long must places and speeds have told one story [s]."""
SOON, SETTLES = 3.0, 30.0
"""So soon within this after the box was found to have moved [s]."""
ACCUSED: Final = 1.5
"""Positions that go with velocities that were silenced so long ago are silenced too [s]."""
LOST: Final = 25.0
"""A filter that denies a receiver's consistent story of a drive for so long is what is wrong [s]."""
PROBATION: Final = 20.0
"""How far off a receiver may be when it comes back [m]."""


@dataclass
class Channels:
    """Testimonies by channel.

    Parameters
    ----------
    of : dict of str to Testimony
    fitted : dict of str to float
        When each channel last fitted and was used [s].
    story : Story
        Of the receiver's places and speeds.
    moved : float
        When the box or the heading was found to have moved [s].
    """

    of: dict[str, Testimony] = field(default_factory=dict)
    fitted: dict[str, float] = field(default_factory=dict)
    story: Story = field(default_factory=Story)
    moved: float = -math.inf

    def testimony(self, channel: str, size: int) -> Testimony:
        """That of a channel; a new one of its first reading.

        Parameters
        ----------
        channel : str
        size : int
            Components that are compared.

        Returns
        -------
        Testimony
        """
        if channel not in self.of:
            self.of[channel] = Testimony(size, PATIENCE[channel])
        return self.of[channel]

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
        return any(self.believed(channel, time) for channel in ("position", "velocity"))

    def silenced(self, channel: str) -> bool:
        """Whether a channel is not heard.

        Parameters
        ----------
        channel : str

        Returns
        -------
        bool
        """
        return channel in self.of and not self.of[channel].heard

    def rolls_otherwise(self, time: float) -> bool:
        """Whether wheels that turn do not agree with the filter.

        Parameters
        ----------
        time : float
            [s]

        Returns
        -------
        bool
        """
        wheels = self.of.get("odometer")
        if wheels is None or wheels.copies(time):
            return False
        return not wheels.heard or wheels.surprises > 0

    def acquit(self, channel: str) -> None:
        """Hear a channel again, for it was the filter that was wrong.

        Parameters
        ----------
        channel : str
        """
        if channel in self.of:
            self.of[channel].silent = math.inf

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
        both = [one for name, one in self.of.items() if name in ("position", "velocity")]
        if not both or any(one.heard or one.copies(time) for one in both) or not self.story.drove:
            return False
        enough = SOON if time - self.moved < SETTLES else LOST
        return time - max(self.story.since, *(one.silent for one in both)) > enough

    def probation(self, reading: Reading, z: Array) -> float:
        """Variance on top of a reading's: who comes back may be as far off as it seems, and glide.

        Parameters
        ----------
        reading : Reading
            A position or a velocity.
        z : ndarray
            Its innovation [m] or [m/s].

        Returns
        -------
        float
            Of a second's worth of readings [m^2] or [m^2/s^2]; 0 but for these, and of positions once places
            and speeds have told one story.
        """
        mine, place = self.of.get(reading.channel), reading.channel == "position"
        if mine is None or not mine.returning(reading.time):
            return 0.0
        if place and reading.time - self.story.since >= AGREE:
            return 0.0
        least = PROBATION**2 if place else 0.0
        return (least + 4.0 * float(z[0] ** 2 + z[1] ** 2)) / min(reading.interval, 1.0)

    def slack(self, channel: str, belief: Belief) -> Slack:
        """What is left to the filter.

        Parameters
        ----------
        channel : str
        belief : Belief

        Returns
        -------
        Slack
        """
        if channel == "position":
            p = belief.P
            sd = math.sqrt(max(float(p[3, 3] + p[4, 4]), 0.0))
            witnessed = any(
                self.believed(name, belief.time) and not self.of[name].surprises
                for name in ("velocity", "odometer")
            )
            return Slack(3.0 * sd + LAXITY, 0.0 if witnessed else FELT["velocity"])
        return Slack(FELT[channel] * (SUSPECT if self.suspected(channel) < math.inf else 1.0))

    def suspected(self, channel: str) -> float:
        """Since when a receiver's place has been silenced, for its speed.

        Parameters
        ----------
        channel : str

        Returns
        -------
        float
            [s]; infinite where it is not.
        """
        place = self.of.get("position")
        return math.inf if channel != "velocity" or place is None else place.silent

    def against(
        self, said: Said, channel: str, z: Array, belief: Belief, strayed: bool
    ) -> tuple[bool, bool, bool]:
        """Who is with the filter.

        Parameters
        ----------
        said : Said
        channel : str
        z : ndarray
            Its innovation.
        belief : Belief
        strayed : bool
            Whether a position drifted off while the car stood.

        Returns
        -------
        denied, contradicted, accused : bool
            As for `Testimony.hear`.
        """
        time = said.time
        if channel == "position":
            speed = self.of.get("velocity")
            lied = speed is not None and time - speed.silent > ACCUSED and not speed.following(time)
            glides = self.story.torn and self.of["position"].returning(time)
            return strayed, False, glides or (lied and time - self.story.since > ACCUSED)
        place = self.of.get("position")
        if channel == "velocity" and place is not None and not place.following(time):
            return True, True, False  # one receiver: it does not know its speed while its place stands about
        if channel == "velocity" and self.story.torn:
            return True, True, False
        others = any(self.believed(name, time) for name in PATIENCE if name != channel)
        if channel == "odometer":
            return others or self.of[channel].leapt(said.nis), others, False
        return others and self._rolled(time, z, belief), others, False

    def _rolled(self, time: float, z: Array, belief: Belief) -> bool:
        """Whether wheels that turn, and are believed, turn at another speed than a velocity says."""
        wheels = self.of.get("odometer")
        if wheels is None or not self.believed("odometer", time) or wheels.copies(time):
            return False
        speed = math.hypot(*(belief.v_n[:2] + z[:2]))
        return abs(speed - abs(float(wheels.logged[0]))) > 0.5 * math.hypot(*z[:2])

    def believed(self, channel: str, time: float) -> bool:
        """Whether a channel is heard, and has just fitted.

        Parameters
        ----------
        channel : str
        time : float
            [s]

        Returns
        -------
        bool
        """
        mine = self.of.get(channel)
        return mine is not None and mine.heard and time - self.fitted.get(channel, -math.inf) < AGREED

    def forget(self) -> None:
        """Nothing that was compared with the filter counts."""
        self.of, self.fitted = {}, {}

    def copy(self) -> Self:
        """An independent copy."""
        of = {name: one.copy() for name, one in self.of.items()}
        return type(self)(of, dict(self.fitted), self.story.copy(), self.moved)
