"""What people report of navigation that was fooled, each as a short simulated drive.

    python benchmarks/situations.py [NAME ...] [--system auto]

For each window of each: the largest horizontal error, the radius of the stated 95 % ellipse (median of its
longer half), the share of rows that the ellipse holds, and what all that is held to: about twice what the
same drive costs without what lies, and no less than 5 m beside single-point fixes; with stamps that are off,
some part of the way driven meanwhile. A table in markdown.
`tests/truth/test_situations.py` holds them to it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from faults import within

from gapless.attitude import wrap
from gapless.evaluation.errors import solution_errors
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate import Receiver, Segment, Vehicle, WheelSensor, simulate
from gapless.simulate.faults import FAULTS, drives
from gapless.systems.adjust import changed, named
from gapless.trip.recording import Recording
from gapless.units import DEG

RTK = Receiver(5.0, (0.01, 0.01, 0.02), (0.01, 0.01, 0.02), 60.0, (0.02, 0.02, 0.04), fix=4)
SINGLE = Receiver(stated=1.3)
MOST = 0.7
"""Of a window's rows, at least so many are inside: rows of one drive go together, so 95 % is no bound."""


class Window(NamedTuple):
    """From, until [s]; no error is larger [m]; at least this share is inside."""

    start: float
    end: float
    metres: float
    share: float = MOST


@dataclass(frozen=True)
class Situation:
    """A drive with what happened to it, and what is held of it.

    Its reference is where fixes say that it is, if they moved for good.
    """

    drive: Callable[[], Recording]
    windows: tuple[Window, ...]
    outage: tuple[float, float] | None = None
    keys: Mapping[str, Any] = field(default_factory=dict)
    """Of the recipe."""


class Seen(NamedTuple):
    """What a window showed: largest error [m], stated radius [m], share of rows inside."""

    window: Window
    largest: float
    stated: float
    share: float

    @property
    def holds(self) -> bool:
        """Whether both bounds are kept."""
        return self.largest <= self.window.metres and self.share >= self.window.share


def driven(profile: str | tuple[Segment, ...], seconds: float, seed: int, **more: Any) -> Recording:
    """A drive whose sensors nobody told the grade of."""
    more.setdefault("receiver", SINGLE)
    return replace(simulate(profile, "consumer", seconds, seed, **more), grade=None)


def spoilt(kind: str, size: float, start: float, end: float, drive: Callable[[], Recording]) -> Recording:
    """A drive with a fault of some size, in the unit of its kind, from `start` until `end` [s]."""
    fault = FAULTS[kind]
    return fault.plant(drive(), (start, end), size * fault.scale, np.random.default_rng(4)).faulted


def told(arm: tuple[float, float, float], drive: Callable[[], Recording]) -> Recording:
    """A drive whose lever arm is said to be this."""
    return replace(drive(), lever_arm=np.array(arm))


def sawtooth(drive: Callable[[], Recording]) -> Recording:
    """A receiver whose clock runs one per cent slow and is set right every 20 s."""
    log = drive()
    time = log.gnss.time + 0.01 * (log.gnss.time % 20.0)
    return replace(log, gnss=replace(log.gnss, time=time).take(np.diff(time, prepend=-1.0) > 0.0))


def wrapped(drive: Callable[[], Recording]) -> Recording:
    """Longitudes between -180 and 180 degrees, as they are logged."""
    log = drive()
    assert log.reference is not None
    parts = {}
    for name, part in (("gnss", log.gnss), ("reference", log.reference)):
        lla = part.lla.copy()
        lla[:, 1] = wrap(lla[:, 1])
        parts[name] = replace(part, lla=lla)
    return replace(log, **parts)  # type: ignore[arg-type]


