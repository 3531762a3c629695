"""Simulated recordings: an analytic path, its exact IMU, and what sensors make of it.

Nothing here imports `gapless.inertial`: it is what the mechanisation is tested against.
"""

from gapless.simulate.chassis import CAR, Chassis, Engine, Gear, Road, Slip, WheelComb
from gapless.simulate.drive import drive, simulate
from gapless.simulate.harmonics import MOTOR, TYRE, Growth, Harmonic
from gapless.simulate.motion import Vehicle, increments, point, rates, trajectory
from gapless.simulate.path import Path, Segment
from gapless.simulate.profiles import PROFILES, profile
from gapless.simulate.receivers import Receiver, WheelSensor, fixes, odometer, spikes, withhold
from gapless.simulate.vibration import speed_bound, vibrate

__all__ = [
    "CAR",
    "MOTOR",
    "PROFILES",
    "TYRE",
    "Chassis",
    "Engine",
    "Gear",
    "Growth",
    "Harmonic",
    "Path",
    "Receiver",
    "Road",
    "Segment",
    "Slip",
    "Vehicle",
    "WheelComb",
    "WheelSensor",
    "drive",
    "fixes",
    "increments",
    "odometer",
    "point",
    "profile",
    "rates",
    "simulate",
    "speed_bound",
    "spikes",
    "trajectory",
    "vibrate",
    "withhold",
]
