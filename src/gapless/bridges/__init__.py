"""Bridges: sensors that learn while GNSS speaks and speak while it is silent; one kind a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from gapless.bridges.base import Bridge
    from gapless.measurements.base import Sensor



def _wheels(sensors: Mapping[str, Sensor], **parameters: Any) -> Bridge:
    from gapless.bridges.wheels import Wheels

    return Wheels(**parameters)


BRIDGES: Final[dict[str, Callable[..., Bridge]]] = {"wheels": _wheels}
"""Bridges by the names that recipes call them by, your own among them: ``BRIDGES["mine"] = Mine``.

Each is called with the sensors by channel (mapping of str to `Sensor`), and the recipe's
`bridge.parameters` by name.
"""
