"""Everything of a navigator that changes."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from gapless.alignment.coarse import Aligner
from gapless.bridges.base import Bridge
from gapless.filters.adaptation.base import Adaptation
from gapless.filters.consider import Wander
from gapless.filters.stamp_doubt import StampDoubt
from gapless.fold.manner import Manner
from gapless.inertial.belief import Belief
from gapless.inertial.lately import Lately
from gapless.inertial.unseen import UNKNOWN, Turned, lose_track, turn, turned_about
from gapless.measurements.base import Constraint, Observation
from gapless.trip.events import Reading
from gapless.trip.recording import Array
from gapless.witnesses.hearing import Hearing

LASTS: Final = 1.6
"""A fix or a bridge's word holds for so long [s]: a second, and what a receiver at 1 Hz may be late."""
SOON: Final = 60.0
"""A filter that fixes put right does not go far astray again within this time [s]."""
ASIDE: Final = 1e-6
"""An observation that sees less than this share of its own variance has no direction."""


@dataclass
class State:
    """Everything of a navigator that changes, but for its journal.

    Parameters
    ----------
    belief : Belief
    adaptation : dict of str to Adaptation
        By kind of observation.
    constraints : dict of str to Constraint
    bridges : list of Bridge
    aligner : Aligner or None
        None once there is a heading that is trusted.
    wander : Wander
        What the fixes' common error does to the position.
    stamps : StampDoubt
        What a clock that is off would do to it.
    noise : ndarray, shape (7,)
        Process noise, as an adaptation left it; never changed in place.
    manner : Manner
        As rehearsals advise.
    hearing : Hearing
        Who of the channels is heard.
    pending : list of Reading
        Readings that hold for a time still to come, in its order.
    heard : dict of str to float
        When each channel was last used [s].
    agreed : dict of str to float
        When each channel was last believed as it is [s].
    clock : float
        End of the last sample taken in [s].
    next_row : float
        When the next journal row is due [s].
    aligned : bool
        Whether there ever was an attitude.
    fade : float
        Factor on the covariance that is due once time goes on.
    astray : tuple of float
        When positions found the filter far off, lately [s].
    box : ndarray, shape (3, 3), or None
        Takes what the sensors feel to the axes of the box as it sat at first, where it was knocked over.
    lost : bool
        Whether nothing of what was estimated is believed: the next start begins anew.
    lately : Lately
        What the IMU felt before the last sample, for a hole.
    guessed : bool
        Whether the present tick holds samples that bridge a hole.
    turned : Turned or None
        What the belief leaves out of its doubt.
    """

    belief: Belief
    adaptation: dict[str, Adaptation]
    constraints: dict[str, Constraint]
    bridges: list[Bridge]
    aligner: Aligner | None
    wander: Wander
    stamps: StampDoubt
    noise: Array
    manner: Manner
    hearing: Hearing
    pending: list[Reading] = field(default_factory=list)
    heard: dict[str, float] = field(default_factory=dict)
    agreed: dict[str, float] = field(default_factory=dict)
    clock: float = -math.inf
    next_row: float = -math.inf
    aligned: bool = False
    fade: float = 1.0
    astray: tuple[float, ...] = ()
    lost: bool = False
    box: Array | None = None
    lately: Lately = field(default_factory=Lately)
    guessed: bool = False
    turned: Turned | None = None

    @property
    def source(self) -> str:
        """What holds the navigation now: "gnss", "bridge", "constraints" or "ins"."""
        heard, now = self.heard, self.clock
        if now - max(heard.get("position", -math.inf), heard.get("velocity", -math.inf)) < LASTS:
            return "gnss"
        if now - heard.get("bridge", -math.inf) < LASTS:
            return "bridge"
        if any(now - heard.get(name, -math.inf) < 1.0 for name in (*self.constraints, "odometer")):
            return "constraints"
        return "ins"

    @property
    def headed(self) -> bool:
        """Whether the belief's heading is one that constraints which need one may count on."""
        return self.aligner is None or (self.turned is not None and not self.lost)

    @property
    def stated(self) -> Belief:
        """The belief with all of its doubt (a copy where some was set aside)."""
        if self.turned is None:
            return self.belief
        whole = self.belief.copy()
        turn(whole, *self.turned)
        return whole

    def lose_track(self, begin: float) -> None:
        """Carry the belief over a long hole of the IMU.

        Parameters
        ----------
        begin : float
            When samples come again [s].
        """
        silence, place = begin - self.clock, self.belief.lla.copy()
        sd = min(self.lately.turning * silence, UNKNOWN)
        lose_track(self.belief, begin, silence, sd)
        place = 0.5 * (place + self.belief.lla)
        self.turned = Turned(place, sd * sd) if self.turned is None else self.turned.after(sd)

    def face(self, o: Observation) -> None:
        """Take the doubt that was set aside back into the belief, if an observation has a direction.

        Parameters
        ----------
        o : Observation
        """
        if self.turned is not None:
            seen = np.square(o.H[:, :9] @ turned_about(self.belief, self.turned.place)) * self.turned.variance
            if (seen > ASIDE * o.R.diagonal()).any():
                turn(self.belief, *self.turned)
                self.turned = None

    @property
    def misled(self) -> bool:
        """Whether fixes found the filter far astray more than once of late: nothing is learned from it."""
        return self.lost or (len(self.astray) > 1 and self.clock - self.astray[-1] < SOON)

    def copy(self) -> State:
        """An independent copy.

        Returns
        -------
        State
        """
        return State(
            self.belief.copy(),
            {kind: rule.copy() for kind, rule in self.adaptation.items()},
            {name: c.copy() for name, c in self.constraints.items()},
            [bridge.copy() for bridge in self.bridges],
            None if self.aligner is None else self.aligner.copy(),
            self.wander.copy(),
            self.stamps.copy(),
            self.noise,
            self.manner,
            self.hearing.copy(),
            list(self.pending),
            dict(self.heard),
            dict(self.agreed),
            self.clock,
            self.next_row,
            self.aligned,
            self.fade,
            self.astray,
            self.lost,
            self.box,
            self.lately.copy(),
            self.guessed,
            self.turned,
        )

    def expect(self, readings: tuple[Reading, ...]) -> None:
        """Put readings in line, but for those that were applied or stand there already.

        Parameters
        ----------
        readings : tuple of Reading
        """
        for reading in readings:
            if reading.time > self.clock and not any(reading is waiting for waiting in self.pending):
                bisect.insort(self.pending, reading, key=lambda r: r.time)
