"""The recipe of a system: what a TOML file may say, with its defaults and its checks.

Angles are in degrees and everything else in SI units, as a user writes them.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, get_args

import msgspec
from msgspec import Meta, Struct
from msgspec.structs import fields

from gapless.errors import ConfigError
from gapless.filters.adaptation.registry import KINDS, RULES, check
from gapless.inertial.layout import EXTRAS

T = TypeVar("T", bound=Struct)
Positive = Annotated[float, Meta(gt=0.0)]
NonNegative = Annotated[float, Meta(ge=0.0)]
Angle = Annotated[float, Meta(ge=-180.0, le=360.0)]
Auto = Literal["auto"]
Offset = Annotated[float, Meta(ge=-10.0, le=10.0)] | Auto


class Imu(Struct, forbid_unknown_fields=True, frozen=True):
    """Process noise and turn-on errors; `grade` names a sensor and replaces them all.

    Densities are per axis: degrees and m/s per root second; random walks of the biases in
    deg/s and m/s^2 per root second; `turn` is the share of a turn that goes wrong; `vibration` is
    the share of the log's own high-frequency gyro density that is added to `gyro_noise`;
    `misalignment` is how far the box's axes may be from the sensors' (deg).
    """

    grade: str = ""
    gyro_noise: Positive = 0.025
    vibration: NonNegative = 0.25
    accel_noise: Positive = 0.02
    gyro_walk: NonNegative = 0.0003
    accel_walk: NonNegative = 0.0012
    turn: NonNegative = 0.0012
    gyro_bias_sd: Positive = 0.3
    accel_bias_sd: Positive = 0.4
    misalignment: NonNegative = 0.3
    gyro_scale_sd: NonNegative = 0.008
    accel_scale_sd: NonNegative = 0.005
    gravity_sd: NonNegative = 5e-4


class Filter(Struct, forbid_unknown_fields=True, frozen=True):
    """States beyond the fifteen, the correction's way, how moments pass, and how often things are done."""

    states: tuple[str, ...] = ("gyro_scale",)
    correction: Literal["feedback", "feedforward"] = "feedback"
    moments: Literal["taylor", "cubature"] = "taylor"
    covariance_period: Annotated[float, Meta(ge=0.0, le=0.1)] = 0.05
    tick: Annotated[float, Meta(ge=0.05, le=1.0)] = 0.1


class GnssUse(Struct, forbid_unknown_fields=True, frozen=True):
    """How far the receiver's own standard deviations are believed; correlation times of its errors.

    `wander` is the share of a position's standard deviation that is not noise but lasts for about
    `wander_time` [s]; it widens what is stated, not what is weighed. `velocity_averaging` is the
    length of the epoch that a velocity is the mean of [s], 0 for an instant; the clock offset stays
    the equivalent instantaneous one. `jitter` is how uneven stamps are [s].
    """

    wander: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.6
    wander_time: Positive = 60.0
    position_floor: NonNegative = 0.02
    velocity_floor: NonNegative = 0.1
    position_correlation: NonNegative = 0.25
    velocity_correlation: NonNegative = 0.6
    velocity_averaging: NonNegative = 0.0
    jitter: NonNegative = 0.02
    lever_arm: tuple[float, float, float] | None = None


if TYPE_CHECKING:
    _Rules = Struct
else:  # a table for each rule, so that a rule needs no line here
    _Rules = msgspec.defstruct("_Rules", [(name, rule.Table, rule.Table()) for name, rule in RULES.items()])


class Adaptation(_Rules, forbid_unknown_fields=True, frozen=True):
    """Rules that bend R or P, in order, by kind of observation; then a table for each rule."""

    gnss: tuple[str, ...] = ("gate",)
    bridge: tuple[str, ...] = ("gate",)
    constraints: tuple[str, ...] = ("gate",)


class Nonholonomic(Struct, forbid_unknown_fields=True, frozen=True):
    """No slip sideways or upwards at the rear axle."""

    lateral: Positive = 0.06
    vertical: Positive = 0.6
    turn: NonNegative = 0.1
    min_speed: Positive = 1.0
    interval: Positive = 0.12
    axle: float = -1.0
    axle_sd: NonNegative = 0.17


class ZeroVelocity(Struct, forbid_unknown_fields=True, frozen=True):
    """Standing still: velocity and angular rate (deg/s) are zero."""

    sd: Positive = 0.125
    rate_sd: Positive = 0.125
    odds: Positive = 4.5
    hold: NonNegative = 1.5


class OdometerUse(Struct, forbid_unknown_fields=True, frozen=True):
    """Wheel speed and its scale error."""

    sd: Positive = 0.2
    correlation: NonNegative = 0.5
    jitter: NonNegative = 0.2
    scale_sd: NonNegative = 0.03


class Clock(Struct, forbid_unknown_fields=True, frozen=True):
    """What must be added to a sensor's stamps to land on the IMU clock [s]; "auto" finds it."""

    position: Offset = "auto"
    velocity: Offset = "auto"
    odometer: Offset = "auto"


class Mounting(Struct, forbid_unknown_fields=True, frozen=True):
    """Pitch and yaw of the car's forward axis in the box; "auto" finds them."""

    pitch: Angle | Auto = "auto"
    yaw: Angle | Auto = "auto"
    pitch_sd: NonNegative = 8.0
    yaw_sd: NonNegative = 8.0