END = np.inf
ROAD = partial(driven, "highway", 240.0, 21)
TOWN = partial(driven, "urban", 300.0, 12)
WHEELS = partial(driven, "highway", 270.0, 23, wheels=WheelSensor(scale=0.01, noise=0.03))
RTK_TOWN = partial(driven, "urban", 240.0, 14, receiver=RTK)
ROOF, TRUCK = (0.8, -0.3, -1.4), (3.2, 0.8, -1.6)
ALLEYS = partial(driven, drives.dead_ends(np.random.default_rng(6)), 260.0, 6, wheels=WheelSensor(noise=0.03))
"""In reverse from 154 to 192 s."""
BACK = (145.0, 195.0)
BACKWARDS = (Segment(30.0), Segment(5.0, -1.2), Segment(14.0), Segment(5.0, 1.2), Segment(6.0))
ON = (Segment(8.0, 1.5), Segment(30.0), Segment(6.0, 0.0, 15.0 * DEG), Segment(25.0), Segment(8.0, -1.5))
FIJI, PATAGONIA = (-17.2 * DEG, 179.99 * DEG, 15.0), (-53.1 * DEG, -70.9 * DEG, 30.0)

OUT = (230.0, 270.0)
"""An outage after a fault at 150 s."""
SILENT = (200.0, 250.0)
AFTER = (Window(180.0, 230.0, 8.0), Window(*OUT, 20.0))
"""Half a minute after a fault of the IMU it is over; the outage then costs what it costs."""
FOLLOWED = Window(182.0, 300.0, 5.0)
"""Positions that moved at 150 s are followed after half a minute, and a fix or two."""
FROZEN = (Window(150.0, 180.0, 30.0), Window(180.0, 240.0, 30.0))
SITUATIONS: Mapping[str, Situation] = {
    "receiver repeats itself": Situation(partial(spoilt, "repeats", 1.0, 150.0, 180.0, ROAD), FROZEN),
    "receiver repeats itself, within 5 mm": Situation(
        partial(spoilt, "repeats-nearly", 0.005, 150.0, 180.0, ROAD), FROZEN
    ),
    "receiver stands while the car drives": Situation(
        partial(spoilt, "stands", 1.0, 150.0, 180.0, ROAD), FROZEN
    ),
    "position repeated, velocity alive": Situation(
        partial(spoilt, "repeats-position", 1.0, 150.0, 180.0, ROAD),
        FROZEN,
    ),
    "velocity repeated, position alive": Situation(
        partial(spoilt, "repeats-velocity", 1.0, 150.0, 190.0, TOWN), (Window(150.0, 290.0, 15.0),)
    ),
    "receiver coasts by itself": Situation(partial(spoilt, "coasts", 1.0, 150.0, 180.0, ROAD), FROZEN),
    "positions aside by 30 m for a while": Situation(
        partial(spoilt, "jumps", 30.0, 150.0, 180.0, ROAD),
        (Window(150.0, 180.0, 33.0), Window(180.0, 240.0, 33.0)),  # followed just before they move back
    ),
    "positions aside by 18 m for good": Situation(
        partial(spoilt, "moves", 18.0, 150.0, END, TOWN), (FOLLOWED,)
    ),
    "positions aside by 55 m for good": Situation(
        partial(spoilt, "moves", 55.0, 150.0, END, TOWN), (FOLLOWED,)
    ),
    "positions drift off at a traffic light": Situation(
        partial(spoilt, "drifts", 0.3, 207.0, 250.0, TOWN), (Window(207.0, 295.0, 5.0),)
    ),
    "velocity zero in one row of eight": Situation(
        partial(spoilt, "says-zero-at-times", 0.125, 0.0, END, TOWN), (Window(60.0, 300.0, 5.0),)
    ),
    "velocity zero for half a minute": Situation(
        partial(spoilt, "says-zero", 1.0, 150.0, 180.0, ROAD), (Window(150.0, 240.0, 30.0),)
    ),
    "tunnel filled in": Situation(
        partial(spoilt, "fills-in", 1.0, 150.0, 190.0, TOWN), (Window(150.0, 240.0, 15.0),)
    ),
    "aside after a tunnel, glides back": Situation(
        partial(spoilt, "comes-back", 30.0, 130.0, 190.0, TOWN), (Window(130.0, 240.0, 20.0),)
    ),
    "gyro warms up by 0.4 deg/s": Situation(
        partial(spoilt, "gyro-warms", 0.4, 60.0, 180.0, TOWN),
        (Window(120.0, 230.0, 8.0), Window(*OUT, 50.0)),
        OUT,
    ),
    "gyro leaps by 0.6 deg/s": Situation(partial(spoilt, "gyro-leaps", 0.6, 150.0, END, TOWN), AFTER, OUT),
    "gyro leaps by 2.5 deg/s": Situation(
        partial(spoilt, "gyro-leaps", 2.5, 150.0, END, TOWN), AFTER, OUT
    ),
    "accelerometer leaps by 0.5 m/s2": Situation(
        partial(spoilt, "accelerometer-leaps", 0.5, 150.0, END, TOWN), AFTER, OUT
    ),
    "bumps of 3 g, clipped at 2": Situation(
        partial(spoilt, "clips", 30.0, 150.0, 210.0, TOWN), (Window(150.0, 230.0, 6.0), AFTER[1]), OUT
    ),
    "box turned by 35 deg": Situation(partial(spoilt, "box-turned", 35.0, 150.0, END, TOWN), AFTER, OUT),
    "box tipped by 20 deg": Situation(
        partial(spoilt, "box-tipped", 20.0, 150.0, END, TOWN), AFTER, OUT
    ),
    "box falls over": Situation(
        partial(spoilt, "box-knocked-over", 90.0, 150.0, END, TOWN),
        AFTER,
        OUT,
    ),
    "samples missing for 1 s": Situation(
        partial(spoilt, "imu-pauses", 1.0, 70.0, 190.0, TOWN), (Window(60.0, 230.0, 6.0), AFTER[1]), OUT
    ),
    "odometer dies, outage 50 s later": Situation(
        partial(spoilt, "odometer-stands", 1.0, 150.0, END, WHEELS), (Window(*SILENT, 10.0),), SILENT
    ),
    "odometer dies just before an outage": Situation(
        partial(spoilt, "odometer-stands", 1.0, 196.0, END, WHEELS), (Window(*SILENT, 10.0),), SILENT
    ),
    "odometer dies in an outage": Situation(
        partial(spoilt, "odometer-stands", 1.0, 215.0, END, WHEELS), (Window(*SILENT, 10.0),), SILENT
    ),
    "odometer slips by 30 % in an outage": Situation(
        partial(spoilt, "odometer-slips", 30.0, 215.0, 222.0, WHEELS), (Window(*SILENT, 10.0),), SILENT
    ),
    "reversing through an outage": Situation(ALLEYS, (Window(*BACK, 50.0),), BACK),
    "the same, odometer without sign": Situation(
        partial(spoilt, "odometer-unsigned", 1.0, 0.0, END, ALLEYS), (Window(*BACK, 50.0),), BACK
    ),
    "odometer without sign, no outage": Situation(
        partial(spoilt, "odometer-unsigned", 1.0, 0.0, END, ALLEYS), (Window(*BACK, 5.0),)
    ),
    "starts in reverse at 6 m/s": Situation(
        partial(driven, (*BACKWARDS, *ON, Segment(8.0), *ON), 220.0, 8),
        (Window(75.0, 160.0, 8.0), Window(160.0, 200.0, 40.0)),
        (160.0, 200.0),
    ),
    "never faster than 12 km/h": Situation(
        partial(driven, "carpark", 240.0, 9), (Window(100.0, 240.0, 5.0),), None, {"alignment.min_speed": 1.0}
    ),
    "RTK, clocks right": Situation(RTK_TOWN, (Window(60.0, 240.0, 0.3),)),
    "RTK, antenna on the roof, told": Situation(
        partial(RTK_TOWN, vehicle=Vehicle(antenna=ROOF)), (Window(60.0, 240.0, 0.4),)
    ),
    "RTK, antenna three metres ahead, told": Situation(
        partial(RTK_TOWN, vehicle=Vehicle(antenna=TRUCK)), (Window(60.0, 240.0, 0.6),)
    ),
    "RTK, three metres ahead, not told": Situation(
        partial(told, (0.0, 0.0, 0.0), partial(RTK_TOWN, vehicle=Vehicle(antenna=TRUCK))),
        (Window(60.0, 240.0, 3.6),),
    ),
    "RTK, three metres ahead, told as behind": Situation(
        partial(told, (-3.2, -0.8, -1.6), partial(RTK_TOWN, vehicle=Vehicle(antenna=TRUCK))),
        (Window(60.0, 240.0, 7.0),),
    ),
    "one direction, single-point fixes": Situation(
        partial(driven, "highway", 240.0, 25), (Window(60.0, 240.0, 5.0),)
    ),
    "stamped when bytes arrive": Situation(
        partial(spoilt, "stamps-jitter", 0.15, 0.0, END, RTK_TOWN), (Window(60.0, 240.0, 1.0),)
    ),
    "receiver's clock set right every 20 s": Situation(
        partial(sawtooth, RTK_TOWN), (Window(60.0, 240.0, 2.0),)
    ),
    "clocks part by 300 ppm": Situation(
        partial(spoilt, "clock-drifts", 300.0, 0.0, END, RTK_TOWN), (Window(60.0, 240.0, 1.0),)
    ),
    "stamps leap by 0.2 s": Situation(
        partial(spoilt, "clock-leaps", 0.2, 150.0, END, TOWN), (Window(60.0, 300.0, 6.0),)
    ),
    "over the date line": Situation(
        partial(wrapped, partial(driven, "highway", 240.0, 21, origin=FIJI, heading=80.0 * DEG)),
        (Window(60.0, 190.0, 5.0), Window(190.0, 220.0, 20.0)),
        (190.0, 220.0),
    ),
    "far south and west": Situation(
        partial(driven, "highway", 240.0, 21, origin=PATAGONIA, heading=200.0 * DEG),
        (Window(60.0, 190.0, 5.0), Window(190.0, 220.0, 20.0)),
        (190.0, 220.0),
    ),
}  # fmt: skip
"""By what happened."""


