"""What the README and the pages say is run, or held against the code."""

import importlib.util
import re
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest

import gapless as gp
from gapless.bridges import BRIDGES
from gapless.bridges.epochs import FEATURES
from gapless.denoise import DENOISERS
from gapless.io.axes import _DIRECTIONS
from gapless.io.inertial_log import IMU_COLUMNS
from gapless.io.other_logs import ODOMETER_COLUMNS, REFERENCE_COLUMNS
from gapless.io.readers.folder import KEYS
from gapless.io.satellite_log import GNSS_COLUMNS
from gapless.learners import LEARNERS
from gapless.sensors import grade_names
from gapless.systems.library import names as system_names
from gapless.systems.library import parse, source
from gapless.systems.recipe import System

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


@pytest.fixture
def refresh(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import refresh

    yield refresh
    sys.modules.pop("refresh", None)


def test_readme_prints_what_it_says(refresh):
    printed, names = refresh.run()
    said = refresh.output()
    assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", said).split()
    got, told = (np.array([float(n) for n in NUMBER.findall(text)]) for text in (printed, said))
    # the last digits move from one processor to the next; beyond that the README is stale: make docs
    assert np.allclose(got, told, rtol=0.1, atol=0.2)
    assert isinstance(names["solution"], gp.Solution)


def test_readme_systems_are_what_it_says(tmp_path, monkeypatch):
    """Its commands run as they stand, but for the names of log and folder."""
    from click.testing import CliRunner

    from gapless.cli import gapless
    from gapless.io import write_recording

    part = (ROOT / "README.md").read_text("utf-8").split("## Systems")[1]
    lines = (line for line in part.split("```")[1].splitlines() if line.startswith("gapless "))
    commands = [line.split("#")[0].split()[1:] for line in lines]
    assert [words[0] for words in commands] == ["systems", "systems", "fuse", "bench"]
    monkeypatch.chdir(tmp_path)
    write_recording(gp.simulate_drive("urban", duration=330.0), tmp_path / "LOG")
    for words in commands:
        result = CliRunner().invoke(gapless, words, prog_name="gapless")
        assert result.exit_code == 0, result.output
    assert (tmp_path / "DIR" / "report.html").exists()


def test_readme_begins_with_a_picture_that_is_there():
    (picture,) = re.findall(r"!\[.+\]\((.+)\)", (ROOT / "README.md").read_text("utf-8"))
    assert (ROOT / picture).read_text("utf-8").startswith("<svg")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(page):
    for link in re.findall(r"\]\((?!https?:)([^)#]+)\)", page.read_text("utf-8")):
        assert (page.parent / link).exists(), link


def test_commands_in_the_pages_have_options_that_exist():
    from gapless.cli import gapless

    known = {name: {o for p in verb.params for o in p.opts} for name, verb in gapless.commands.items()}
    for page in (*PAGES, ROOT / "Makefile"):
        for verb, rest in re.findall(rf"gapless ({'|'.join(known)})\b([^`\n]*)", page.read_text("utf-8")):
            assert set(re.findall(r"--[a-z-]+", rest)) <= known[verb] | {"--help"}, (page.name, verb, rest)


def keys_of(table, name=""):
    """Each table's name with dots, and its keys; an empty table is a value."""
    yield name or "Top", {key for key, value in table.items() if not isinstance(value, dict) or not value}
    for key, value in table.items():
        if isinstance(value, dict) and value:
            yield from keys_of(value, f"{name}.{key}" if name else key)


def test_configuration_page_lists_every_key_with_its_default(refresh):
    page = (DOCS / "configuration.md").read_text("utf-8")
    listed = {"Top": set()}
    for line in page.splitlines():
        if line.startswith("## "):
            keys = listed.setdefault(line[3:].strip("[]"), set())
        elif found := re.match(r"\| `(\w+)` \|", line):
            keys.add(found[1])
    assert listed == dict(keys_of(msgspec.to_builtins(System())))
    assert page == refresh.with_defaults(page)  # else: make docs


def test_configuration_page_has_a_recipe_that_is_one():
    page = (DOCS / "configuration.md").read_text("utf-8")
    system = parse(re.search(r"```toml\n(.*?)```", page, re.DOTALL)[1], "configuration.md")
    assert (system.name, system.clock.position) == ("my van", -0.15)
    for name in grade_names():
        assert f"`{name}`" in page


def test_bridges_page_has_recipes_that_are_some_and_every_feature():
    page = (DOCS / "bridges.md").read_text("utf-8")
    recipes = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    assert len(recipes) == 4
    for text in recipes:
        parse(text, "bridges.md")
    assert set(FEATURES) <= set(re.findall(r"`(\w+)`", page))


def test_recordings_page_names_every_column_and_key():
    page = (DOCS / "recordings.md").read_text("utf-8")
    words = set(re.findall(r"`(\w+)`", page))
    columns = {*IMU_COLUMNS, *GNSS_COLUMNS, *ODOMETER_COLUMNS, *REFERENCE_COLUMNS}
    assert columns | set(KEYS) | set(_DIRECTIONS) <= words


def test_quickstart_in_python_runs(tmp_path, monkeypatch, capsys):
    from gapless.io import write_recording

    page = (DOCS / "quickstart.md").read_text("utf-8")
    fused, framed = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    drive = gp.simulate_drive("urban", duration=500.0)
    write_recording(drive, tmp_path / "drive")
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(fused, names)
    assert "clock offset, position" in capsys.readouterr().out
    assert len(names["frame"]) == len(names["solution"].trajectory)
    assert (tmp_path / "drive.kml").exists()

    import pandas as pd

    names["imu"], names["gnss"] = (pd.read_parquet(f"drive/{n}.parquet") for n in ("imu", "gnss"))
    names["wheel"] = pd.DataFrame({"time": drive.gnss.time, "speed": np.hypot(*drive.gnss.v_n[:, :2].T)})
    frd = names["imu"].copy()  # as another box would have logged it, whose x is right, y forward and z up
    for sensor in ("gyro", "accel"):
        for logged, sign, axis in (("x", 1.0, "y"), ("y", 1.0, "x"), ("z", -1.0, "z")):
            names["imu"][f"{sensor}_{logged}"] = sign * frd[f"{sensor}_{axis}"]
    exec(framed, names)
    assert np.allclose(names["recording"].imu.dtheta, drive.imu.dtheta, rtol=1e-12, atol=0.0)


@pytest.fixture
def registries():
    """What a page registers is gone after it."""
    kept = [(registry, dict(registry)) for registry in (BRIDGES, DENOISERS, FEATURES, LEARNERS)]
    yield
    for registry, entries in kept:
        registry.clear()
        registry.update(entries)


@pytest.mark.parametrize("name", ["tutorial", *sorted(f"gallery/{p.stem}" for p in DOCS.glob("gallery/*"))])
def test_page_prints_what_it_says(name, refresh, registries):
    page = (DOCS / f"{name}.md").read_text("utf-8")
    again = refresh.walk(page)
    # figures move from one processor to the next, and with them how wide a column is: make docs
    assert [NUMBER.sub("#", word) for word in again.split() if not word.startswith("--")] == [
        NUMBER.sub("#", word) for word in page.split() if not word.startswith("--")
    ]


@pytest.mark.parametrize("page", sorted((DOCS / "papers").glob("*20*.md")), ids=lambda p: p.stem)
def test_paper_page_shows_the_recipe_and_every_comparator(page):
    text = page.read_text("utf-8")
    assert source(page.stem) in re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    for name in system_names():
        assert name in text if name.startswith(page.stem) else True
    for path in re.findall(
        r"`((?:bridges|denoise|filters|inertial|learners|measurements|runs|systems)/[\w/]+\.py)`", text
    ):
        assert (ROOT / "src/gapless" / path).exists(), path
    result = text.split("## Result")[1]
    assert re.search(r"`(gapless reproduce|python benchmarks/|tests/)", result), "no command prints it"


@pytest.mark.parametrize("script", sorted((ROOT / "benchmarks").glob("*.py")), ids=lambda p: p.stem)
def test_benchmarks_find_what_they_measure(script, monkeypatch):
    """They are run by hand; a name that has moved shows here."""
    monkeypatch.syspath_prepend(str(script.parent))
    found = importlib.util.spec_from_file_location(f"bench_{script.stem}", script)
    module = importlib.util.module_from_spec(found)
    monkeypatch.setitem(sys.modules, found.name, module)
    found.loader.exec_module(module)
    assert callable(module.main)
