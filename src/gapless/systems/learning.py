"""The learned part of a recipe: which bridge, which learner, how unsure it is, and building it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

import numpy as np
from msgspec import Meta, Struct

from gapless.errors import ConfigError, MissingExtraError, ModelError, registered_elsewhere
from gapless.systems.values import Count, NonNegative, Positive, WholeNumber

if TYPE_CHECKING:
    from gapless.bridges.base import Bridge
    from gapless.bridges.model import Model
    from gapless.bridges.schedule import Trained
    from gapless.measurements.base import Sensor

MODELS: Final = ("error", "increment")
"""What a learner may be taught; a bridge of your own need not have one."""


class BridgeUse(Struct, forbid_unknown_fields=True, frozen=True):
    """What is learned while GNSS speaks, and said while it is silent; without a model, nothing is.

    A name from `gapless.bridges.BRIDGES` is a bridge of your own: it gets `parameters` and no other key.
    `error` learns the error of an INS that is not corrected and starts anew every `reset` seconds;
    `increment` learns the way that GNSS goes from epoch to epoch. `features` are shown now and
    `lags` - 1 epochs back, with `window` past errors, for `segment` epochs at a time; `reference` and
    `learns` say of what error. `noise` is the last fix's (as in the papers) or calibrated on held-out
    epochs. It trains on the last `samples` epochs at least `interval` seconds apart, at an outage's onset
    or every `train` seconds, and leaves out `purge` epochs between those trained on and those held out.
    """

    model: str = "none"
    features: tuple[str, ...] = ()
    lags: Count = 1
    window: WholeNumber = 0
    segment: Count = 1
    reference: Literal["gnss", "filter"] = "gnss"
    learns: tuple[Literal["position", "velocity", "attitude"], ...] = ("position", "velocity")
    axes: Literal[2, 3] = 2
    reset: Positive | Literal["never"] = "never"
    noise: Literal["filter", "calibrated"] = "filter"
    samples: Count = 300
    least: Count = 30
    train: Positive | Literal["onset"] = "onset"
    interval: NonNegative = 1.0
    purge: WholeNumber = 5
    parameters: dict[str, Any] = {}


class LearnerUse(Struct, forbid_unknown_fields=True, frozen=True):
    """Who learns: a name from the registry or a scikit-learn regressor's dotted path.

    `model` is a file that `gapless fuse --save-model` wrote: it speaks, and nothing is learned here.
    """

    name: str = "rvfl"
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    parameters: dict[str, Any] = {}
    model: str = ""


def check(use: BridgeUse) -> None:
    """See that the parts of a bridge go together.

    Parameters
    ----------
    use : BridgeUse

    Raises
    ------
    ConfigError
        If they do not, with the reason.
    """
    if use.model == "none":
        return
    from gapless.bridges import BRIDGES
    from gapless.bridges.epochs import FEATURES

    hint = registered_elsewhere()
    if use.model in BRIDGES:
        _check_own(use, list(signature(BRIDGES[use.model]).parameters)[1:])
        return
    if use.model not in MODELS:
        choices = ", ".join(("none", *MODELS, *BRIDGES))
        raise ConfigError(f"bridge.model: {use.model!r} is unknown; choose from {choices}{hint}")
    if use.parameters:
        raise ConfigError(f"bridge.parameters are for bridges of your own; {use.model} has none")
    unknown = [name for name in use.features if name not in FEATURES]
    if unknown:
        raise ConfigError(f"bridge.features has {unknown[0]!r}; choose from {', '.join(FEATURES)}{hint}")
    if not use.features and not use.window:
        raise ConfigError("bridge shows its learner nothing; give bridge.features or bridge.window")
    if use.model == "increment" and (use.window or use.lags > 1 or use.segment > 1):
        raise ConfigError('bridge.window, lags and segment are for model = "error"; leave them out')
    if use.segment > 1 and use.features:
        raise ConfigError("bridge.segment goes on from past errors alone; leave bridge.features empty")
    if use.model == "error" and not use.learns:
        raise ConfigError("bridge.learns is empty; name position, velocity or both")
    if use.model == "error" and use.reference == "gnss" and "attitude" in use.learns:
        raise ConfigError('GNSS shows no attitude; learn it with bridge.reference = "filter"')


def check_learner(use: BridgeUse, who: LearnerUse) -> None:
    """See that a learner is one that can be made; where scikit-learn is missing, `bridges` says so.

    Parameters
    ----------
    use : BridgeUse
    who : LearnerUse

    Raises
    ------
    ConfigError
        If there is no such learner, or it has no such parameters.
    """
    if use.model not in MODELS:
        return
    from gapless.learners import LEARNERS, make

    if who.name in LEARNERS and not who.parameters:
        return  # nothing that could be wrong: built-in recipes are listed without importing scikit-learn
    with suppress(MissingExtraError):
        make(who.name, who.parameters, who.seed)


def _check_own(use: BridgeUse, known: list[str]) -> None:
    """See that a bridge of the user's own is given what it takes, and nothing that it would not hear of."""
    for name in use.parameters:
        if name not in known:
            choices = ", ".join(known) or "none"
            raise ConfigError(f"bridge.parameters: {use.model} has no {name!r}; it has {choices}")
    plain = BridgeUse(model=use.model, parameters=use.parameters)
    for key in BridgeUse.__struct_fields__:
        if getattr(use, key) != getattr(plain, key):
            raise ConfigError(f"bridge.{key} is not for {use.model}; give it bridge.parameters")


