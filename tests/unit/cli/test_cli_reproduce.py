"""`gapless reproduce`: what it leaves in a folder, and what it refuses."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from gapless.papers import experiment, library, model
from gapless.papers.experiment import execute
from gapless.papers.kept import FOLDER

FILES = {"README.md", "report.html", "tables.txt", "results.json", "samples.csv", "results.csv", "figures"}


@pytest.fixture
def quick(monkeypatch):
    """tan2015's first test alone, with what runs in a second."""
    paper = library.paper("tan2015")
    one, road = paper.experiments[0], paper.experiments[-1]
    methods = tuple(m for m in one.methods if m.name in ("INS-only", model.OURS))
    road = replace(road, methods=methods, road=(model.Window("81 s", 0.0, 15.0),), claims=())
    short = replace(paper, experiments=(replace(one, methods=methods), road), studies=())
    monkeypatch.setattr("gapless.papers.tan2015.PAPER", short)
    return short


def test_a_folder_of_it_all(shell, quick, tmp_path):
    out = tmp_path / "out"
    (out / "figures").mkdir(parents=True)
    marked = b"\x89PNG\r\n\x1a\n....IHDR....tEXtSoftware\0gapless 0.0.1"
    (out / "figures" / "errors-of-an-earlier-run.png").write_bytes(marked)
    (out / "figures" / "mine.png").write_bytes(b"mine")
    (out / "unfinished").mkdir()
    (out / "unfinished" / "mine.txt").write_bytes(b"mine")
    said = shell("reproduce", "tan2015", "--seeds", 1, "--jobs", 1, "--out", out).output
    assert {p.name for p in out.iterdir()} == FILES | {"unfinished"}
    assert [p.name for p in (out / "unfinished").iterdir()] == ["mine.txt"]
    assert not (out / "figures" / "errors-of-an-earlier-run.png").exists()
    assert (out / "figures" / "mine.png").exists()
    assert (out / "tables.txt").read_text("utf-8").splitlines()[0] in said
    assert "Section 5.2 and Table 3, test 1" in said
    assert "27.0" in said  # what the paper's INS drifts
    assert f"wrote {out / 'report.html'}" in said
    told = json.loads((out / "results.json").read_text("utf-8"))
    assert told["paper"] == "tan2015"
    assert told["arguments"] == {"paper": "tan2015", "recordings": [], "seeds": 1}
    assert "Table 3" in (out / "README.md").read_text("utf-8")


def test_recordings_after_their_option_or_alone(shell, quick, drive, tmp_path, monkeypatch):
    monkeypatch.setattr("gapless.papers.road.FIRST", 90.0)
    for words in (("--recordings", drive), (drive,)):
        out = tmp_path / str(len(words))
        said = shell("reproduce", "tan2015", *words, "--seeds", 0, "--jobs", 1, "--out", out).output
        assert "road: all that was run" in said
        told = json.loads((out / "results.json").read_text("utf-8"))
        assert [e["name"] for e in told["experiments"]] == ["road"]
        assert told["arguments"]["recordings"] == [str(drive)]


def test_two_processes_give_the_numbers_of_one(shell, quick, tmp_path):
    for jobs in (1, 2):
        shell("reproduce", "tan2015", "--seeds", 2, "--jobs", jobs, "--out", tmp_path / str(jobs))
    one, two = ((tmp_path / n / "samples.csv").read_text("utf-8") for n in ("1", "2"))
    assert one == two


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("wang2019",), "the papers are wang2018, liu2019"),
        (("tan2015", "--seeds", 0), "nothing to run; give --seeds of 1 or more, or recordings"),
        (("tan2015", "--recordings", "nowhere"), "nowhere: no such file or folder"),
        (("tan2015", "nowhere", "elsewhere/nowhere"), "two recordings are called nowhere"),
    ],
)
def test_slips_are_refused_in_a_line_and_nothing_is_left(shell, tmp_path, words, says):
    result = shell("reproduce", *words, "--out", tmp_path / "out", code=2)
    assert says in result.output
    assert len(result.output.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_an_interrupt_leaves_nothing(shell, quick, tmp_path, monkeypatch):
    def interrupted(job):
        raise KeyboardInterrupt

    monkeypatch.setattr("gapless.papers.experiment.execute", interrupted)
    shell("reproduce", "tan2015", "--seeds", 1, "--jobs", 1, "--out", tmp_path / "out", code=130)
    assert not (tmp_path / "out").exists()


def test_an_interrupted_command_goes_on_where_it_stopped(shell, quick, tmp_path, monkeypatch):
    whole, out, begun = tmp_path / "whole", tmp_path / "out", []

    def counted(job, stop):
        if len(begun) == stop:
            raise KeyboardInterrupt
        begun.append(job.seed)
        return execute(job)

    def run(out, stop, code=0):
        monkeypatch.setattr(experiment, "execute", lambda job: counted(job, stop))
        return shell("reproduce", "tan2015", "--seeds", 3, "--jobs", 1, "--out", out, code=code).output

    run(whole, 3)
    begun.clear()
    said = run(out, 2, 130)
    assert f"interrupted; what is done is kept in {out / FOLDER}; the same command goes on from there" in said
    assert [p.name for p in out.iterdir()] == [FOLDER]
    damaged = sorted((out / FOLDER).iterdir())[0]
    damaged.write_bytes(damaged.read_bytes()[:-9])  # computed again, like what is not there
    run(out, 4)
    assert len(begun) == 4
    assert {p.name for p in out.iterdir()} == FILES
    for name in ("samples.csv", "results.csv", *(f"figures/{p.name}" for p in (whole / "figures").iterdir())):
        assert (out / name).read_bytes() == (whole / name).read_bytes()


def test_without_matplotlib_one_line_says_so(shell, quick, tmp_path, monkeypatch):
    for name in [m for m in sys.modules if m.startswith("matplotlib")] or ["matplotlib"]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    said = shell("reproduce", "tan2015", "--seeds", 1, "--jobs", 1, "--out", tmp_path / "out").output
    assert "no figures: matplotlib is not installed; run: pip install 'gapless[figures]'" in said
    assert not Path(tmp_path / "out" / "figures").exists()
    assert (tmp_path / "out" / "report.html").is_file()


def test_help_names_the_papers(shell):
    said = shell("reproduce", "--help").output
    assert all(name in said for name in library.PAPERS)
