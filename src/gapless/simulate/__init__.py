"""Simulated recordings: an analytic path, its exact IMU, and what sensors make of it.

Nothing here imports `gapless.inertial`: it is what the mechanisation is tested against.
"""

from gapless.simulate.drive import drive, simulate
from gapless.simulate.motion import Vehicle, increments, point, rates, trajectory
from gapless.simulate.path import Path, Segment
from gapless.simulate.profiles import PROFILES, profile
from gapless.simulate.receivers import Receiver, WheelSensor, fixes, odometer, spikes, withhold

__all__ = [
    "PROFILES",
    "Path",
    "Receiver",
    "Segment",
    "Vehicle",
    "WheelSensor",
    "drive",
    "fixes",
    "increments",
    "odometer",
    "point",
    "profile",
    "rates",
    "simulate",
    "spikes",
    "trajectory",
    "withhold",
]
