"""What an IMU is good for: its error budget in SI units, read from data that name their source."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from importlib.resources import files
from typing import Any, Final

from gapless.errors import ConfigError
from gapless.units import DEG, DEG_PER_HOUR, DEG_PER_ROOT_HOUR, MICRO_G, MILLI_G, PPM


@dataclass(frozen=True)
class Grade:
    """Error budget of one class of IMU; standard deviations are one sigma per axis.

    Parameters
    ----------
    name : str
    source : str
        Datasheet or paper, and what was chosen where it is silent.
    rate : float
        Nominal sample rate [Hz].
    gyro_noise, accel_noise : float
        White noise: angular random walk [rad/sqrt(s)], velocity random walk [m/s/sqrt(s)].
    gyro_bias_sd, accel_bias_sd : float
        Turn-on bias, constant through a run [rad/s], [m/s^2].
    gyro_instability, accel_instability : float
        In-run bias variation, a first-order Gauss-Markov process [rad/s], [m/s^2].
    gyro_instability_tau, accel_instability_tau : float
        Its correlation time [s].
    gyro_walk, accel_walk : float
        Random walk of the bias [rad/s/sqrt(s)], [m/s^2/sqrt(s)].
    gyro_scale_sd, accel_scale_sd : float
        Scale-factor error.
    misalignment_sd : float
        Each of the six angles between the sensitive axes and the box's [rad].
    gyro_quantum, accel_quantum : float
        Least step of an increment [rad], [m/s]; 0 for none.
    gyro_vibration, accel_vibration : float
        RMS of the vibration at `VIBRATION_SPEED` [rad/s], [m/s^2].
    """

    name: str
    source: str
    rate: float
    gyro_noise: float = 0.0
    accel_noise: float = 0.0
    gyro_bias_sd: float = 0.0
    accel_bias_sd: float = 0.0
    gyro_instability: float = 0.0
    accel_instability: float = 0.0
    gyro_instability_tau: float = 300.0
    accel_instability_tau: float = 300.0
    gyro_walk: float = 0.0
    accel_walk: float = 0.0
    gyro_scale_sd: float = 0.0
    accel_scale_sd: float = 0.0
    misalignment_sd: float = 0.0
    gyro_quantum: float = 0.0
    accel_quantum: float = 0.0
    gyro_vibration: float = 0.0
    accel_vibration: float = 0.0


_ANGULAR: Final = {"deg/s": DEG, "deg/h": DEG_PER_HOUR, "rad/s": 1.0}
_LINEAR: Final = {"g": 1e3 * MILLI_G, "mg": MILLI_G, "ug": MICRO_G, "m/s^2": 1.0}
_RATIO: Final = {"%": 0.01, "ppm": PPM}
_UNITS: Final[dict[str, dict[str, float]]] = {
    "rate": {"Hz": 1.0},
    "gyro_noise": {"deg/s/sqrt(Hz)": DEG, "deg/sqrt(h)": DEG_PER_ROOT_HOUR, "rad/sqrt(s)": 1.0},
    "accel_noise": {
        "mg/sqrt(Hz)": MILLI_G,
        "ug/sqrt(Hz)": MICRO_G,
        "m/s/sqrt(h)": 1.0 / 60.0,
        "m/s/sqrt(s)": 1.0,
    },
    "gyro_bias_sd": _ANGULAR,
    "accel_bias_sd": _LINEAR,
    "gyro_instability": _ANGULAR,
    "accel_instability": _LINEAR,
    "gyro_instability_tau": {"s": 1.0},
    "accel_instability_tau": {"s": 1.0},
    "gyro_walk": {"deg/h/sqrt(h)": DEG_PER_HOUR / 60.0, "rad/s/sqrt(s)": 1.0},
    "accel_walk": {"mg/sqrt(h)": MILLI_G / 60.0, "m/s^2/sqrt(s)": 1.0},
    "gyro_scale_sd": _RATIO,
    "accel_scale_sd": _RATIO,
    "misalignment_sd": {"deg": DEG, "mrad": 1e-3, "%": 0.01},
    "gyro_quantum": {"arcsec": DEG / 3600.0, "deg": DEG, "urad": 1e-6},
    "accel_quantum": {"mm/s": 1e-3, "m/s": 1.0},
    "gyro_vibration": _ANGULAR,
    "accel_vibration": _LINEAR,
}
"""Units that each field of a grade may be given in, and their size in SI."""


def parse_grade(name: str, table: Mapping[str, Any]) -> Grade:
    """A grade from text as it stands in a datasheet.

    Parameters
    ----------
    name : str
    table : mapping of str to str
        Fields of `Grade`, each a number and a unit such as "0.3 deg/sqrt(h)"; `source` and `rate`
        are required.

    Returns
    -------
    Grade

    Raises
    ------
    ConfigError
        If a key or a unit is unknown, a number negative, or a required key missing.
    """
    values: dict[str, Any] = {}
    for key, text in table.items():
        values[key] = str(text) if key == "source" else _quantity(f"grade {name}: {key}", key, str(text))
    missing = [f.name for f in fields(Grade)[1:3] if f.name not in values]
    if missing:
        raise ConfigError(f"grade {name}: {' and '.join(missing)} missing; add it")
    return Grade(name, **values)


def _quantity(where: str, key: str, text: str) -> float:
    if key not in _UNITS:
        raise ConfigError(f"{where}: no such field; the fields are source, {', '.join(_UNITS)}")
    number, _, unit = text.strip().partition(" ")
    try:
        value = float(number) * _UNITS[key][unit.strip()]
    except (ValueError, KeyError):
        units = ", ".join(_UNITS[key])
        raise ConfigError(f"{where}: cannot read {text!r}; write a number and one of {units}") from None
    if not 0.0 <= value < float("inf"):
        raise ConfigError(f"{where}: {text!r} is out of range; give a finite number, not negative")
    return value


@cache
def _grades() -> dict[str, Grade]:
    text = files("gapless.sensors").joinpath("grades.toml").read_text(encoding="utf-8")
    return {name: parse_grade(name, table) for name, table in tomllib.loads(text).items()}


def grade_names() -> tuple[str, ...]:
    """Names that `grade` knows.

    Returns
    -------
    tuple of str
    """
    return tuple(_grades())


def grade(name: str) -> Grade:
    """A named grade.

    Parameters
    ----------
    name : str
        One of `grade_names()`.

    Returns
    -------
    Grade

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    if name not in _grades():
        raise ConfigError(f"no sensor grade {name!r}; the grades are {', '.join(grade_names())}")
    return _grades()[name]
