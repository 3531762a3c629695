"""Fitted learners as bytes: arrays and JSON in a zip file, and nothing that runs when they are read.

Only classes that are listed here are saved and made again. A file carries what its model answered to
a few made-up inputs; one that answers otherwise, on another machine or with another scikit-learn, is
refused. To write a file whole or not at all, write these bytes within `gapless.io.writers.atomic`.
"""

from __future__ import annotations

import json
from importlib import import_module
from importlib.metadata import version
from typing import Any, Final

import numpy as np
from sklearn.base import BaseEstimator

from gapless.errors import ModelError
from gapless.learners.container import join, part
from gapless.trip.recording import Array

FORMAT: Final = 1
_KIND: Final = "gapless learner"
_PACKAGES: Final = ("numpy", "scikit-learn")

CLASSES: Final = {
    "RandomLayer": "gapless.learners.random_layer",
    "RBFNetwork": "gapless.learners.rbf",
    "LSSVR": "gapless.learners.ls_svr",
    "ResidualWeighted": "gapless.learners.weighting",
    "AdaBoostRT": "gapless.learners.adaboost_rt",
    "MeanLossSVR": "gapless.learners.svr",
    "PerOutput": "gapless.learners.per_output",
    "ByPart": "gapless.learners.by_part",
    "Perceptron": "gapless.learners.network",
    "GeneticSearchCV": "gapless.learners.genetic",
    "NAR": "gapless.learners.nar",
    "Scaled": "gapless.learners.scaling",
    "MinMaxScaler": "sklearn.preprocessing",
    "Pipeline": "sklearn.pipeline",
    "TransformedTargetRegressor": "sklearn.compose",
    "SVR": "sklearn.svm",
    "MultiOutputRegressor": "sklearn.multioutput",
    "MLPRegressor": "sklearn.neural_network",
    "Ridge": "sklearn.linear_model",
    "LinearRegression": "sklearn.linear_model",
}
"""Estimators that may be saved, and the module of each."""

TUPLES: Final = {
    "Weighted": "gapless.learners.adaboost_rt",
    "Triangle": "gapless.learners.least_squares",
    "Expansion": "gapless.learners.svr",
    "Layers": "gapless.learners.network",
}
"""Named tuples that may be part of one."""

_LEFT_OUT: Final = {"MLPRegressor": {"_random_state", "_optimizer"}}
"""What predicts nothing and is neither array nor number; a loaded network is trained anew, not on."""


def dumps(model: Any) -> bytes:
    """A fitted learner as the contents of a file; the same learner gives the same bytes.

    Parameters
    ----------
    model : estimator
        Fitted; of the classes in `CLASSES` throughout.

    Returns
    -------
    bytes

    Raises
    ------
    ModelError
        If something in it cannot be saved, or it is not fitted.
    """
    if not hasattr(model, "n_features_in_"):
        raise ModelError(f"{type(model).__name__} is not fitted; fit it before saving")
    arrays: list[Array] = []
    header = {
        "kind": _KIND,
        "format": FORMAT,
        "versions": {name: version(name) for name in _PACKAGES},
        "features": int(model.n_features_in_),
        "model": _encoded(model, arrays, type(model).__name__),
        "answers": _encoded(_answers(model), arrays, "answers"),
    }
    return join(json.dumps(header, allow_nan=False, indent=1), arrays)


def loads(data: bytes, where: str = "model", n_features: int | None = None) -> Any:
    """A learner from the contents of a file.

    Parameters
    ----------
    data : bytes
    where : str
        What to call the file in an error.
    n_features : int, optional
        Columns of the inputs that it is for.

    Returns
    -------
    estimator
        Predicts what the saved one did, bit for bit on the same machine.

    Raises
    ------
    ModelError
        If the file is damaged, foreign, newer than this gapless, or not for such inputs.
    """
    text, arrays = part(data, where)
    try:
        header = json.loads(text)
        kind, format_ = header["kind"], header["format"]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ModelError(f"{where}: not a saved learner; save it again with gapless") from None
    if kind != _KIND or not isinstance(format_, int):
        raise ModelError(f"{where}: not a saved learner but {str(kind)[:40]!r}; give another file")
    if format_ > FORMAT:
        raise ModelError(
            f"{where}: format {format_} is newer than {FORMAT}, the newest known; update gapless"
        )
    if n_features is not None and header.get("features") != n_features:
        raise ModelError(
            f"{where}: the model takes {header.get('features')} features, not {n_features}; "
            "train one for these inputs"
        )
    return _model(header, arrays, where)


def _model(header: dict[str, Any], arrays: list[Array], where: str) -> Any:
    try:
        model = _decoded(header["model"], arrays)
        if model.n_features_in_ != header["features"]:
            raise ValueError("its parts disagree on the number of features")
        wanted, answers = np.asarray(_decoded(header["answers"], arrays)), _answers(model)
        # libraries of other machines round otherwise: far less than this
        size = np.abs(wanted[np.isfinite(wanted)]).max(initial=0.0)
        agree = np.allclose(answers, wanted, rtol=1e-6, atol=1e-6 * size, equal_nan=True)
    except ModelError as error:
        raise ModelError(f"{where}: {error}") from None
    except Exception as error:  # whatever a damaged file makes a library say
        raise ModelError(
            f"{where}: damaged ({error!s:.120}); train and save it again".replace("\n", " ")
        ) from None
    if not agree:
        then = header.get("versions")
        raise ModelError(f"{where}: answers otherwise than when saved with {then}; train it again")
    return model