def bridges(
    use: BridgeUse, who: LearnerUse, sensors: Mapping[str, Sensor], lateness: float
) -> tuple[Bridge, ...]:
    """The bridges of a recipe.

    Parameters
    ----------
    use : BridgeUse
    who : LearnerUse
    sensors : mapping of str to Sensor
        Of the same system.
    lateness : float
        How late fixes arrive [s].

    Returns
    -------
    tuple of Bridge
        None or one.

    Raises
    ------
    ConfigError
        If there is no such bridge, feature or learner in this process, or what it needs is not installed.
    """
    if use.model == "none":
        return ()
    check(use)  # a recipe may have been read by another process, with registries of its own
    from gapless.bridges import BRIDGES

    if use.model in BRIDGES:
        return (BRIDGES[use.model](sensors, **use.parameters),)
    from gapless.bridges.learned import LearnedBridge
    from gapless.bridges.noise import CalibratedNoise, FilterNoise
    from gapless.bridges.schedule import Schedule
    from gapless.bridges.shadow import Shadow
    from gapless.learners import make

    make(who.name, who.parameters, who.seed)  # say now what is wrong with it, not in the first outage
    heard = {name: sensors[name] for name in ("position", "velocity") if name in sensors}
    if "position" not in heard:
        raise ConfigError("a bridge learns from GNSS positions; add position to sensors")
    model = _model(use, heard)
    return (
        LearnedBridge(
            model,
            None if who.model else lambda: make(who.name, who.parameters, who.seed),
            heard,
            CalibratedNoise() if use.noise == "calibrated" else FilterNoise(),
            Schedule(use.samples, use.least, _seconds(use.train), use.interval, use.purge, slack=lateness),
            Shadow(_seconds(use.reset)),
            _saved(who.model, model, use),
        ),
    )


def _saved(path: str, model: Model, use: BridgeUse) -> Trained | None:
    """A learner from a file that fits the bridge, or None where no file is named."""
    if not path:
        return None
    from gapless.bridges.epochs import unknown
    from gapless.bridges.noise import FilterNoise
    from gapless.bridges.schedule import Trained
    from gapless.learners.saved import loads

    if use.noise == "calibrated":
        raise ConfigError(
            'with learner.model nothing is held out to calibrate on; use bridge.noise = "filter"'
        )
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        why = error.strerror or error
        raise ConfigError(
            f"learner.model: {path}: {why}; give a file that gapless fuse --save-model wrote"
        ) from None
    row = model.row(model.begin([], np.zeros(3)), unknown())
    learner = loads(data, path, len(row))
    answers = np.size(learner.predict(row[None, :]))
    if answers != model.outputs:
        raise ModelError(
            f"{path}: answers {answers} numbers, the bridge needs {model.outputs}; save it again"
        )
    return Trained(learner, FilterNoise(), -math.inf, 0)


def _seconds(value: float | str) -> float:
    return math.inf if isinstance(value, str) else value


def _model(use: BridgeUse, sensors: Mapping[str, Sensor]) -> Model:
    from gapless.bridges.error import ErrorModel
    from gapless.bridges.increment import IncrementModel

    if use.model == "increment":
        return IncrementModel(use.features, use.axes, sensors["position"])
    return ErrorModel(use.features, use.lags, use.window, use.reference, use.learns, use.axes, use.segment)
