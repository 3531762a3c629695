"""Recipes: what TOML may say, and errors that name the key and the cure in one line."""

import re

import pytest

from gapless.bridges import BRIDGES
from gapless.errors import ConfigError
from gapless.filters.adaptation.registry import RULES
from gapless.inertial.layout import EXTRAS
from gapless.systems.library import load, names, parse
from gapless.systems.recipe import System


def test_a_learner_that_is_wrong_is_named_with_its_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("like = 'wang2018'\n[learner]\nname = 'elmo'\n")
    with pytest.raises(ConfigError, match=re.escape(f"{path}: learner 'elmo' is unknown; choose from elm, ")):
        load(path)


def refused(text):
    with pytest.raises(ConfigError) as caught:
        parse(text, "my.toml")
    message = str(caught.value)
    assert message.startswith("my.toml: ")
    assert "\n" not in message
    return message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[gnss]\nposition_flor = 1.0", ["position_flor", "gnss", "position_floor", "jitter"]),
        ("[imuu]", ["imuu", "imu", "filter", "nonholonomic"]),
        ("[imu]\ngyro_noise = -1.0", ["imu.gyro_noise", "0"]),
        ("[imu]\ngyro_noise = 'low'", ["imu.gyro_noise", "float"]),
        ("[filter]\ncorrection = 'both'", ["filter.correction", "both"]),
        ("[filter]\nstates = ['gyro_scal']", ["filter.states", "gyro_scal", *EXTRAS]),
        ("constraints = ['nonholonomic', 'friction']", ["constraints", "friction"]),
        ("[clock]\nposition = 'maybe'", ["clock.position"]),
        ("[clock]\nvelocity = 11.0", ["clock.velocity", "10"]),
        ("[gnss]\nlever_arm = [1.0, 2.0]", ["gnss.lever_arm", "3"]),
        ("[filter\n", ["not valid TOML"]),
        ("[bridge]\nmodel = 'errror'", ["bridge.model", "errror", "none, error, increment"]),
        (
            "[bridge]\nmodel = 'error'\nwindow = 5\nparameters = {a = 1}",
            ["bridge.parameters", "error has none"],
        ),
        ("[filter]\nmoments = 'unscented'", ["filter.moments", "unscented"]),
        ("[filter]\nmoments = 'cubature'\ncorrection = 'feedforward'", ["filter.moments", "feedback"]),
        ("[adaptation]\ngnss = ['gat']", ["adaptation.gnss", "'gat'", *RULES]),
        ("[adaptation]\nbridge = ['sage_husa', 'variational']", ["adaptation.bridge", "both estimate R"]),
        ("[adaptation.igg3]\nkeep = 9.0", ["adaptation.igg3", "drop = 5", "keep = 9"]),
        (
            "like = 'wang2018'\n[learner]\nname = 'elmo'",
            ["learner 'elmo'", "elm, fourier_elm", "sklearn.linear"],
        ),
        ("like = 'wang2018'\n[learner]\nname = 'sklearn.svm.SRV'", ["sklearn.svm.SRV", "check its path"]),
        ("[learner]\nseed = 4294967296", ["learner.seed", "4294967295"]),
        ("like = 'wang2018'\n[learner.parameters]\nnods = 3", ["learner 'fourier_elm'", "'nods'", "n_nodes"]),
        ("like = 'wang2018'\n[learner]\nparameters = {n_nodes = 0}", ["learner 'fourier_elm'", "n_nodes"]),
        ("[adaptation.fading]\nfactr = 1.1", ["factr", "adaptation.fading", "factor"]),
    ],
)
def test_a_mistake_is_named_where_it_is(text, words):
    message = refused(text)
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("parameters = {widht = 1}", ["bridge.parameters", "widht", "it has width"]),
        ("reset = 60", ["bridge.reset", "not for mine", "bridge.parameters"]),
    ],
)
def test_a_bridge_of_ones_own_is_given_what_it_takes(text, words, monkeypatch):
    monkeypatch.setitem(BRIDGES, "mine", lambda sensors, width=1: None)
    assert parse("[bridge]\nmodel = 'mine'\nparameters = {width = 2}", "my.toml").bridge.model == "mine"
    message = refused(f"[bridge]\nmodel = 'mine'\n{text}")
    for word in words:
        assert word in message, message


def test_an_empty_recipe_is_the_default():
    assert parse("", "my.toml") == System()


def test_built_in_recipes():
    assert {"constraints", "ins"} <= set(names())
    for name in names():
        assert load(name).name == name
    assert load("constraints") == System(description=load("constraints").description)
    assert load("ins").constraints == ()


def test_unknown_recipe_names_the_choices():
    with pytest.raises(ConfigError, match=r"'insane' is unknown; choose from .*constraints.*ins"):
        load("insane")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ConfigError, match=re.escape(str(tmp_path / "no.toml"))):
        load(tmp_path / "no.toml")


def test_a_file_that_is_not_text(tmp_path):
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match=r"bytes\.toml: cannot be read"):
        load(tmp_path / "bytes.toml")


def test_a_file(tmp_path):
    (tmp_path / "mine.toml").write_text('name = "mine"\nconstraints = []\n[imu]\ngrade = "tactical"\n')
    system = load(tmp_path / "mine.toml")
    assert (system.name, system.constraints, system.imu.grade) == ("mine", (), "tactical")
