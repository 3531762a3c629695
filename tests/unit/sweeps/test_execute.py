"""One run: the same bits every time, and whatever goes wrong is a row."""

import math

import pytest
from studies import run

import gapless as gp
from gapless.errors import ConfigError, SweepError
from gapless.evaluation import OutageScore
from gapless.runs.smooth import smooth
from gapless.sweeps.execute import execute, outage_columns
from gapless.sweeps.run import Run
from gapless.sweeps.sources import logged, recording


def test_same_run_same_bits():
    one = run(2)
    first = execute(one)
    recording.cache_clear()
    assert repr(execute(one)) == repr(first)
    assert first.outcome == "done"


def test_figures_are_those_of_the_score():
    one = run(2, scenario=("62:75", "80:95"), override={"nonholonomic.lateral": 0.5})
    row = execute(one)
    drive = gp.simulate_drive("urban", "consumer", 100.0, 2)
    solution = gp.fuse(drive, one.recipe, gp.plan(one.scenario, drive.duration))
    scores = gp.score(solution, drive)
    assert one.recipe.nonholonomic.lateral == 0.5
    assert (row.recording, row.seed, row.override) == ("urban-consumer-2", 2, "nonholonomic.lateral=0.5")
    assert (row.aligned, row.truth, row.outages) == (True, "reference", 2)
    assert row.apart == sum(not o.counts for o in scores.outages)
    assert row.horizontal_max_worst == scores.horizontal.worst
    assert row.coverage_95 == scores.coverage
    assert row.rmse_open == scores.aided.horizontal_rmse
    for told, one_outage in zip(row.each, scores.outages, strict=True):
        assert list(told) == list(outage_columns())
        assert told["horizontal_end"] == one_outage.horizontal_end
        assert told["heading_deg_max"] == math.degrees(one_outage.heading_max)
        assert told["labels"] == "; ".join(one_outage.labels)


def test_a_smoothed_run_is_smoothed():
    drive = gp.simulate_drive("urban", "consumer", 100.0, 2)
    solution = smooth(drive, gp.load_system("constraints"), gp.plan(["65:90"], drive.duration))
    (outage,) = gp.score(solution, drive).outages
    assert execute(run(2, smooth=True)).horizontal_max_worst == outage.horizontal_max


def test_every_field_of_an_outages_score_has_its_column():
    assert len(outage_columns()) == len(OutageScore.__dataclass_fields__) + 1  # and the length


@pytest.mark.parametrize(
    ("what", "aligned", "words"),
    [
        ({"profile": "static"}, False, "no heading to start from"),
        ({"scenario": ("500:560",)}, None, "no outage fits"),
    ],
)
def test_what_is_refused_is_a_row(what, aligned, words):
    row = execute(run(1, **what))
    assert (row.outcome, row.aligned, row.outages) == ("refused", aligned, 0)
    assert words in row.reason
    assert "\n" not in row.reason
    assert row.duration == pytest.approx(99.99)  # the first sample ends the first interval


def test_a_log_that_cannot_be_read_is_a_row(tmp_path):
    (tmp_path / "imu.csv").write_text("time,gyro_x\n0.0,nonsense\n")
    row = execute(Run(logged(str(tmp_path)), (), gp.load_system("ins")))
    assert row.outcome == "refused"
    assert "imu.csv" in row.reason
    assert row.recording == str(tmp_path)


def test_a_log_that_has_changed_or_gone_is_no_row_but_an_error(tmp_path):
    gp.write_recording(gp.simulate_drive("urban", duration=60.0), tmp_path)
    one = Run(logged(str(tmp_path)), (), gp.load_system("ins"))
    with (tmp_path / "recording.toml").open("a") as file:
        file.write("# a remark\n")
    with pytest.raises(SweepError, match="has changed since"):
        execute(one)
    for path in tmp_path.iterdir():
        path.unlink()
    with pytest.raises(SweepError, match="a worker must see"):
        execute(one)


def test_a_defect_is_a_row_too(monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("gapless.sweeps.execute.fuse", broken)
    row = execute(run(1))
    assert (row.outcome, row.reason) == ("failed", "ZeroDivisionError: division by zero")


def test_other_versions_are_no_rows_but_an_error():
    with pytest.raises(ConfigError, match=r"gapless 9\.9, .*install the same"):
        execute(run(1, versions={"gapless": "9.9"}))
