"""Learners by name: what a user may ask for, and what is said where it is not there."""

import subprocess
import sys

import numpy as np
import pytest
from sklearn.linear_model import Ridge

from gapless.errors import ConfigError
from gapless.learners import LEARNERS, make
from gapless.learners.per_output import PerOutput


def test_parameters_and_seed_reach_every_part():
    made = make("erelm", {"rounds": 7, "estimator__n_nodes": 9}, seed=5).regressor
    assert (made.rounds, made.estimator.n_nodes) == (7, 9)
    assert (made.random_state, made.estimator.random_state) == (5, 5)


def test_a_part_may_be_another_learner():
    made = make("erelm", {"estimator": "ls_svr", "estimator__C": 3.0}).regressor
    assert type(made.estimator).__name__ == "LSSVR"
    assert made.estimator.C == 3.0


def test_any_regressor_of_scikit_learn():
    made = make("sklearn.linear_model.Ridge", {"alpha": 2.0}).regressor
    assert isinstance(made, Ridge)
    assert made.alpha == 2.0
    assert isinstance(make("sklearn.ensemble.GradientBoostingRegressor").regressor, PerOutput)
    forest = make("sklearn.ensemble.RandomForestRegressor", {"n_estimators": 3}, seed=9).regressor
    assert forest.random_state == 9


OWN = """
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from gapless.learners import LEARNERS
from gapless.learners.random_layer import relm
from gapless.systems.library import parse

LEARNER = "like = 'wang2018'\\n[learner]\\nname = 'mine'"
RECIPES = LEARNER, "[bridge]\\nmodel = 'mine'", "[denoise]\\nmethod = 'mine'"

def tried(text):
    try:
        return parse(text, "my.toml").learner.name
    except Exception as error:
        return str(error)

if "top" in sys.argv:
    LEARNERS["mine"] = relm
if __name__ == "__main__":
    LEARNERS["mine"] = relm
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        print(*pool.map(tried, RECIPES), sep="\\n")
"""


@pytest.mark.parametrize(("where", "known"), [("top", True), ("guarded", False)])
def test_worker_processes_know_what_a_script_registers_at_its_top(tmp_path, where, known):
    script = tmp_path / "mine.py"
    script.write_text(OWN)
    done = subprocess.run([sys.executable, script, where], capture_output=True, text=True, check=True)
    learner, *others = done.stdout.splitlines()
    assert (learner == "mine") is known
    hint = 'registered at the top of your script, outside of if __name__ == "__main__"'
    for line in others if known else (learner, *others):
        assert "'mine' is unknown; choose from" in line
        assert hint in line


def test_a_learner_of_ones_own(monkeypatch):
    monkeypatch.setitem(LEARNERS, "mine", lambda: Ridge(alpha=0.0))
    x = np.arange(12.0).reshape(6, 2) ** 2
    np.testing.assert_allclose(make("mine").fit(x, x).predict(x), x, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "params", "line"),
    [
        ("elmo", {}, "learner 'elmo' is unknown; choose from elm, fourier_elm, "),
        ("os.system", {}, "learner 'os.system' is unknown"),
        ("elm", {"nodes_": 3}, "has no parameter 'nodes_'; choose from direct_links, n_nodes, nodes, "),
        ("elm", {"n_nodes": 0}, "'n_nodes' parameter of RandomLayer must be an int in the range"),
        ("elm", {"nodes": "step"}, "must be a str among {"),
        ("erelm", {"estimator__penalty": -1.0}, "learner 'erelm': The 'penalty' parameter"),
        ("erelm", {"estimator": "elmo"}, "learner 'elmo' is unknown"),
        ("elm", {"estimator": "elm"}, "has no parameter 'estimator'"),
        ("sklearn.linear_model.Rigde", {}, "is not in scikit-learn"),
        ("sklearn.nothing.Ridge", {}, "is not in scikit-learn"),
        ("sklearn.svm.SVC", {}, "is not a regressor"),
        ("sklearn.linear_model", {}, "cannot be made"),
        ("sklearn.multioutput.MultiOutputRegressor", {}, "cannot be made without more"),
        ("sklearn.linear_model.Ridge", {"alpha": -1.0}, "'alpha' parameter of Ridge"),
    ],
)
def test_what_is_not_there_is_said_in_one_line(name, params, line):
    with pytest.raises(ConfigError) as caught:
        make(name, params)
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_names_cost_no_import():
    code = "import sys, gapless.learners; sys.exit('sklearn' in sys.modules or 'scipy' in sys.modules)"
    assert run(code).returncode == 0


def test_without_scikit_learn_the_cure_is_named():
    code = "import sys; sys.modules['sklearn'] = None; from gapless.learners import make; make('elm')"
    told = run(code).stderr.splitlines()[-1]
    assert told.endswith("scikit-learn is not installed; run: pip install 'gapless[learn]'")


def test_the_process_gapless_hides_scipy_from_numba_and_not_from_learners():
    code = "import sys; sys.modules['scipy'] = None; from gapless.learners import make; make('elm')"
    assert run(code).returncode == 0
