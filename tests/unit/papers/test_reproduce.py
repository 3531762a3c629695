"""A small paper from one end to the other: runs, files, pages, figures; and what is refused."""

import csv
import json
from dataclasses import replace
from html import unescape
from io import StringIO

import numpy as np
import pytest
from small_papers import DRIVE, experiment

from gapless.errors import ConfigError, MissingExtraError
from gapless.laboratory.render import as_text
from gapless.laboratory.study import Simulated
from gapless.papers import figures as drawing
from gapless.papers.drives import make
from gapless.papers.experiment import execute, reproduce
from gapless.papers.folder import FILES, means, writers
from gapless.papers.jobs import Job, Outcome, prepare
from gapless.papers.kept import once
from gapless.papers.page import summary
from gapless.papers.start import fuse_from
from gapless.papers.tables import number, tables
from gapless.runs.fuse import fuse
from gapless.systems.adjust import changed
from gapless.systems.library import load
from gapless.units import DEG


def test_every_method_has_a_row_or_a_reason(done):
    town, aside = done.results
    assert (town.drives, aside.drives) == (2, 1)
    assert {(s.method, s.where, s.drive) for s in town.samples} == {
        (m, w, f"seed {k}") for m in ("INS", "car") for w in ("GNSS on", "15 s") for k in (1, 2)
    }
    assert list(town.missing) == ["dream"]
    assert "dream" in town.missing["dream"]
    text = as_text(tables(done), 80)
    assert "INS" in text
    beside = next(t for t in tables(done) if "Table 1" in t.title)
    cells = {row[:2]: row[2:] for row in beside.rows}
    assert cells["15 s", "dream"] == ("1.00", "not run", "1.00", "not run")
    assert cells["15 s", "INS"][0] == "4.00"
    assert float(cells["15 s", "INS"][1]) > 0.0
    assert cells["GNSS on", "car"][2] == "-"


def test_tables_fit_a_narrow_terminal(done):
    lines = as_text(tables(done), 80).splitlines()
    assert max(map(len, lines)) <= 80


def test_measured_is_the_mean_of_the_samples(done):
    town = done.results[0]
    rows = {(r["where"], r["method"], r["measure"]): r for r in means(town)}
    one = rows["15 s", "INS", "position_east_rmse"]
    want = np.mean([s.values["position_east_rmse"] for s in town.of("INS", "15 s")])
    assert (one["mean"], one["n"], one["paper"], one["table"]) == (want, 2, 4.0, "Table 1")
    assert np.isnan(one["low"])  # two drives give no interval


def test_files_say_the_same(done, tmp_path):
    drawn = drawing.figures(done)
    assert {n.split("-")[0] for n in drawn} == {"motion", "errors"}
    assert all(image.startswith(b"\x89PNG") for image in drawn.values())
    made = writers(done, {"seeds": 2}, drawn)
    assert set(made) == {*FILES, *(f"figures/{n}.png" for n in drawn)}
    (tmp_path / "figures").mkdir()
    for name, write in made.items():
        write(tmp_path / name)
    told = json.loads((tmp_path / "results.json").read_text("utf-8"))
    assert told["experiments"][0]["not_run"]["dream"]
    assert told["experiments"][0]["claims"][-1]["text"] == "text: half"
    rows = list(csv.DictReader(StringIO((tmp_path / "samples.csv").read_text("utf-8"))))
    assert len(rows) == sum(len(r.samples) for r in done.results)
    assert float(rows[0]["horizontal_max"]) == done.results[0].samples[0].values["horizontal_max"]
    readme, page = ((tmp_path / n).read_text("utf-8") for n in ("README.md", "report.html"))
    for text in (readme, unescape(page)):
        assert "Why." in text
        assert "An idea." in text
        assert summary(done) in text
    assert page.count("data:image/png") == len(drawn)
    assert 'setTheme("")' in page
    for name in drawn:
        assert f"figures/{name}.png" in readme


def test_a_given_start_is_wrong_by_what_is_said():
    drive = replace(DRIVE, duration=60.0)
    made = make(drive, 1)
    system = changed(load("ins"), {"clock.position": 0.0, "clock.velocity": 0.0}, "test")
    solution = fuse_from(replace(made, reference=None), made, system, (), 0.5 * DEG, 1)
    first = solution.trajectory.take(slice(0, 1))
    assert first.time[0] - made.start < 1.5  # at the first fix with samples, not once the car moves
    true = made.reference.euler[0]
    off = np.abs(first.euler[0] - true) / DEG
    assert 0.0 < off.max() < 2.0  # four sigma of 0.5 deg
    assert first.sd[0, 6:] / DEG == pytest.approx(0.5, rel=0.3)  # the box's own misalignment is added


def test_a_method_that_cannot_run_is_told_of_and_the_others_go_on():
    standing = experiment(drive=replace(DRIVE, segments="static"))
    ready, _ = prepare(standing)
    outcome = execute(Job(standing, ready, 1))
    assert set(outcome.failed) == {"INS", "car"}
    assert "no heading to start from" in outcome.failed["INS"]
    assert not outcome.samples


def test_numbers_that_run_away_end_their_method_alone(monkeypatch):
    from gapless.papers import drives

    def diverges(method, system, recording, outages):
        if method.name == "car":
            raise ValueError("Input X contains NaN.\nand much advice")
        return fuse(recording, system, outages)

    monkeypatch.setattr(drives, "navigate", diverges)
    ready, _ = prepare(experiment())
    outcome = execute(Job(experiment(), ready, 1))
    assert outcome.failed == {"car": "ValueError: Input X contains NaN."}
    assert {s.method for s in outcome.samples} == {"INS"}


def test_nothing_to_run_is_refused(small):
    with pytest.raises(ConfigError, match="nothing to run"):
        reproduce(small, seeds=0)
    lost = replace(small, experiments=(experiment(methods=small.experiments[0].methods[2:], tables=()),))
    with pytest.raises(ConfigError, match="dream"):
        reproduce(lost, seeds=1)


def test_without_matplotlib(done, monkeypatch):
    def missing():
        raise MissingExtraError("matplotlib", "figures")

    monkeypatch.setattr(drawing, "figure_class", missing)
    with pytest.raises(MissingExtraError, match=r"pip install 'gapless\[figures\]'"):
        drawing.figures(done)


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.0429, "0.0429"), (0.5, "0.500"), (12.04, "12.0"), (455.1, "455"), (843.6, "844"), (float("nan"), "-"),
     (0.0, "0"), (1234.5, "1234")],
)  # fmt: skip
def test_three_significant_digits(value, said):
    assert number(value) == said


def test_what_is_kept_of_one_job_is_not_another_s(tmp_path):
    town = experiment()
    ready, _ = prepare(town)
    drives = [Simulated("urban", "consumer", 60.0, seed) for seed in (1, 2)]
    jobs = [
        *(Job(town, ready[:1], source=drive) for drive in drives),
        Job(town, ready[1:], source=drives[0]),
        Job(town, ready, 1),
        Job(town, ready, 2),
        Job(replace(town, drive=replace(DRIVE, duration=61.0)), ready, 1),
    ]
    for k, job in enumerate(jobs * 2):  # the second time nothing is done
        found = once(tmp_path, lambda job: Outcome(failed={"job": str(jobs.index(job))}), job)
        assert found.failed == {"job": str(k % len(jobs))}
    assert len(list(tmp_path.iterdir())) == len(jobs)
