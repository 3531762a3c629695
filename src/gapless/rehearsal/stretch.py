"""A stretch of a drive to rehearse: the navigator as it was, what came, and where it turned out to be."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import groupby

import numpy as np

from gapless import earth
from gapless.fold.journal import Journal
from gapless.fold.navigator import Navigator
from gapless.rehearsal.judge import AGES, REFERENCE
from gapless.trip.events import Event, ImuBlock
from gapless.trip.recording import Array, Trajectory


@dataclass
class Stretch:
    """One whose time has not passed yet.

    Parameters
    ----------
    start : float
        [s]
    navigator : Navigator
        As it was then.
    events : list of Event
        What came since, without GNSS.
    track : list of (float, float, float)
        Where the navigator was found with GNSS: time [s], latitude and longitude [rad].
    aided : bool
        Whether GNSS held all of it.
    """

    start: float
    navigator: Navigator
    events: list[Event] = field(default_factory=list)
    track: list[tuple[float, float, float]] = field(default_factory=list)
    aided: bool = True

    @property
    def samples(self) -> int:
        """IMU samples in it."""
        return sum(len(e.time) for e in self.events if isinstance(e, ImuBlock))

    @property
    def way(self) -> float:
        """Length of the track, or nearly: chords of ten rows, for a standing car's fixes wander [m]."""
        points = np.array(self.track)[::10, 1:]
        return float(np.hypot(*_metres(np.diff(points, axis=0), points[1:, 0])).sum())

    def watch(self, rows: Journal, since: int) -> None:
        """Note rows that were written with GNSS.

        Parameters
        ----------
        rows : Journal
        since : int
            The first that is new.
        """
        new = slice(since, None)
        self.track += [(t, x[0], x[1]) for t, x in zip(rows.times[new], rows.states[new], strict=True)]
        self.aided &= all(source == "gnss" for source in rows.sources[new])

    def script(self) -> list[Event]:
        """The events, with samples that follow each other in one block."""
        found = list[Event]()
        for samples, group in groupby(self.events, lambda e: isinstance(e, ImuBlock)):
            together = list(group)
            blocks = [event for event in together if isinstance(event, ImuBlock)]
            found += [ImuBlock.join(blocks)] if samples else together
        return found

    def copy(self) -> Stretch:
        """One that goes on by itself."""
        return replace(self, events=list(self.events), track=list(self.track))

    def apart(self, rows: Trajectory) -> tuple[float, tuple[float, ...]]:
        """How far a rehearsal went astray.

        Parameters
        ----------
        rows : Trajectory
            Without GNSS.

        Returns
        -------
        worst : float
            Largest distance from the track [m].
        nees : tuple of float
            Squared Mahalanobis distances, `AGES` apart, as the rehearsal states its position.
        """
        track = np.array(self.track)
        rows = rows.take(rows.time <= track[-1, 0])
        here = np.column_stack([np.interp(rows.time, track[:, 0], track[:, 1 + k]) for k in range(2)])
        north, east = _metres(rows.lla[:, :2] - here, here[:, 0])
        nn, ee = (rows.sd[:, k] ** 2 + REFERENCE**2 for k in range(2))
        square = ee * north**2 - 2.0 * rows.horizontal * north * east + nn * east**2
        nees = square / (nn * ee - rows.horizontal**2)
        at = np.searchsorted(rows.time, np.arange(self.start + AGES, track[-1, 0], AGES))
        return float(np.hypot(north, east).max()), tuple(nees[at[at < len(nees)]].tolist())


def _metres(away: Array, latitude: Array) -> tuple[Array, Array]:
    """North and east of small differences in latitude and longitude [m]."""
    r_m, r_n = earth.radii(np.sin(latitude))
    return away[:, 0] * r_m, earth.longitude(away[:, 1]) * r_n * np.cos(latitude)
