"""Conversion factors: multiply by one to come in (to SI and radians), divide to go out."""

from __future__ import annotations

import math
from typing import Final

DEG: Final = math.pi / 180.0
"""rad per degree."""
DEG_PER_HOUR: Final = DEG / 3600.0
"""rad/s per degree per hour (gyro bias)."""
DEG_PER_ROOT_HOUR: Final = DEG / 60.0
"""rad/sqrt(s) per degree per root hour (angle random walk)."""
MILLI_G: Final = 9.80665e-3
"""m/s^2 per milli-g (accelerometer bias)."""
MICRO_G: Final = 9.80665e-6
"""m/s^2 per micro-g (accelerometer noise density, per root hertz)."""
PPM: Final = 1e-6
"""1 per part per million (scale factor)."""
