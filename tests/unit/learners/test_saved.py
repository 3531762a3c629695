"""Saved learners: same predictions, and nothing but one line from a file that is not one."""

import io
import json
import pickle
import zipfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sklearn.compose import TransformedTargetRegressor
from sklearn.ensemble import RandomForestRegressor
from sklearn.linear_model import LinearRegression, Ridge
from sklearn.multioutput import MultiOutputRegressor
from sklearn.neural_network import MLPRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import MinMaxScaler
from sklearn.svm import SVR

from gapless.errors import ModelError
from gapless.learners import make
from gapless.learners.nar import NAR
from gapless.learners.saved import dumps, loads

RNG = np.random.default_rng(0)
X = RNG.uniform(-5.0, 5.0, (40, 3))
Y = np.column_stack([np.sin(X[:, 0]), X[:, 1] * X[:, 2]])
GOOD = dumps(make("erelm", {"rounds": 2}).fit(X, Y))

LIBRARY = [
    make_pipeline(MinMaxScaler(), Ridge()),
    TransformedTargetRegressor(Ridge(), transformer=MinMaxScaler((-1, 1))),
    MultiOutputRegressor(SVR()),
    MLPRegressor(hidden_layer_sizes=(5,), solver="adam", max_iter=20),
    MLPRegressor(hidden_layer_sizes=(5,), solver="lbfgs", max_iter=20),
    LinearRegression(),
]


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")
@pytest.mark.parametrize("model", LIBRARY, ids=lambda model: type(model).__name__)
def test_estimators_of_scikit_learn(model):
    assert np.array_equal(loads(dumps(model.fit(X, Y))).predict(X), model.predict(X))


def test_a_series_goes_on():
    model = NAR(make("rbf"), order="auto").fit(X)
    again = loads(dumps(model))
    assert np.array_equal(again.forecast(9), model.forecast(9))
    assert again.order == "auto"


def test_a_loaded_learner_goes_on_learning():
    model = make("relm").partial_fit(X[:20], Y[:20])
    again = loads(dumps(model))
    assert np.array_equal(
        again.partial_fit(X[20:], Y[20:]).predict(X), model.partial_fit(X[20:], Y[20:]).predict(X)
    )


def test_the_file_is_a_zip_of_json_and_arrays():
    with zipfile.ZipFile(io.BytesIO(GOOD)) as archive:
        header = json.loads(archive.read("model.json"))
        assert {name.rpartition(".")[2] for name in archive.namelist()} == {"json", "npy"}
    assert header["format"] == 1
    assert header["versions"].keys() == {"numpy", "scikit-learn"}
    assert len(np.load(io.BytesIO(GOOD), allow_pickle=False).files) > 3


@pytest.mark.parametrize(
    ("model", "line"),
    [
        (
            RandomForestRegressor(2),
            "RandomForestRegressor is a RandomForestRegressor and cannot be saved; choose",
        ),
        (
            make("sklearn.neighbors.KNeighborsRegressor"),
            "Scaled.regressor is a KNeighborsRegressor and cannot",
        ),
        (make_pipeline(MinMaxScaler(), RandomForestRegressor(2)), "Pipeline.steps[1][1] is a RandomForest"),
        (
            make("elm").set_params(regressor__random_state=np.random.RandomState(0)),
            "random_state is a RandomState",
        ),
    ],
)
def test_what_cannot_be_saved_is_refused_by_name(model, line):
    with pytest.raises(ModelError) as caught:
        dumps(model.fit(X, Y))
    assert line in str(caught.value)


def test_an_unfitted_learner_is_not_saved():
    with pytest.raises(ModelError, match="Scaled is not fitted; fit it before saving"):
        dumps(make("elm"))


def test_a_class_that_only_has_the_name_of_a_listed_one_is_refused():
    impostor = type("Ridge", (Ridge,), {})
    with pytest.raises(ModelError, match="cannot be saved"):
        dumps(impostor().fit(X, Y))


def rewritten(change, data=GOOD, drop=()):
    """The file with its header changed."""
    whole = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(whole, "w") as new:
        for name in old.namelist():
            text = old.read(name)
            if name == "model.json":
                header = json.loads(text)
                change(header)
                text = json.dumps(header)
            if name not in drop:
                new.writestr(name, text)
    return whole.getvalue()


def array_at(header, *path):
    """The index of the array at a path of a header."""
    node = header["model"]
    for key in path:
        node = node[key]
    return node["array"]


class Bomb:
    """Says so if it is ever unpickled."""

    def __reduce__(self):
        return (pytest.fail, ("the file was run",))


def with_entry(name, content):
    whole = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(GOOD)) as old, zipfile.ZipFile(whole, "w") as new:
        for entry in old.namelist():
            new.writestr(entry, content if entry == name else old.read(entry))
    return whole.getvalue()


