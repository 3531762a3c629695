"""Kinds of values that a recipe holds."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

Positive = Annotated[float, Meta(gt=0.0)]
NonNegative = Annotated[float, Meta(ge=0.0)]
Angle = Annotated[float, Meta(ge=-180.0, le=360.0)]
Auto = Literal["auto"]
Offset = Annotated[float, Meta(ge=-10.0, le=10.0)] | Auto
Count = Annotated[int, Meta(ge=1)]
WholeNumber = Annotated[int, Meta(ge=0)]
