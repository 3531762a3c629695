"""Bridges: sensors that learn while GNSS speaks and speak while it is silent; one kind a file."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from gapless.bridges.wheels import Wheels

if TYPE_CHECKING:
    from gapless.bridges.base import Bridge

BRIDGES: Final[dict[str, Callable[..., Bridge]]] = {"wheels": Wheels}
"""Bridges by the names that recipes call them by, your own among them: ``BRIDGES["mine"] = Mine``.

Each is called with the sensors by channel (mapping of str to `Sensor`), and the recipe's
`bridge.parameters` by name.
"""