def pickled_array():
    stream = io.BytesIO()
    np.save(stream, np.array([Bomb()], dtype=object), allow_pickle=True)
    return stream.getvalue()


def huge_array():
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": (10**12,)})
    return stream.getvalue() + bytes(64)


def compressed():
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as new:
        new.writestr("model.json", "{}")
    return whole.getvalue()


def to_class(name):
    return lambda header: header["model"].update(estimator=name)


def fitted(**values):
    return lambda header: header["model"]["fitted"].update(values)


BAD = {
    "nothing": (b"", "not a saved learner, or damaged"),
    "text": (b"hello", "not a saved learner, or damaged"),
    "pickle": (pickle.dumps(Bomb()), "not a saved learner, or damaged"),
    "cut": (GOOD[:-100], "not a saved learner, or damaged"),
    "flipped": (GOOD[:5000] + bytes([GOOD[5000] ^ 255]) + GOOD[5001:], "CRC"),
    "compressed": (compressed(), "it is compressed"),
    "pickled array": (with_entry("0.npy", pickled_array()), "not what it says"),
    "huge array": (with_entry("0.npy", huge_array()), "not what it says"),
    "no JSON": (with_entry("model.json", b"{"), "not a saved learner"),
    "deep JSON": (with_entry("model.json", b"[" * 100_000), "not a saved learner"),
    "a list": (with_entry("model.json", b"[]"), "not a saved learner"),
    "foreign": (rewritten(lambda h: h.update(kind="cake")), "not a saved learner but 'cake'"),
    "newer": (
        rewritten(lambda h: h.update(format=2)),
        "format 2 is newer than 1, the newest known; update gapless",
    ),
    "no model": (rewritten(lambda h: h.pop("model")), "damaged"),
    "missing array": (rewritten(lambda h: None, drop=("3.npy",)), "damaged"),
    "class": (rewritten(to_class("Popen")), "class 'Popen' is not one that may be loaded"),
    "path": (rewritten(to_class("os.system")), "class 'os.system' is not one that may be loaded"),
    "tuple": (rewritten(to_class("Triangle")), "class 'Triangle' is not one that may be loaded"),
    "method": (rewritten(fitted(predict=1)), "no attribute 'predict' that may be set"),
    "dunder": (rewritten(fitted(__class__=1)), "no attribute '__class__' that may be set"),
    "parameter": (rewritten(lambda h: h["model"]["params"].update(run="me")), "damaged"),
    "features": (rewritten(lambda h: h.update(features=5)), "disagree on the number of features"),
    "answers": (rewritten(lambda h: h.update(answers={"list": [1.0]})), "answers otherwise than when saved"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_file_that_is_not_one_is_refused_in_one_line(name):
    data, line = BAD[name]
    with pytest.raises(ModelError) as caught:
        loads(data, "drive.model")
    assert line in str(caught.value)
    assert str(caught.value).startswith("drive.model: ")
    assert "\n" not in str(caught.value)


def test_a_model_for_other_inputs_is_refused():
    with pytest.raises(ModelError, match="takes 3 features, not 4; train one for these inputs"):
        loads(GOOD, n_features=4)


def test_a_pipeline_with_a_cache_of_pickles_is_refused(tmp_path):
    model = make_pipeline(MinMaxScaler(), Ridge(), memory=str(tmp_path)).fit(X, Y)
    with pytest.raises(ModelError, match="Pipeline has a memory, which is not loaded; save it without"):
        loads(dumps(model))


def test_an_svr_whose_parts_do_not_fit_never_reaches_the_c_library():
    good = dumps(SVR().fit(X, Y[:, 0]))

    def claim(header):
        header["model"]["fitted"]["_n_support"] = {"array": len(names)}

    names = [n for n in zipfile.ZipFile(io.BytesIO(good)).namelist() if n.endswith(".npy")]
    stream = io.BytesIO()
    np.save(stream, np.array([10**6, 10**6], dtype=np.int32))
    changed = io.BytesIO(rewritten(claim, good))
    with zipfile.ZipFile(changed, "a") as archive:
        archive.writestr(f"{len(names)}.npy", stream.getvalue())
    with pytest.raises(ModelError, match="parts of an SVR do not fit together"):
        loads(changed.getvalue())


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_damage_anywhere_is_noticed_or_harmless(data):
    """Random bytes of the file replaced: the same model, or one line."""
    spoilt = bytearray(GOOD)
    for _ in range(data.draw(st.integers(1, 5))):
        spoilt[data.draw(st.integers(0, len(GOOD) - 1))] = data.draw(st.integers(0, 255))
    try:
        model = loads(bytes(spoilt))
    except ModelError:
        return
    assert np.array_equal(model.predict(X), loads(GOOD).predict(X))