def seen(situation: Situation, system: str = "constraints") -> list[Seen]:
    """A situation, navigated and held against its truth.

    Parameters
    ----------
    situation : Situation
    system : str

    Returns
    -------
    list of Seen
        In the order of its windows.
    """
    log = situation.drive()
    assert log.reference is not None
    outages = [] if situation.outage is None else [Outage(*(t - log.start for t in situation.outage))]
    recipe = changed(named(system), dict(situation.keys), "situations")
    errors = solution_errors(fuse(log, recipe, outages).trajectory, log.reference)
    found = []
    for window in situation.windows:
        one = errors.take((errors.time >= window.start) & (errors.time < window.end))
        radius = float(np.median(one.bound()))
        found.append(Seen(window, float(one.horizontal.max()), radius, float(within(one).mean())))
    return found


def rows(names: list[str], system: str) -> Iterator[str]:
    """A table in markdown."""
    yield "| situation | window, s | largest error, m | stated, m | inside, % | held to | |"
    yield "|---|---|---|---|---|---|---|"
    for name in names:
        for one in seen(SITUATIONS[name], system):
            w = one.window
            yield (
                f"| {name} | {w.start:.0f}-{w.end:.0f} | {one.largest:.2g} | {one.stated:.2g} "
                f"| {100.0 * one.share:.0f} | {w.metres:g} m, {100.0 * w.share:.0f} % "
                f"| {'' if one.holds else 'no'} |"
            )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("names", nargs="*", help="all if not given")
    parser.add_argument("--system", default="auto")
    given = parser.parse_args()
    if unknown := [n for n in given.names if n not in SITUATIONS]:
        raise SystemExit(f"no situation {', '.join(unknown)}; there are: {'; '.join(SITUATIONS)}")
    for row in rows(given.names or list(SITUATIONS), given.system):
        print(row, flush=True)


if __name__ == "__main__":
    main()
