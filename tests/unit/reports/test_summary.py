import json
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from gapless import __version__
from gapless.reports import summarise, summary_lines
from gapless.reports.summary import channel_statistics, decision_value
from gapless.trip.solution import Decision, Innovations, Notice


@pytest.fixture(scope="module")
def summary(drive):
    _, solution, scores = drive
    return summarise(solution, scores)


def test_it_survives_json_unchanged(summary):
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary


def test_every_decision_is_there_with_its_evidence(drive, summary):
    solution = drive[1]
    assert len(summary["decisions"]) == len(solution.decisions)
    for found, one in zip(summary["decisions"], solution.decisions, strict=True):
        assert found["evidence"] == one.evidence
        assert found["source"] == one.source
    assert summary["decisions"][3]["value"] == [2.31, -3.08]


def test_figures_are_those_of_the_solution(drive, summary):
    _, solution, scores = drive
    t = solution.trajectory
    assert summary["gapless"] == __version__
    assert summary["rows"] == len(t)
    assert summary["duration"] == pytest.approx(t.time[-1] - t.time[0])
    step = np.hypot(t.v_n[:, 0], t.v_n[:, 1])
    assert summary["distance"] == pytest.approx(np.trapezoid(step, t.time), rel=1e-9)  # the same sum
    bias = summary["states"]["gyro_bias"]
    assert bias["unit"] == "deg/s"
    np.testing.assert_allclose(bias["value"], np.degrees(solution.states["gyro_bias"][-1]), rtol=1e-12)
    np.testing.assert_allclose(bias["sd"], np.degrees(solution.states_sd["gyro_bias"][-1]), rtol=1e-12)
    worst = max(o.horizontal_max for o in scores.outages)
    assert summary["scores"]["horizontal_max"]["worst"] == worst
    assert summary["outages"][1]["heading_max_deg"] == pytest.approx(
        np.degrees(scores.outages[1].heading_max)
    )
    assert summary["scores"]["truth"] == "reference"
    assert summary["scores"]["height_offset"] == pytest.approx(-36.4, abs=0.3)  # m: red noise, tau 15 s


def test_channel_statistics_of_honest_innovations():
    rng = np.random.default_rng(1)
    z = rng.standard_normal((4000, 3)) * [2.0, 2.0, 4.0]
    sd = np.tile([2.0, 2.0, 4.0], (4000, 1))
    factor = np.ones(4000)
    factor[:7], factor[7:10] = 3.0, np.inf
    found = channel_statistics(Innovations(np.arange(4000.0), z, sd, ((z / sd) ** 2).sum(1), factor))
    assert (found["count"], found["dof"], found["inflated"], found["rejected"]) == (4000, 3, 7, 3)
    low, high = stats.chi2.ppf([0.025, 0.975], 12_000) / 12_000
    assert found["lower"] == pytest.approx(low, rel=1e-8)
    assert found["upper"] == pytest.approx(high, rel=1e-8)
    # sd of the mean is sqrt(2 / 12000) = 1.3 %; 4 sd. The median's is about 1.6 times that.
    assert abs(found["mean_nis"] - 1.0) < 0.052
    assert abs(found["median_nis"] - 1.0) < 0.085
    assert abs(found["within_95"] - 0.95) < 0.014  # binomial: sd 0.34 %, 4 sd


@pytest.mark.parametrize("dof", range(1, 7))
def test_medians_are_those_of_scipy(dof):
    nis = np.full(3, stats.chi2.median(dof))
    one = Innovations(np.arange(3.0), np.zeros((3, dof)), np.ones((3, dof)), nis, np.ones(3))
    assert channel_statistics(one)["median_nis"] == pytest.approx(1.0, rel=1e-5)  # six digits kept


def test_lines_fit_a_terminal_and_say_what_matters(drive, summary):
    lines = summary_lines(json.loads(json.dumps(summary)))
    assert max(map(len, lines)) <= 80
    text = "\n".join(lines)
    for words in ("kestrel-avenue", "clock offset, velocity", "240:300", "zero_velocity", "703", "raw fixes"):
        assert words in text
    assert f"{drive[2].horizontal.median:.1f} m" in text
    assert not any(line != line.rstrip() for line in lines)


def test_without_scores_outages_are_still_listed(drive):
    solution = drive[1]
    found = summarise(replace(solution, states={}, states_sd={}, innovations={}, decisions=()))
    assert found["scores"] is None
    assert found["outages"][0] == {"start": 240.0, "end": 300.0}
    lines = summary_lines(found)
    assert "Innovations" not in lines
    assert "Decisions" not in lines


def test_unknown_figures_become_null_and_a_dash(drive):
    _, solution, scores = drive
    unknown = replace(scores.outages[0], horizontal_max=np.nan, heading_max=np.nan, labels=("no motion",))
    found = summarise(solution, replace(scores, outages=(unknown,)))
    assert found["outages"][0]["horizontal_max"] is None
    assert found["scores"]["outages_apart"] == 1
    assert found["scores"]["horizontal_max"]["count"] == 0
    (line,) = (line for line in summary_lines(found) if "240:300" in line)
    assert "\u2013" in line
    assert line.endswith("no motion")


def test_decision_values_read_well():
    assert decision_value(Decision("a", (1.0, -2.5), "deg", "data", "")) == "1, \u22122.5\u00a0deg"
    assert decision_value(Decision("a", -0.094, "s", "data", "", 0.02)) == "\u22120.094 ± 0.020\u00a0s"
    assert decision_value(Decision("a", "on", "", "user", "")) == "on"


NOTICE = Notice(
    300.0, 343.0, "position", "position not believed from 300 to 343 s: it lay 22 m aside", "silenced"
)


def test_a_verdict_stands_first(drive):
    told = summarise(replace(drive[1], notices=(NOTICE,), verdict="Disturbed: <position> was not believed."))
    assert list(told)[3:5] == ["verdict", "notices"]
    assert told["notices"][0]["text"] == NOTICE.text
    lines = summary_lines(told)
    assert lines[1] == told["verdict"]
    way, notes = lines.index("Noticed on the way"), lines.index("Noticed in the recording")
    assert way < notes
    assert NOTICE.text in " ".join(line.strip() for line in lines[way:notes])
    assert summary_lines(told, head=False)[:2] == [told["verdict"], ""]


def test_where_nothing_was_noticed_nothing_is_said(drive):
    told = summarise(drive[1])
    assert (told["verdict"], told["notices"]) == ("", [])
    lines = summary_lines(told)
    assert lines[1].endswith("km")
    assert "Noticed on the way" not in lines
    old = {key: value for key, value in told.items() if key not in ("verdict", "notices")}
    assert summary_lines(old) == lines  # of a run before there were notices
