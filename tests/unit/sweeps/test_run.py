"""A run's key: the same wherever it is computed, another as soon as anything else is to be done."""

import subprocess
import sys

import msgspec
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from studies import ENVIRONMENT, run

import gapless as gp
from gapless.sensors import grade_names
from gapless.sweeps.run import Run, label
from gapless.sweeps.sources import Simulated, logged

NUMBERS = st.floats(1e-3, 1e3)
OVERRIDES = st.fixed_dictionaries(
    {}, optional={"nonholonomic.lateral": NUMBERS, "gnss.jitter": NUMBERS, "clock.position": st.just("auto")}
)
RUNS = st.builds(
    Run,
    st.builds(Simulated, st.sampled_from(["urban", "highway"]), st.sampled_from(grade_names()), NUMBERS),
    st.lists(st.sampled_from(["65:90", "240:300", "every=180,length=60,first=240"])).map(tuple),
    st.sampled_from([gp.load_system("ins"), gp.load_system("constraints")]),
    OVERRIDES,
    st.integers(0, 10**6),
)


@settings(deadline=None)
@given(RUNS, st.randoms())
def test_order_of_dictionaries_does_not_count(one, chance):
    def shuffled(tree):
        if not isinstance(tree, dict):
            return tree
        items = list(tree.items())
        chance.shuffle(items)
        return {key: shuffled(value) for key, value in items}

    other = msgspec.convert(shuffled(msgspec.to_builtins(one)), Run)
    assert other.key == one.key


def leaves(tree, path=()):
    items = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in items:
        if isinstance(value, (dict, list, tuple)) and value:
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key)


def another(value):
    if isinstance(value, str):
        return value + "x"
    if isinstance(value, (list, tuple)):
        return [*value, "position"]
    if isinstance(value, dict):
        return value | {"gnss.jitter": 0.5}
    return [1.0, 0.0, 0.0] if value is None else value + 1


@settings(deadline=None)
@given(RUNS, st.data())
def test_whatever_is_changed_changes_the_key(one, data):
    tree = msgspec.json.decode(msgspec.json.encode(one))
    *path, last = data.draw(st.sampled_from(list(leaves(tree))))
    table = tree
    for part in path:
        table = table[part]
    table[last] = another(table[last])
    try:
        other = msgspec.convert(tree, Run)
    except msgspec.ValidationError:
        assume(False)
    assert other.key != one.key


def test_key_is_the_same_in_another_process():
    script = "from studies import run; print(run(7, override={'gnss.jitter': 0.5, 'clock.position': 1}).key)"
    told = subprocess.run(
        [sys.executable, "-c", script],
        env=ENVIRONMENT | {"PYTHONHASHSEED": "99"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert told.stdout.strip() == run(7, override={"clock.position": 1, "gnss.jitter": 0.5}).key


def test_whole_numbers_are_the_numbers_that_they_stand_for():
    assert Run(Simulated("urban", "consumer", 100), (), gp.load_system("ins")).key == (
        Run(Simulated("urban", "consumer", 100.0), (), gp.load_system("ins")).key
    )


def test_a_run_comes_back_from_its_json():
    one = run(3, override={"nonholonomic.lateral": 0.03})
    back = msgspec.json.decode(msgspec.json.encode(one), type=Run)
    assert (back, back.key) == (one, one.key)
    assert back.recipe.nonholonomic.lateral == 0.03
    assert label(back.override) == "nonholonomic.lateral=0.03"


@pytest.fixture
def log(tmp_path):
    folder = tmp_path / "here" / "drive"
    gp.write_recording(gp.simulate_drive("urban", duration=60.0), folder)
    return folder


def test_a_log_counts_by_its_contents_not_by_its_place(log, tmp_path):
    system = gp.load_system("ins")
    here = Run(logged(str(log)), (), system)
    elsewhere = tmp_path / "there"
    elsewhere.mkdir()
    log.rename(elsewhere / "drive")
    there = Run(logged(str(elsewhere / "drive")), (), system)
    assert there.key == here.key
    settings = elsewhere / "drive" / "recording.toml"
    settings.write_text(settings.read_text() + "\n")
    assert Run(logged(str(elsewhere / "drive")), (), system).key != here.key