class Alignment(Struct, forbid_unknown_fields=True, frozen=True):
    """Initial attitude: heading from GNSS course, levelling over a window."""

    min_speed: Positive = 5.0
    window: Positive = 4.0
    tilt_sd: Positive = 4.0


class System(Struct, forbid_unknown_fields=True, frozen=True):
    """A whole system; every table and every key is optional."""

    name: str = "constraints"
    description: str = ""
    sensors: tuple[Literal["position", "velocity", "odometer"], ...] = ("position", "velocity", "odometer")
    constraints: tuple[Literal["zero_velocity", "nonholonomic"], ...] = ("zero_velocity", "nonholonomic")
    imu: Imu = Imu()
    filter: Filter = Filter()
    adaptation: Adaptation = Adaptation()
    gnss: GnssUse = GnssUse()
    nonholonomic: Nonholonomic = Nonholonomic()
    zero_velocity: ZeroVelocity = ZeroVelocity()
    odometer: OdometerUse = OdometerUse()
    clock: Clock = Clock()
    mounting: Mounting = Mounting()
    alignment: Alignment = Alignment()


def parse(text: str, where: str) -> System:
    """A system from the text of a TOML file.

    Parameters
    ----------
    text : str
    where : str
        What to call it in an error.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    return checked(loads(text, where), where)


def loads(text: str, where: str) -> dict[str, Any]:
    """Tables of a TOML text.

    Parameters
    ----------
    text : str
    where : str
        What to call it in an error.

    Returns
    -------
    dict

    Raises
    ------
    ConfigError
        If it is not TOML.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{where}: not valid TOML: {error}") from None


def checked(tables: Mapping[str, Any], where: str) -> System:
    """A system from the tables of its TOML.

    Parameters
    ----------
    tables : mapping
    where : str
        What to call it in an error.

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    system = typed(tables, System, where)
    unknown = [name for name in system.filter.states if name not in EXTRAS]
    if len(set(system.filter.states)) < len(system.filter.states):
        raise ConfigError(f"{where}: filter.states names a block twice; name each once")
    if unknown:
        raise ConfigError(f"{where}: filter.states has {unknown[0]!r}; choose from {', '.join(EXTRAS)}")
    if system.filter.moments == "cubature" and system.filter.correction == "feedforward":
        raise ConfigError(
            f"{where}: filter.moments = 'cubature' needs filter.correction = 'feedback': "
            "its points surround a nominal state that is corrected"
        )
    for kind in KINDS:
        try:
            check(kind, getattr(system.adaptation, kind))
        except ConfigError as error:
            raise ConfigError(f"{where}: {error}") from None
    return system


def typed(tables: Mapping[str, Any], kind: type[T], where: str) -> T:
    """Tables of a TOML file as the struct that they should be.

    Parameters
    ----------
    tables : mapping
    kind : type of msgspec.Struct
    where : str
        What to call the file in an error.

    Returns
    -------
    msgspec.Struct
        Of that kind.

    Raises
    ------
    ConfigError
        With the path of the key and the valid choices.
    """
    try:
        return msgspec.convert(tables, kind)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{where}: {_explain(str(error), kind)}") from None


def _explain(message: str, kind: type[Struct]) -> str:
    """Msgspec's message with a dotted path, and the keys that there are where one is unknown."""
    text, _, place = message.partition(" - at `")
    path = place.rstrip("`").removeprefix("$").lstrip(".")
    if "unknown field" in text:
        for part in re.findall(r"\w+", re.sub(r"\[.*?\]", "", path)):
            kind = next((_struct(f.type) or kind for f in fields(kind) if f.encode_name == part), kind)
        return f"{text} in {path or 'the top table'}; it may hold: {', '.join(kind.__struct_fields__)}"
    return f"{path}: {text}" if path else text


def _struct(kind: Any) -> type[Struct] | None:
    """The struct in a type such as `Struct | tuple[Struct, ...] | None`."""
    if isinstance(kind, type) and issubclass(kind, Struct):
        return kind
    return next((found for part in get_args(kind) if (found := _struct(part))), None)


def load(name: str | Path) -> System:
    """A system by its built-in name or from a TOML file.

    Parameters
    ----------
    name : str or Path

    Returns
    -------
    System

    Raises
    ------
    ConfigError
        If there is neither, or the file is wrong.
    """
    path = Path(name)
    if path.suffix == ".toml":
        try:
            return parse(path.read_text(encoding="utf-8"), str(path))
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: cannot be read ({error}); give a TOML file") from None
    found = files("gapless.systems").joinpath(f"{name}.toml")
    if not found.is_file():
        raise ConfigError(
            f"system {name!r} is unknown; choose from {', '.join(names())} or give a .toml file"
        )
    return parse(found.read_text(encoding="utf-8"), f"{name}.toml")


def names() -> list[str]:
    """Names of the built-in systems.

    Returns
    -------
    list of str
    """
    folder = files("gapless.systems").iterdir()
    return sorted(entry.name.removesuffix(".toml") for entry in folder if entry.name.endswith(".toml"))
