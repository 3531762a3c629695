"""Leaderboard, pairs and tables from outages that are known."""

import json
import math

import numpy as np
import pytest

from gapless.laboratory.bench import Results
from gapless.laboratory.boards import leaderboard, pairs, set_apart
from gapless.laboratory.folder import writers
from gapless.laboratory.methods import Function
from gapless.laboratory.render import as_latex, as_markdown, as_text
from gapless.laboratory.study import ladder, scenario, stored
from gapless.laboratory.tables import tables


def row(system, start, error, recording="a", labels="", protocol="passes", group="60 s"):
    where = {"recording": recording, "system": system, "protocol": protocol, "scenario": "every=180"}
    when = {"group": group, "length": 60.0, "shift": 0.0, "start": start, "end": start + 60.0}
    shares = {"coverage_50": 0.5, "coverage_95": 0.9, "coverage_99": 1.0}
    return where | when | shares | {"labels": labels, "truth_epochs": 60, "horizontal_max": error}


@pytest.fixture
def outages():
    """Twenty outages in two recordings; `good` is half of `base`, `bad` three times as much."""
    rng = np.random.default_rng(4)
    found = []
    for name in ("a", "b"):
        for k in range(10):
            error = float(rng.lognormal(2.0, 0.5))
            for system, factor in (("base", 1.0), ("good", 0.5), ("bad", 3.0)):
                found.append(row(system, 240.0 + 180.0 * k, factor * error * rng.lognormal(0.0, 0.1), name))
    found.append(row("base", 5000.0, 900.0, labels="imu gap; no motion"))
    found.append(row("good", 5000.0, 2.0, labels="imu gap"))
    return found


def test_a_leaderboard_by_hand(outages):
    board = leaderboard(outages)
    assert [line["recording"] for line in board] == ["pooled"] * 3 + ["a"] * 3 + ["b"] * 3
    first = board[0]
    errors = [r["horizontal_max"] for r in outages if r["system"] == "base" and not r["labels"]]
    assert (first["system"], first["n"], first["left_out"]) == ("base", 20, 1)
    assert first["median"] == np.median(errors)
    assert first["p95"] == pytest.approx(np.percentile(errors, 95.0))
    assert first["rms"] == pytest.approx(math.sqrt(np.mean(np.square(errors))))
    assert first["worst"] == max(errors)
    for name in ("median", "rms", "p90", "p95", "worst"):
        assert first[f"{name}_lo"] <= first[name] <= first[f"{name}_hi"]
    assert first["coverage_95"] == pytest.approx(0.9)


def test_pairs_are_over_outages_that_count_in_both(outages):
    outages[0] = {**outages[0], "labels": "no motion"}  # of base: falls out for all
    found = {(r["recording"], r["system"]): r for r in pairs(outages, "base")}
    good, bad = found["pooled", "good"], found["pooled", "bad"]
    assert (good["n"], bad["n"]) == (19, 19)
    assert good["geometric"] == pytest.approx(0.5, rel=0.1)
    assert good["geometric_lo"] < 0.5 < good["geometric_hi"]
    assert (good["better"], bad["better"]) == (1.0, 0.0)
    assert bad["worst_ratio"] > 3.0
    assert good["p"] == pytest.approx(2.0**-18)  # all 19 of one sign: 2 / 2^19
    assert good["p_corrected"] == pytest.approx(2.0 * good["p"])  # two systems


def test_what_is_set_apart_is_counted_by_label(outages):
    told = {(r["system"], r["label"]): (r["n"], r["median"]) for r in set_apart(outages)}
    assert told == {
        ("base", "imu gap"): (1, 900.0),
        ("base", "no motion"): (1, 900.0),
        ("good", "imu gap"): (1, 2.0),
    }


@pytest.fixture
def results(outages):
    made = Results(
        tuple(Function(name, "", causal, None) for name, causal in (("base", 1), ("good", 0), ("bad", 1))),
        (scenario("every=180,length=60,first=240"),),
        ("passes",),
        recordings=[{"name": "a", "distance": math.nan}],
        outages=outages,
        checks={"base": {"a": "held in 10 outages", "b": "held in 10 outages"}},
    )
    made.leaderboard, made.pairs = leaderboard(outages), pairs(outages, "base")
    made.apart = set_apart(outages)
    return made


def test_every_table_of_scores_names_its_protocol_and_losses_are_shown(results):
    found = tables(results)
    assert all("passes" in t.title for t in found[:-1])
    text = as_text(found)
    lines = text.splitlines()
    assert any("bad" in line and line.endswith("WORSE") for line in lines)
    assert any("good*" in line and line.endswith("better") for line in lines)
    assert "* not causal" in text
    assert any(line.split()[:3] == ["base", "held", "in"] and line.endswith("a, b") for line in lines)
    for line in lines:
        if line.startswith("60 s") and "[" in line:
            assert ("good*" in line) or ("good" not in line)


def test_in_a_narrow_terminal_a_table_goes_on_below(results):
    found = tables(results)
    narrow = as_text(found, 80)
    assert max(map(len, narrow.splitlines())) <= 80
    for table in found:
        for row in table.rows:
            assert all(cell in narrow for cell in row)
    assert narrow.count("outages  system") > as_text(found).count("outages  system")


def test_markdown_and_latex_hold_the_same_cells(results):
    found = tables(results)
    markdown, latex = as_markdown(found), as_latex(found)
    for table in found:
        assert table.title in markdown
    width = [line.count("|") for line in markdown.splitlines() if line.startswith("| 60 s")]
    assert width
    assert set(width) <= {6, 11}
    assert latex.count(r"\begin{tabular}") == latex.count(r"\end{tabular}") == len(found)
    assert "50/95/99 \\%" in latex
    assert latex.count("{") == latex.count("}")
    body = [line for line in latex.splitlines() if line.startswith("60 s")]
    assert all(line.endswith(r"\\") for line in body)


def test_json_knows_no_nan(results, tmp_path):
    files = writers(results, {"out": "x"})
    for name in ("bench.json", "tables.json"):
        files[name](tmp_path / name)
        json.loads((tmp_path / name).read_text(), parse_constant=lambda text: pytest.fail(text))
    told = json.loads((tmp_path / "bench.json").read_text())
    assert told["recordings"][0]["distance"] is None
    assert [s["causal"] for s in told["systems"]] == [1, 0, 1]


def test_the_ladder_is_that_of_the_papers():
    found = ladder([10, 120], 180.0, [0, 60], 240.0)
    assert [s.text for s in found] == [
        "every=180,length=10,first=240,shift=0",
        "every=180,length=10,first=240,shift=60",
        "every=240,length=120,first=240,shift=0",
        "every=240,length=120,first=240,shift=60",
    ]
    assert [s.group for s in found] == ["10 s", "10 s", "120 s", "120 s"]
    assert scenario("every=180,length=10,first=240,effect=noisy").group == "10 s, noisy:10"
    assert scenario("gaps=5").group == "gaps=5"
    assert math.isnan(scenario("gaps=5").length)


def test_two_recordings_of_one_name_are_refused(tmp_path):
    from gapless.errors import ConfigError

    with pytest.raises(ConfigError, match="two recordings are called drive"):
        stored([tmp_path / "x" / "drive", tmp_path / "y" / "drive"])
