"""The recipe of a system: what a TOML file may say, and its defaults.

Angles are in degrees and everything else in SI units, as a user writes them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from gapless.filters.adaptation.registry import RULES
from gapless.systems.learning import BridgeUse, LearnerUse
from gapless.systems.values import Angle, Auto, NonNegative, Offset, Positive, WholeNumber


class Imu(Struct, forbid_unknown_fields=True, frozen=True):
    """Process noise and turn-on errors; `grade` names a sensor and replaces them all.

    Densities are per axis: degrees and m/s per root second; random walks of the biases in
    deg/s and m/s^2 per root second; `turn` is the share of a turn that goes wrong; `vibration` is
    the share of the log's own high-frequency gyro density that is added to `gyro_noise`;
    `misalignment` is how far the box's axes may be from the sensors' (deg).
    """

    grade: str = ""
    gyro_noise: Positive = 0.035
    vibration: NonNegative = 0.25
    accel_noise: Positive = 0.02
    gyro_walk: NonNegative = 0.0006
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
    the equivalent instantaneous one. `jitter` is how uneven stamps are [s]. `lever_arm_sd` is how far
    from the box an antenna may be, forward, right and down, where the filter looks for it [m].
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
    lever_arm_sd: tuple[Positive, Positive, Positive] = (1.5, 1.0, 1.5)


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
    """Wheel speed, its scale error and offset, its stamps, and how far the wheel is aside of the box."""

    sd: Positive = 0.2
    correlation: NonNegative = 0.5
    jitter: NonNegative = 0.2
    side: NonNegative = 0.5
    scale_sd: NonNegative = 0.03
    offset_sd: NonNegative = 0.1


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


class DenoiseUse(Struct, forbid_unknown_fields=True, frozen=True):
    """How inertial signals are denoised before anything else; without a method, they are not.

    `window` 0 denoises the whole record, which sees the future: for post-processing. Otherwise every
    sample knows of earlier ones only, through windows of so many samples, one every `step` samples.
    """

    method: str = "none"
    window: WholeNumber = 512
    step: WholeNumber = 128
    parameters: dict[str, Any] = {}


class RehearsalUse(Struct, forbid_unknown_fields=True, frozen=True):
    """Outages rehearsed in the good past, every so many seconds; 0 rehearses nothing and lets all speak.

    `others` names systems whose bridges may speak too, alone or with this one's, once they have earned
    it. `presets` names other tunings: keys of this recipe and their values. `budget` is how many samples
    may be replayed for each that comes in, besides eight trials at the start.
    """

    every: NonNegative = 0.0
    length: Annotated[float, Meta(ge=10.0)] = 60.0
    budget: Positive = 0.4
    others: tuple[str, ...] = ()
    presets: dict[str, dict[str, Any]] = {}


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
    denoise: DenoiseUse = DenoiseUse()
    bridge: BridgeUse = BridgeUse()
    learner: LearnerUse = LearnerUse()
    rehearsal: RehearsalUse = RehearsalUse()
