"""`gapless sweep` as one meets it in a terminal."""

import re
from pathlib import Path

import pytest
from command_line import Shell

from gapless.cli.sweep import _progress
from gapless.errors import MissingExtraError
from gapless.sweeps.conduct import Tally

STUDY = """
systems = ["ins", "constraints"]
scenarios = ["65:90"]
[simulated]
profiles = ["urban", "static"]
duration = 100
seeds = [1, 2]
"""
DOCS = Path(__file__).parents[3] / "docs"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "small.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def swept(study):
    """Output of a sweep, and of the same one again."""
    words = ("sweep", study, "--jobs", 1, "--out", study.parent / "out")
    return Shell()(*words).output, Shell()(*words).output


def test_a_summary_is_told(swept):
    first, again = swept
    assert re.match(r"small: 8 runs in .+, \d+\.\d drive-hours per minute; 0 were there\n", first)
    assert again.startswith("small: 0 runs in ")
    assert "; 8 were there\n" in again
    assert first.splitlines()[1:] == again.splitlines()[1:]
    table = {line.split()[0]: line.split() for line in first.splitlines()[3:5]}
    assert list(table) == ["constraints", "ins"]
    assert table["ins"][1:5] == ["4", "2", "0", "2"]  # runs; the static drives refused; outages
    assert max(map(len, first.splitlines())) <= 80


def test_what_the_runs_are(shell, study):
    lines = shell("sweep", study, "--dry-run").output.splitlines()
    assert lines[0] == "study small: 8 runs"
    assert len(lines) == 9
    assert lines[1].endswith("urban consumer 100 s seed 1 · 65:90 · ins")
    assert not (study.parent / "small").exists()


def test_many_runs_are_counted_not_listed(shell, tmp_path):
    (tmp_path / "many.toml").write_text("[simulated]\nseeds = { count = 1000000 }\n")
    lines = shell("sweep", tmp_path / "many.toml", "--dry-run").output.splitlines()
    assert lines[0] == "study many: 1000000 runs"
    assert lines[-1] == "  and 999980 more"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "--out is missing"),
        (("--out", "x", "--executor", "threads"), "choose processes or dask://HOST:PORT"),
        (("--out", "nowhere://x"), "nowhere"),
    ],
)
def test_one_line_where_it_cannot_be(shell, study, words, said):
    told = shell("sweep", study, *words, code=2).output
    assert said in told
    assert len(told.splitlines()) == 1


def test_a_missing_extra_is_one_line(shell, study, monkeypatch):
    def missing(*_):
        raise MissingExtraError("distributed", "cluster")

    monkeypatch.setattr("gapless.sweeps.workers._cluster", missing)
    told = shell("sweep", study, "--out", "x", "--executor", "dask://h:1", code=2).output
    assert told == "gapless: distributed is not installed; run: pip install 'gapless[cluster]'\n"


def test_progress_says_how_far_how_fast_and_how_long():
    tally = Tally(200, there=100, done=18, refused=2, driven=20 * 3600.0, elapsed=300.0)
    said = _progress(tally).replace("\u00a0", " ")
    assert said == "120 of 200 runs, 2 refused · 4.0 drive-hours per minute · 20 min 00 s left"


def test_the_page_has_a_study_that_is_one(tmp_path, monkeypatch):
    """But for its recordings, which are somebody else's."""
    from gapless.sweeps import study as room
    from gapless.sweeps.sources import Logged

    monkeypatch.setattr(room, "logged", lambda *paths: Logged(paths, "0"))
    page = (DOCS / "sweeps.md").read_text("utf-8")
    (tmp_path / "page.toml").write_text(re.search(r"```toml\n(.*?)```", page, re.DOTALL)[1], "utf-8")
    (tmp_path / "my.toml").write_text('name = "mine"')
    plan = room.plan_study(tmp_path / "page.toml")
    assert plan.name == "lateral"
    assert len(plan) == (3 + 2 * 2 * 100) * 3 * (3 * 6) + 1
    assert next(iter(plan)).source.duration == 900.0


def test_the_page_names_what_a_row_holds():
    from gapless.sweeps.execute import Row

    page = (DOCS / "sweeps.md").read_text("utf-8")
    named = set(re.findall(r"`(\w+)`", page))
    figures = {name for name in Row.__dataclass_fields__ if not name.startswith("horizontal_max")}
    assert figures - {"truth", "duration"} <= named
