"""Numbers as people read them, and as JSON takes them."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

DASH = "\u2013"
_MINUS = "\u2212"


def plain(value: Any) -> Any:
    """What JSON can say of a value: dataclasses as objects, arrays as lists, NaN and infinity as null.

    Parameters
    ----------
    value : object
        Made of dataclasses, mappings, sequences, NumPy arrays, numbers and strings.

    Returns
    -------
    object
        Made of dict, list, str, int, float, bool and None.
    """
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, dict):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value


def known(value: float | None) -> float:
    """What JSON's null stands for.

    Parameters
    ----------
    value : float, optional

    Returns
    -------
    float
        NaN for None.
    """
    return math.nan if value is None else value


def number(value: float, unit: str = "", digits: int = 3) -> str:
    """A number to so many significant digits, whole ones kept, with its unit.

    Parameters
    ----------
    value : float
    unit : str
        Put behind a space that does not break; "%" too.
    digits : int
        Significant digits.

    Returns
    -------
    str
        A dash where the value is not finite.
    """
    if not math.isfinite(value):
        return DASH
    shown = abs(float(f"{value:.{digits - 1}e}"))
    decimals = digits - 1 - math.floor(math.log10(shown)) if shown >= 1e-9 else 0
    return _signed(value, min(max(decimals, 0), 9)) + (f"\u00a0{unit}" if unit else "")


def compact(value: float, unit: str = "") -> str:
    """A number to at most four significant digits, without trailing zeros, with its unit.

    Parameters
    ----------
    value : float
    unit : str

    Returns
    -------
    str
        For a setting rather than a measurement: "0.05 m".
    """
    text = number(value, "", 4)
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return text + (f"\u00a0{unit}" if unit else "")


def measured(value: float, sd: float | None, unit: str = "") -> str:
    """A number with its standard deviation, both to two digits of the latter.

    Parameters
    ----------
    value : float
    sd : float, optional
    unit : str

    Returns
    -------
    str
        For instance "−0.152 ± 0.012 s".
    """
    if sd is None or not math.isfinite(sd) or sd <= 0.0 or not math.isfinite(value):
        return compact(value, unit)
    decimals = min(max(1 - math.floor(math.log10(sd)), 0), 9)
    text = f"{_signed(value, decimals)} ± {sd:.{decimals}f}"
    return text + (f"\u00a0{unit}" if unit else "")


def duration(seconds: float) -> str:
    """A duration in hours, minutes and seconds.

    Parameters
    ----------
    seconds : float

    Returns
    -------
    str
        For instance "1 h 02 min" or "14 min 27 s".
    """
    if not math.isfinite(seconds):
        return DASH
    whole = round(seconds)
    if whole < 60:
        return f"{whole}\u00a0s"
    if whole < 3600:
        return f"{whole // 60}\u00a0min {whole % 60:02d}\u00a0s"
    return f"{whole // 3600}\u00a0h {whole % 3600 // 60:02d}\u00a0min"


def distance(metres: float) -> str:
    """A distance in metres or kilometres.

    Parameters
    ----------
    metres : float

    Returns
    -------
    str
        For instance "812 m" or "5.02 km".
    """
    return number(metres, "m") if abs(metres) < 999.5 else number(metres / 1000.0, "km")


def percent(share: float) -> str:
    """A share in percent, to the tenth.

    Parameters
    ----------
    share : float
        Between 0 and 1.

    Returns
    -------
    str
    """
    return f"{100.0 * share:.1f}\u00a0%" if math.isfinite(share) else DASH


def _signed(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace("-", _MINUS)
