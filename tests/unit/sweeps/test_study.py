"""Study files: what they come to, and errors that name the key and the cure in one line."""

import pytest

import gapless as gp
from gapless.errors import ConfigError, GaplessError
from gapless.sweeps.study import plan_study


@pytest.fixture
def plan(tmp_path):
    def made(text, name="study.toml"):
        (tmp_path / name).write_text(text, "utf-8")
        return plan_study(tmp_path / name)

    return made


def test_axes_are_multiplied(plan):
    runs = plan(
        """
        systems = ["ins", "constraints"]
        scenarios = ["240:300", ["240:300", "400:460"], []]
        [simulated]
        profiles = ["urban", "highway"]
        grades = ["consumer", "tactical"]
        seeds = { first = 5, count = 3 }
        duration = 600
        [override]
        "nonholonomic.lateral" = [0.03, 1]
        gnss.jitter = [0.0, 0.1, 0.2]
        """
    )
    assert len(runs) == len({run.key for run in runs}) == 12 * 3 * 12
    assert {run.seed for run in runs} == {5, 6, 7}
    assert {run.scenario for run in runs} == {("240:300",), ("240:300", "400:460"), ()}
    assert {tuple(run.override.items()) for run in runs} == {
        (("nonholonomic.lateral", a), ("gnss.jitter", b)) for a in (0.03, 1.0) for b in (0.0, 0.1, 0.2)
    }
    assert {(r.recipe.nonholonomic.lateral, r.recipe.gnss.jitter) for r in runs} == {
        (a, b) for a in (0.03, 1.0) for b in (0.0, 0.1, 0.2)
    }


def test_runs_that_share_a_recording_come_one_after_the_other(plan):
    runs = list(plan('systems = ["ins", "constraints"]\n[simulated]\nseeds = [3, 1]'))
    assert [(r.seed, r.system.name) for r in runs] == [
        (3, "ins"), (3, "constraints"), (1, "ins"), (1, "constraints")
    ]  # fmt: skip


def test_paths_are_seen_from_the_study(plan, tmp_path):
    gp.write_recording(gp.simulate_drive("urban", duration=60.0), tmp_path / "drive")
    (tmp_path / "mine.toml").write_text('name = "mine"\nsensors = ["position"]')
    (run,) = plan('recordings = ["drive"]\nsystems = ["mine.toml"]', "lateral.toml")
    assert run.source.paths == (str(tmp_path / "drive"),)
    assert run.system.sensors == ("position",)


def test_smoothed_is_a_system(plan):
    (run,) = plan('systems = ["smoothed"]\n[simulated]')
    assert (run.smooth, run.system.name) == (True, "smoothed")
    assert run.system.constraints == gp.load_system("constraints").constraints


def test_a_study_is_named_by_its_file_or_by_itself(plan):
    assert plan("[simulated]", "first.toml").name == "first"
    assert plan('name = "second"\n[simulated]', "first.toml").name == "second"


def test_single_runs_stand_beside_the_product(plan):
    runs = list(
        plan(
            """
            [[runs]]
            simulated = { profiles = ["urban"], seeds = [1, 2] }
            system = "ins"
            scenario = "240:300"
            override = { "clock.position" = 0.1, sensors = ["position"] }
            """
        )
    )
    assert [run.seed for run in runs] == [1, 2]
    assert runs[0].recipe.clock.position == 0.1
    assert runs[0].recipe.sensors == ("position",)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("sytems = []", ["sytems", "the top table", "systems", "scenarios"]),
        ("[simulated]\nprofile = ['urban']", ["profile", "in simulated", "profiles", "grades"]),
        ("[[runs]]\nsystm = 'ins'", ["systm", "runs[0]", "system", "scenario"]),
        ("[simulated]\nprofiles = ['rural']", ["simulated", "rural", "urban", "highway"]),
        ("[simulated]\ngrades = ['cheap']", ["simulated", "cheap", "consumer", "tactical"]),
        ("[simulated]\nduration = -1", ["simulated.duration", "0"]),
        ("[simulated]\nseeds = { count = 0 }", ["simulated.seeds.count", "1"]),
        ("[simulated]\nseeds = 5", ["simulated.seeds"]),
        ("systems = ['inss']\n[simulated]", ["systems", "inss", "constraints"]),
        ("systems = ['none.toml']\n[simulated]", ["systems", "none.toml", "cannot be read"]),
        ("scenarios = ['240-300']\n[simulated]", ["scenarios", "240-300", "240:300"]),
        ("[simulated]\n[override]\n'imuu.grade' = ['']", ["override", "imuu.grade", "nonholonomic"]),
        ("[simulated]\n[override]\n'gnss.jiter' = [1.0]", ["override", "jiter", "gnss", "jitter"]),
        ("[simulated]\n[override]\n'gnss.jitter' = [0.1, -1]", ["override", "gnss.jitter", "0"]),
        ("[simulated]\n[override]\n'gnss.jitter' = 0.1", ["override.gnss.jitter", "list", "[0.1]"]),
        ("name = 'a/b'\n[simulated]", ["name"]),
        ("recordings = ['nowhere']", ["recordings", "nowhere", "check the path"]),
        ("[[runs]]\nsystem = 'ins'", ["runs[0]", "recording", "simulated"]),
        ("systems = ['ins']", ["no runs", "recordings", "simulated", "runs"]),
        ("[simulated", ["not valid TOML"]),
    ],
)
def test_a_mistake_is_named_where_it_is(plan, tmp_path, text, words):
    with pytest.raises(GaplessError) as caught:
        plan(text)
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'study.toml'}: ")
    assert "\n" not in message
    for word in words:
        assert word in message, message


def test_no_file(tmp_path):
    with pytest.raises(ConfigError, match=r"none\.toml: cannot be read .*give a TOML file"):
        plan_study(tmp_path / "none.toml")
