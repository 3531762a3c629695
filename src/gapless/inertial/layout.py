"""The one error-state layout: which error sits where, and what it does to the nominal state.

The truth is `estimate (+) error`: position errors in north, east, down metres, velocity errors in
m/s, attitude errors as a rotation vector phi in the navigation frame, C_true = exp(phi x) C_est;
every further error is additive. The first fifteen are always there; `EXTRAS` are switched on by
name and cost nothing when off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

CORE: Final = {"position": 3, "velocity": 3, "attitude": 3, "gyro_bias": 3, "accel_bias": 3}
EXTRAS: Final = {
    "gyro_scale": 3,  # 1; omega = (1 + s) omega_measured - b
    "accel_scale": 3,  # 1; f = (1 + s) f_measured - b
    "gravity": 3,  # m/s^2, NED disturbance of normal gravity
    "lever_arm": 3,  # m, FRD, antenna from the IMU
    "mounting": 2,  # rad, pitch and yaw of the car's forward axis in the box
    "axle": 1,  # m, forward coordinate of the point that does not slip sideways
    "odometer_scale": 1,  # 1; true speed = reading * (1 + s) + o, of wheels that roll
    "odometer_offset": 1,  # m/s
}
"""Optional blocks, their size, and their unit."""
NAV: Final = 9
"""Position, velocity, attitude: the rows of Phi that are more than a diagonal."""
N_CORE: Final = 15
LANES: Final = 8
"""A kernel runs over this many columns of a covariance at once."""
ROW: Final = 32
"""Length of a stored covariance row: all blocks fit, and a compiler knows it."""


@dataclass(frozen=True)
class Layout:
    """Where each block of the error state sits.

    Parameters
    ----------
    extras : tuple of str
        Names from `EXTRAS`, each once.

    Raises
    ------
    ValueError
        If a name is unknown or repeated.
    """

    extras: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [name for name in self.extras if name not in EXTRAS]
        if unknown or len(set(self.extras)) != len(self.extras):
            raise ValueError(f"state blocks {self.extras}: choose each once from {', '.join(EXTRAS)}")

    @cached_property
    def blocks(self) -> dict[str, slice]:
        """Slice of each block in the error state."""
        sizes = CORE | {name: EXTRAS[name] for name in self.extras}
        ends = np.cumsum(list(sizes.values())).tolist()
        return {name: slice(end - size, end) for (name, size), end in zip(sizes.items(), ends, strict=True)}

    @cached_property
    def n(self) -> int:
        """Number of error states."""
        return int(max(block.stop for block in self.blocks.values()))

    @property
    def width(self) -> int:
        """`n` rounded up to whole vectors."""
        return -(-self.n // LANES) * LANES

    @cached_property
    def offsets(self) -> NDArray[np.int64]:
        """First index of each block of `EXTRAS`, in their order there; -1 where it is off."""
        return np.array([self.blocks[name].start if name in self.blocks else -1 for name in EXTRAS])

    def __contains__(self, name: str) -> bool:
        return name in self.blocks
