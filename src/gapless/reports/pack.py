"""Columns of numbers as short text: what a page embeds instead of arrays of decimal digits."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

import numpy as np

from gapless.trip.recording import Array

_LARGEST = 60000.0
"""Of half precision's 65504, with room for rounding."""


def packed(values: Array) -> dict[str, Any]:
    """Numbers in half precision about their middle: eleven bits of the distance from it.

    A chart is some hundred pixels high, so an error of 1/2048 of the distance from the median is less
    than a pixel, wherever in the column the value lies and however far its outliers reach.

    Parameters
    ----------
    values : ndarray, shape (n,)
        NaN where unknown.

    Returns
    -------
    dict
        `d`, base64 of little-endian IEEE 754 halves; a value is `o` + `s` times its half.
    """
    known = np.isfinite(values)
    offset = float(np.median(values[known])) if known.any() else 0.0
    away = np.where(known, values, np.nan) - offset
    reach = float(np.abs(away[known]).max()) if known.any() else 0.0
    scale = 2.0 ** np.ceil(np.log2(reach / _LARGEST)) if reach > 0.0 else 1.0
    return {"o": offset, "s": float(scale), "d": _text((away / scale).astype("<f2"))}


def packed_errors(values: Array) -> str:
    """Numbers in half precision as they are: eleven bits, none beyond 60,000.

    Parameters
    ----------
    values : ndarray, shape (n,)
        NaN where unknown.

    Returns
    -------
    str
        Base64.
    """
    return _text(np.clip(values, -_LARGEST, _LARGEST).astype("<f2"))


def packed_times(seconds: Array) -> str:
    """Times to the millisecond.

    Parameters
    ----------
    seconds : ndarray, shape (n,)
        Below 24 days.

    Returns
    -------
    str
        Base64 of little-endian 32-bit milliseconds.
    """
    return _text(np.round(1000.0 * seconds).astype("<i4"))


def rounded(values: Array, decimals: int) -> list[float | None]:
    """A list for JSON.

    Parameters
    ----------
    values : ndarray, shape (n,)
    decimals : int

    Returns
    -------
    list
        None where a value is not finite.
    """
    known = np.isfinite(values)
    short = np.round(np.where(known, values, 0.0), decimals).tolist()
    return [value if ok else None for value, ok in zip(short, known.tolist(), strict=True)]


def _text(values: Any) -> str:
    return b64encode(values.tobytes()).decode("ascii")