def _answers(model: Any) -> Array:
    """What a model makes of made-up inputs."""
    if hasattr(model, "forecast"):
        return np.asarray(model.forecast(3))
    inputs = np.sin(np.arange(1.0, 3 * model.n_features_in_ + 1)).reshape(3, -1)
    named = getattr(model, "feature_names_in_", None)
    if named is None:
        return np.asarray(model.predict(inputs))
    return np.asarray(model.predict(import_module("pandas").DataFrame(inputs, columns=named)))


def _encoded(value: Any, arrays: list[Array], where: str) -> Any:
    """A value as JSON; arrays are put aside. `where` is its path, for errors."""
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return float(value) if np.isfinite(value) else {"float": repr(float(value))}
    if isinstance(value, np.ndarray | np.generic):
        return _encoded_array(np.asarray(value), arrays, where, isinstance(value, np.generic))
    if isinstance(value, list):
        return {"list": [_encoded(v, arrays, f"{where}[{i}]") for i, v in enumerate(value)]}
    if isinstance(value, tuple):
        return {
            "tuple": [_encoded(v, arrays, f"{where}[{i}]") for i, v in enumerate(value)],
            "class": type(value).__name__ if type(value).__name__ in TUPLES else "",
        }
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {"dict": {key: _encoded(v, arrays, f"{where}.{key}") for key, v in value.items()}}
    return _encoded_estimator(value, arrays, where)


def _encoded_array(value: Array, arrays: list[Array], where: str, scalar: bool) -> Any:
    if value.dtype.kind == "O" and all(isinstance(v, str) for v in value.ravel()):
        return {"names": value.tolist()}
    if value.dtype.kind not in "biufU":
        raise ModelError(f"{where} holds {value.dtype} and cannot be saved; use numbers or text")
    arrays.append(value)
    return {"scalar" if scalar else "array": len(arrays) - 1}


def _encoded_estimator(value: Any, arrays: list[Array], where: str) -> Any:
    kind = type(value)
    if not isinstance(value, BaseEstimator) or _listed(kind.__name__) is not kind:
        raise ModelError(
            f"{where} is a {kind.__name__} and cannot be saved; choose from {', '.join(CLASSES)}"
        )
    params = value.get_params(deep=False)
    fitted = {
        name: v
        for name, v in vars(value).items()
        if name not in params and name not in _LEFT_OUT.get(kind.__name__, ())
    }
    return {
        "estimator": kind.__name__,
        "params": {name: _encoded(v, arrays, f"{where}.{name}") for name, v in params.items()},
        "fitted": {name: _encoded(v, arrays, f"{where}.{name}") for name, v in fitted.items()},
    }


def _listed(name: str) -> Any:
    """The class of a name, None if it is not listed."""
    module = CLASSES.get(name) or TUPLES.get(name)
    return None if module is None else getattr(import_module(module), name)


def _decoded(node: Any, arrays: list[Array]) -> Any:
    """The value of a JSON node."""
    if not isinstance(node, dict):
        return node
    if "float" in node:
        return float(node["float"])
    if "array" in node:
        return arrays[node["array"]]
    if "scalar" in node:
        return arrays[node["scalar"]][()]
    if "names" in node:
        return np.array(node["names"], dtype=object)
    if "list" in node:
        return [_decoded(v, arrays) for v in node["list"]]
    if "tuple" in node:
        values = [_decoded(v, arrays) for v in node["tuple"]]
        return _listed(node["class"])(*values) if node["class"] in TUPLES else tuple(values)
    if "dict" in node:
        return {key: _decoded(v, arrays) for key, v in node["dict"].items()}
    return _decoded_estimator(node, arrays)


def _decoded_estimator(node: dict[str, Any], arrays: list[Array]) -> Any:
    name = node["estimator"]
    if name not in CLASSES:
        raise ModelError(
            f"class {str(name)[:40]!r} is not one that may be loaded; choose from {', '.join(CLASSES)}"
        )
    kind = _listed(name)
    model = kind(**{key: _decoded(v, arrays) for key, v in node["params"].items()})
    for key, value in node["fitted"].items():
        if not key.isidentifier() or key.startswith("__") or hasattr(kind, key):
            raise ModelError(f"{name} has no attribute {key[:40]!r} that may be set; train and save it again")
        setattr(model, key, _decoded(value, arrays))
    model._validate_params()
    if getattr(model, "memory", None) is not None:  # a folder of pickles, read at the next fit
        raise ModelError(f"{name} has a memory, which is not loaded; save it without")
    if name == "SVR":
        _check_svr(model)
    return model


def _check_svr(model: Any) -> None:
    """The library reads these arrays by each other's sizes, in C."""
    if not hasattr(model, "support_vectors_"):
        return
    rows, columns = model.support_vectors_.shape
    sizes = (model.support_.shape, model._dual_coef_.shape, model._intercept_.shape, model.shape_fit_[1])
    if sizes != ((rows,), (1, rows), (1,), columns) or model._n_support.tolist() != [rows, rows]:
        raise ModelError("the parts of an SVR do not fit together; train and save it again")
