"""Learners by name. Nothing is imported before a learner is made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, Final, Protocol, Self

from gapless.errors import ConfigError, MissingExtraError, registered_elsewhere
from gapless.trip.recording import Array

LEARNERS: Final[dict[str, str | Callable[[], Any]]] = {
    "elm": "gapless.learners.random_layer.elm",
    "fourier_elm": "gapless.learners.random_layer.fourier_elm",
    "relm": "gapless.learners.random_layer.relm",
    "weighted_relm": "gapless.learners.weighting.weighted_relm",
    "rvfl": "gapless.learners.random_layer.rvfl",
    "rvfl_ridge": "gapless.learners.random_layer.rvfl_ridge",
    "erelm": "gapless.learners.adaboost_rt.erelm",
    "rbf": "gapless.learners.rbf.RBFNetwork",
    "ls_svr": "gapless.learners.ls_svr.LSSVR",
    "svr": "gapless.learners.svr.MeanLossSVR",
    "ga_svr": "gapless.learners.genetic.ga_svr",
    "by_part": "gapless.learners.by_part.by_part",
    "mlp": "gapless.learners.network.Perceptron",
}
"""A class or function without arguments, or where to find it. Your own: ``LEARNERS["mine"] = Mine``."""

_LIBRARY: Final = "sklearn."
_PARTS: Final = ("estimator", "regressor")
"""Parameters that are learners themselves, and may be given by name."""


class Regressor(Protocol):
    """What a bridge needs of a learner."""

    def fit(self, X: Array, y: Array) -> Self:
        """Learn from samples, (n, m) and (n,) or (n, k)."""

    def predict(self, X: Array) -> Array:
        """Targets, of the shape that they had, one row a sample."""


def make(name: str, params: Mapping[str, Any] | None = None, seed: int = 0) -> Regressor:
    """A learner that sees inputs and targets in [-1, 1], for one output or several.

    Parameters
    ----------
    name : str
        Of `LEARNERS`, or the dotted path of a scikit-learn regressor ("sklearn.linear_model.Ridge").
    params : mapping, optional
        Its parameters; those of a part as `estimator__n_nodes`. A part may be given by name.
    seed : int
        For everything in it that is random.

    Returns
    -------
    Regressor
        A `Scaled`; the learner is its `regressor`.

    Raises
    ------
    ConfigError
        With the valid choices, if a name, a parameter or a value is not one of them.
    MissingExtraError
        If scikit-learn is not installed.
    """
    learner = _with(_bare(name), dict(params or {}), f"learner {name!r}")
    names = learner.get_params()
    learner.set_params(**{key: seed for key in names if key.split("__")[-1] == "random_state"})
    from sklearn.utils import get_tags

    from gapless.learners.per_output import PerOutput
    from gapless.learners.scaling import Scaled

    return Scaled(learner if get_tags(learner).target_tags.multi_output else PerOutput(learner))


def _bare(name: str) -> Any:
    """The learner alone, with its own parameters."""
    entry = LEARNERS.get(name, name if name.startswith(_LIBRARY) else None)
    if entry is None:
        raise ConfigError(
            f"learner {name!r} is unknown; choose from {', '.join(LEARNERS)}, or a regressor of "
            f"scikit-learn such as sklearn.linear_model.Ridge{registered_elsewhere()}"
        )
    learner = _made(_found(entry) if isinstance(entry, str) else entry, name)
    from sklearn.base import is_regressor

    if not is_regressor(learner):
        raise ConfigError(
            f"learner {name!r} is not a regressor; choose one, such as sklearn.linear_model.Ridge"
        )
    return learner


def _made(build: Any, name: str) -> Any:
    try:
        return build()
    except TypeError as error:
        raise ConfigError(f"learner {name!r} cannot be made without more ({error}); choose another") from None


def _found(path: str) -> Any:
    try:
        import sklearn
    except ImportError as error:
        raise MissingExtraError("scikit-learn", "learn") from error
    module, _, attribute = path.rpartition(".")
    try:
        return getattr(import_module(module), attribute)
    except (ImportError, AttributeError):
        raise ConfigError(
            f"learner {path!r} is not in scikit-learn {sklearn.__version__}; check its path"
        ) from None


def _with(learner: Any, params: dict[str, Any], where: str) -> Any:
    """The learner with these parameters, all of them checked."""
    parts = {key: _bare(params.pop(key)) for key in _PARTS if isinstance(params.get(key), str)}
    known = learner.set_params(**{key: part for key, part in parts.items() if key in learner.get_params()})
    choices = known.get_params()
    unknown = [key for key in (*parts, *params) if key not in choices]
    if unknown:
        names = ", ".join(sorted(key for key in choices if key != "random_state"))
        raise ConfigError(f"{where} has no parameter {unknown[0]!r}; choose from {names or 'none'}")
    learner.set_params(**params)
    for each in (learner, *learner.get_params().values()):
        if hasattr(each, "_parameter_constraints") and not isinstance(each, type):
            try:
                each._validate_params()
            except ValueError as error:
                raise ConfigError(f"{where}: {error}") from None
    return learner
