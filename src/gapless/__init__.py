"""GNSS/INS fusion that keeps navigating when GNSS goes silent.

    import gapless as gp

    recording = gp.read("drive")
    solution = gp.fuse(recording, outages=gp.plan(["240:300"], recording.duration))
    frame = gp.to_pandas(solution)

This page is the contract: everything in the package keeps to it.

Frames
------
====  =====================================================================================
`n`   navigation: north, east, down at the IMU; what is "level" and "heading"
`b`   body: forward, right, down (FRD) along the IMU's box, as the recording declares its axes
`v`   vehicle: forward, right, down along the car; the box sits in it at the mounting angles
`e`   earth: WGS-84, earth-centred, earth-fixed
`i`   inertial
====  =====================================================================================

Names
-----
`v_n` is a velocity in n, `C_nb` a matrix that turns b vectors into n vectors, `q_nb` its
quaternion (w, x, y, z), `lla` latitude, longitude, height, `euler` roll, pitch, heading of the ZYX
sequence. In equations P is the covariance, H, R, K, S the measurement's matrices, z an innovation
(observed minus predicted). A name that begins with `sd` is one standard deviation.

Units
-----
SI and radians in every array; degrees in files, on the command line, in recipes and in reports,
and there only. Longitudes lie in [-pi, pi), heights are above the ellipsoid. A specific force at rest
points up: (0, 0, -g) in FRD. Positions are those of the IMU, attitudes those of its box, unless
something else is said; a lever arm goes from the IMU to the antenna, in b.

Clocks
------
Time is float seconds on the recording's IMU clock, whose origin is the log's own. An IMU stamp ends
the interval that its increments cover. Stamps of other sensors are kept as logged; a clock offset is
what must be *added* to them to land on the IMU clock, so that a sensor whose stamps are late has a
negative one. Offsets of position and velocity are separate: a velocity that is a mean over the last
epoch is as good as an instantaneous one of half an epoch earlier. Outages are counted in seconds
from the first IMU sample, and withhold fixes by their logged stamps.

Errors
------
The truth is the estimate (+) the error: position errors in metres north, east, down; velocity errors
in n; attitude errors a rotation vector phi in n, C_true = exp(phi x) C_estimate; every other error is
simply added. `gapless.inertial.layout` lists the states. A solution's standard deviations are those
of roll, pitch and heading themselves, not of phi.

What goes wrong by the user's hand raises a `GaplessError`, one line that says what, where and what
next; the command line prints it and ends with code 2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from gapless.version import __version__ as __version__

if TYPE_CHECKING:
    from gapless.errors import AlignmentError, ConfigError, GaplessError, RecordingError
    from gapless.evaluation import score
    from gapless.io import read, recording_from_frames, to_pandas, write, write_recording
    from gapless.reports import summarise, write_report
    from gapless.runs.fuse import fuse
    from gapless.runs.smooth import smooth
    from gapless.runs.vehicle import vehicle_attitude
    from gapless.scenarios import Outage, plan
    from gapless.simulate import simulate as simulate_drive
    from gapless.sweeps.conduct import sweep
    from gapless.sweeps.store import read as read_sweep
    from gapless.systems.library import load as load_system
    from gapless.systems.recipe import System
    from gapless.trip.recording import Gnss, Imu, Odometer, Recording, Trajectory
    from gapless.trip.solution import Decision, Solution

__all__ = [
    "AlignmentError",
    "ConfigError",
    "Decision",
    "GaplessError",
    "Gnss",
    "Imu",
    "Odometer",
    "Outage",
    "Recording",
    "RecordingError",
    "Solution",
    "System",
    "Trajectory",
    "fuse",
    "load_system",
    "plan",
    "read",
    "read_sweep",
    "recording_from_frames",
    "score",
    "simulate_drive",
    "smooth",
    "summarise",
    "sweep",
    "to_pandas",
    "vehicle_attitude",
    "write",
    "write_recording",
    "write_report",
]

_HOMES: Final = {
    "errors": ("AlignmentError", "ConfigError", "GaplessError", "RecordingError"),
    "evaluation": ("score",),
    "io": ("read", "recording_from_frames", "to_pandas", "write", "write_recording"),
    "trip.recording": ("Gnss", "Imu", "Odometer", "Recording", "Trajectory"),
    "reports": ("summarise", "write_report"),
    "scenarios": ("Outage", "plan"),
    "simulate": ("simulate_drive",),
    "trip.solution": ("Decision", "Solution"),
    "sweeps.conduct": ("sweep",),
    "sweeps.store": ("read_sweep",),
    "runs.fuse": ("fuse",),
    "systems.library": ("load_system",),
    "systems.recipe": ("System",),
    "runs.smooth": ("smooth",),
    "runs.vehicle": ("vehicle_attitude",),
}
"""Public names by the module that they come from; loaded when first asked for."""
_THERE: Final = {"simulate_drive": "simulate", "load_system": "load", "read_sweep": "read"}
"""Names that read differently at home."""


def __getattr__(name: str) -> Any:
    for home, names in _HOMES.items():
        if name in names:
            from importlib import import_module

            value = getattr(import_module(f"gapless.{home}"), _THERE.get(name, name))
            globals()[name] = value
            return value
    raise AttributeError(f"module 'gapless' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
