"""What states and innovation channels are called, their axes, and the unit people read them in."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
    "odometer_offset": Quantity("Odometer offset", "m/s", 1.0, ("forward",)),
}
"""Blocks of the error-state layout."""

_RATE = Quantity("Zero angular rate", "deg/s", DEG, _BODY)
CHANNELS = {
    "position": (Quantity("Position", "m", 1.0, _NED),),
    "velocity": (Quantity("Velocity", "m/s", 1.0, _NED),),
    "nonholonomic": (Quantity("Non-holonomic", "m/s", 1.0, ("right", "down")),),
    "zero_velocity": (Quantity("Zero velocity", "m/s", 1.0, _NED), _RATE),
    "zero_rate": (_RATE,),
    "odometer": (Quantity("Odometer", "m/s", 1.0, ("forward",)),),
    "heading": (Quantity("Heading", "deg", DEG, ("heading",)),),
}
"""Kinds of observation; one that mixes units is shown in parts."""


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
    found = STATES.get(name, Quantity(_words(name), "", 1.0, ()))
    return found if len(found.axes) == size else replace(found, axes=_numbered(size))


def channel(name: str, size: int) -> tuple[Quantity, ...]:
    """How the innovations of a channel are shown.

    Parameters
    ----------
    name : str
        Of the channel; an unknown one is shown as it is.
    size : int
        Number of components.

    Returns
    -------
    tuple of Quantity
        In the order of the components; `size` axes altogether, or those of the first part alone.
    """
    parts = CHANNELS.get(name, (Quantity(_words(name), "", 1.0, _numbered(size)),))
    if sum(len(part.axes) for part in parts) == size:
        return parts
    first = parts[0]
    return (first if len(first.axes) == size else replace(first, axes=_numbered(size)),)


def _numbered(size: int) -> tuple[str, ...]:
    return tuple(str(k + 1) for k in range(size))


def _words(name: str) -> str:
    return name.replace("_", " ").capitalize()
