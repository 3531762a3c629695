"""What the modules of the papers say, held against itself and against the papers' page."""

import math
import pickle

import numpy as np
import pytest

from gapless.errors import ConfigError
from gapless.papers.compare import claims_of
from gapless.papers.drives import make
from gapless.papers.library import PAPERS, paper
from gapless.papers.measure import measure
from gapless.papers.wang2018 import DRIVE
from gapless.sensors import grade
from gapless.simulate import profile
from gapless.units import DEG

EVERY = [(name, e) for name in PAPERS for e in paper(name).experiments]


@pytest.mark.parametrize(("name", "experiment"), EVERY, ids=lambda x: getattr(x, "name", x))
def test_tables_and_claims_name_what_is_run(name, experiment):
    methods = {m.name for m in experiment.methods}
    windows = {w.name for w in experiment.windows}
    assert len(methods) == len(experiment.methods)
    assert len(windows) == len(experiment.windows)
    for table in experiment.tables:
        assert table.subject in methods
        for line in table.lines:
            assert line.method in methods
            assert line.where in windows
            assert len(line.values) == len(table.columns)
    for claim in claims_of(experiment):
        assert {claim.better, claim.worse} <= methods
        assert claim.where in windows
        assert claim.ratio > 0.0


@pytest.mark.parametrize(("name", "experiment"), EVERY, ids=lambda x: getattr(x, "name", x))
def test_an_experiment_goes_to_another_process(name, experiment):
    assert repr(pickle.loads(pickle.dumps(experiment))) == repr(experiment)  # NaN is not itself


@pytest.mark.parametrize("name", PAPERS)
def test_outages_lie_in_the_drive_and_the_car_moves_in_them(name):
    """Which outages are driven through is the paper's to say: none of them may be spent at rest."""
    for experiment in (e for e in paper(name).experiments if e.drive is not None and not e.aside):
        drive = experiment.drive
        if drive.segments == "urban":  # drawn: some outages meet a red light
            continue
        made = make(drive, 1)
        speed = np.hypot(*made.reference.v_n[:, :2].T)
        for window in drive.windows:
            assert window.end <= made.duration + 0.1
        for outage in drive.outages:
            inside = (made.reference.time >= outage.start) & (made.reference.time < outage.end)
            assert speed[inside].min() > 1.0


def test_keys_of_columns_are_measured():
    from gapless.evaluation import solution_errors

    truth = make(DRIVE, 1).reference
    known = measure(solution_errors(truth, truth))
    for _, experiment in EVERY:
        for claim in claims_of(experiment):
            assert claim.key in known
        for table in experiment.tables:
            assert {c.key for c in table.columns} <= set(known)
    # the truth against itself: exact but for rounding of degrees
    assert max(v for k, v in known.items() if k != "epochs") < 1e-9


def test_wang_table_3():
    """Sixteen segments, 784 s, and the speeds that the table names at their ends."""
    segments = profile("wang2018")(math.inf, np.random.default_rng(0))
    assert len(segments) == 16
    times = np.cumsum([s.duration for s in segments])
    assert times.tolist() == [
        5, 25, 45, 145, 165, 265, 275, 325, 335, 435, 465, 565, 574, 674, 774, 784,
    ]  # fmt: skip
    speeds = np.cumsum([s.duration * s.acceleration for s in segments])
    assert speeds[[3, 5, 7, 9, 11, 13, 15]] == pytest.approx([18, 8, 8, 17, 8, 8, 0], abs=1e-9)
    assert segments[6].turn_rate == pytest.approx(9.0 * DEG)
    assert segments[12].turn_rate == pytest.approx(10.0 * DEG)


def test_wang_sensors_are_those_of_section_5():
    made = make(DRIVE, 3)
    assert made.imu.rate == pytest.approx(100.0)
    assert np.diff(made.gnss.time) == pytest.approx(1.0)
    assert made.gnss.sd_position[0] == pytest.approx(1.0)
    assert made.gnss.sd_velocity[0] == pytest.approx(0.1)
    assert made.reference.lla[0, :2] / DEG == pytest.approx([32.05, 118.79])
    assert made.reference.euler[0, 2] / DEG == pytest.approx(45.0)
    rows = np.searchsorted(made.reference.time, made.gnss.time)
    error = made.gnss.v_n - made.reference.v_n[rows]
    assert error.std() == pytest.approx(0.1, rel=0.05)  # 2,355 draws: 1.5 % of scatter, thrice


def test_georges_turns_round_in_the_second_outage():
    drive = paper("georges2015").experiments[0].drive
    made = make(drive, 2)
    heading = np.unwrap(made.reference.euler[:, 2])
    at = np.interp([420.0, 450.0], made.reference.time, heading)
    assert abs(at[1] - at[0]) == pytest.approx(np.pi, abs=0.02)  # corners are rounded, angles kept
    assert made.imu.rate == pytest.approx(50.0)


def test_aslinezhad_throws_as_many_fixes_as_the_paper_counts():
    from dataclasses import replace

    drive = paper("aslinezhad2020").experiments[0].drive
    thrown, clean = make(drive, 1), make(replace(drive, faults=()), 1)
    moved = np.abs(thrown.gnss.lla - clean.gnss.lla).max(axis=1) > 0.0
    assert 71 <= moved.sum() <= 105  # 71 and 34, some struck twice
    assert thrown.gnss.sd_position == pytest.approx(clean.gnss.sd_position)


def test_tan_trains_on_the_curve_of_its_outage():
    drive = paper("tan2015").experiments[2].drive
    made = make(drive, 1)
    heading = np.unwrap(made.reference.euler[:, 2])
    first, second = (np.interp(t + np.arange(81.0), made.reference.time, heading) for t in (313.0, 394.0))
    assert first == pytest.approx(second, abs=0.01)
    aside = paper("tan2015").experiments[4].drive
    again = np.unwrap(make(aside, 1).reference.euler[:, 2])
    turned = np.interp([313.0, 554.0], make(aside, 1).reference.time, again)
    assert abs(turned[1] - turned[0]) == pytest.approx(2.0 * np.pi, abs=0.01)  # round the block


def test_drives_follow_from_their_seed():
    drive = paper("tan2015").experiments[1].drive
    a, b, c = (make(drive, seed) for seed in (4, 4, 5))
    assert np.array_equal(a.imu.dvel, b.imu.dvel)
    assert not np.array_equal(a.reference.lla, c.reference.lla)


def test_a_paper_that_is_not_there():
    with pytest.raises(ConfigError, match="no paper 'wang2019'; the papers are wang2018, liu2019"):
        paper("wang2019")


def test_every_grade_is_known():
    for _, experiment in EVERY:
        if experiment.drive is not None:
            assert grade(experiment.drive.grade)
