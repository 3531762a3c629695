"""What states and innovation channels are called, their axes, and the unit people read them in."""

from __future__ import annotations

from dataclasses import dataclass

from gapless.units import DEG, MILLI_G, PPM


@dataclass(frozen=True)
class Quantity:
    """How one block of numbers is shown.

    Parameters
    ----------
    label : str
        Title.
    unit : str
        "" where there is none.
    scale : float
        The unit in SI: divide by it to show.
    axes : tuple of str
        Names of the components.
    """

    label: str
    unit: str
    scale: float
    axes: tuple[str, ...]


_NED = ("north", "east", "down")
_BODY = ("forward", "right", "down")

STATES = {
    "gyro_bias": Quantity("Gyro bias", "deg/s", DEG, _BODY),
    "accel_bias": Quantity("Accelerometer bias", "m/s²", 1.0, _BODY),
    "gyro_scale": Quantity("Gyro scale factor", "ppm", PPM, _BODY),
    "accel_scale": Quantity("Accelerometer scale factor", "ppm", PPM, _BODY),
    "gravity": Quantity("Gravity disturbance", "mg", MILLI_G, _NED),
    "lever_arm": Quantity("Lever arm", "m", 1.0, _BODY),
    "mounting": Quantity("Mounting angles", "deg", DEG, ("pitch", "yaw")),
    "axle": Quantity("Axle ahead of the box", "m", 1.0, ("forward",)),
    "odometer_scale": Quantity("Odometer scale", "%", 0.01, ("scale",)),
}
"""Blocks of the error-state layout."""

CHANNELS = {
    "position": Quantity("Position", "m", 1.0, _NED),
    "velocity": Quantity("Velocity", "m/s", 1.0, _NED),
    "nonholonomic": Quantity("Non-holonomic", "m/s", 1.0, ("right", "down")),
    "zero_velocity": Quantity("Zero velocity", "m/s", 1.0, _NED),
    "zero_rate": Quantity("Zero angular rate", "deg/s", DEG, _BODY),
    "odometer": Quantity("Odometer", "m/s", 1.0, ("forward",)),
    "heading": Quantity("Heading", "deg", DEG, ("heading",)),
}
"""Kinds of observation."""


def state(name: str, size: int) -> Quantity:
    """How a block of states is shown.

    Parameters
    ----------
    name : str
        Of the block; an unknown one is shown as it is.
    size : int
        Number of components.

    Returns
    -------
    Quantity
        With exactly `size` axes.
    """
    return _fitted(STATES.get(name), name, size)


def channel(name: str, size: int) -> Quantity:
    """How the innovations of a channel are shown.

    Parameters
    ----------
    name : str
        Of the channel; an unknown one is shown as it is.
    size : int
        Number of components.

    Returns
    -------
    Quantity
        With exactly `size` axes.
    """
    return _fitted(CHANNELS.get(name), name, size)


def _fitted(known: Quantity | None, name: str, size: int) -> Quantity:
    found = known or Quantity(name.replace("_", " ").capitalize(), "", 1.0, ())
    axes = found.axes if len(found.axes) == size else tuple(str(k + 1) for k in range(size))
    return Quantity(found.label, found.unit, found.scale, axes)
