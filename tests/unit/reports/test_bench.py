import json
import shutil
import sys

import fake_bench
import numpy as np
import packing
import pyarrow.parquet as pq
import pytest
from test_report import Page, loads_nothing

from gapless.errors import ConfigError, MissingExtraError
from gapless.reports.background import read_background
from gapless.reports.bench import folder as bench_files
from gapless.reports.bench import write_bench_report
from gapless.reports.bench.figures import write_figures
from gapless.reports.bench.folder import read_bench
from gapless.reports.bench.outages import CURVES, SCORES
from gapless.reports.bench.report import bench_payload


@pytest.fixture(scope="module")
def data(bench_folder):
    return bench_payload(read_bench(bench_folder))


def rows(folder, name):
    return pq.read_table(folder / f"{name}.parquet").to_pylist()


def test_one_file_that_loads_nothing_and_is_sound(bench_folder):
    path = write_bench_report(bench_folder)
    assert path == bench_folder / "report.html"
    html = path.read_text("utf-8")
    loads_nothing(html)
    found = Page(html)
    ids = [a["id"] for _, a in found.tags if "id" in a]
    assert len(ids) == len(set(ids))
    assert "passes 60 s constraints" in " ".join(found.words)  # tables.txt, for readers without a script
    assert json.loads(found.data)["systems"][2]["causal"] is False


def test_every_outage_is_there_once_with_the_score_of_every_system(bench_folder, data):
    table = rows(bench_folder, "outages")
    assert len(data["outages"]) == len(table) / 3
    for row in table[::7]:
        (card,) = [
            c
            for c in data["outages"]
            if data["recordings"][c["r"]]["name"] == row["recording"]
            and data["protocols"][c["p"]] == row["protocol"]
            and (c["scenario"], c["start"]) == (row["scenario"], row["start"])
        ]
        scores = card["scores"][list(fake_bench.SYSTEMS).index(row["system"])]
        for name, value in zip(SCORES, scores, strict=True):
            known = np.nan if value is None else value
            assert known == pytest.approx(row[name], rel=1e-3, nan_ok=True)  # four digits are kept
        assert "; ".join(card["labels"]) == row["labels"]


def test_curves_are_those_of_their_outage(bench_folder, data):
    table = rows(bench_folder, "ages")
    columns = {name: packing.halves(data["ages"][name]) for name in CURVES}
    card = data["outages"][5]
    first, n = card["curves"][1]
    mine = [
        r
        for r in table
        if (r["recording"], r["protocol"], r["scenario"], r["start"], r["system"])
        == ("kestrel-avenue", data["protocols"][card["p"]], card["scenario"], card["start"], "constraints")
    ]
    assert n == len(mine)
    for name in CURVES:
        # Half precision: 2^-11 of the value; its steps below 2^-14 are even.
        np.testing.assert_allclose(
            columns[name][first : first + n], [r[name] for r in mine], rtol=2**-10, atol=1e-7
        )


def test_curves_are_thinned_where_there_are_many(bench_folder, monkeypatch):
    monkeypatch.setattr("gapless.reports.bench.outages._VALUES", 1000)
    data = bench_payload(read_bench(bench_folder))
    assert data["ages"]["most"] == 12
    assert max(n for c in data["outages"] for _, n in c["curves"].values()) == 12
    first, n = next(c for c in data["outages"] if c["group"] == "60 s")["curves"][0]
    age = packing.halves(data["ages"]["age"])[first : first + n]
    assert age[0] == 0.0
    assert age[-1] == pytest.approx(59.0)  # the last epoch of an outage of 60 s
    assert "at most 12 points" in data["embedded"]


def test_a_systems_track_lies_where_its_errors_put_it(data):
    card = next(c for c in data["outages"] if c["group"] == "60 s")
    x, y, t = (packing.times(data["tracks"][name]) for name in ("x", "y", "t"))
    truth = data["tracks"]["truth"][card["r"]]
    first, n = card["tracks"][0]
    piece = slice(first, first + n)
    assert t[piece][0] == pytest.approx(card["start"])
    away = np.hypot(
        np.interp(t[piece], truth["t"], truth["x"]) - x[piece],
        np.interp(t[piece], truth["t"], truth["y"]) - y[piece],
    )
    # The truth is simplified to 0.3 m; the track's thinned rows are a part of those that the score saw.
    assert away.max() <= card["scores"][0][SCORES.index("horizontal_max")] + 0.4
    assert away[-1] == pytest.approx(card["scores"][0][SCORES.index("horizontal_end")], abs=0.4)


def test_what_is_set_apart_is_counted_by_label(bench_folder, data):
    table = rows(bench_folder, "outages")
    for label, count in data["apart"]:
        assert count == sum(r["labels"] == label for r in table) / 3
    assert {label for label, _ in data["apart"]} == {r["labels"] for r in table} - {""}


def test_equal_parts_of_runs_are_kept_once(bench_folder, data):
    assert len(data["runs"]) == len(rows(bench_folder, "runs"))
    assert len(data["parts"]) == 4  # decisions, innovations, and biases of each of two lengths
    decisions = {row[0]: row[1:] for row in data["parts"][data["runs"][0]["decisions"]]}
    assert decisions["mounting angles"][:2] == ["2.31, \u22123.08\u00a0deg", "data"]


def test_a_background_is_beneath_every_track_that_it_is_near(bench_folder, tmp_path):
    path = tmp_path / "ground.geojson"
    line = {"type": "LineString", "coordinates": [[-76.49, 44.23], [-76.48, 44.24]]}
    path.write_text(json.dumps(line), "utf-8")
    found = bench_payload(read_bench(bench_folder), read_background(path))["tracks"]["truth"]
    assert [len(one["background"]) for one in found] == [1, 0]  # the second drive is 127 km further north


@pytest.mark.parametrize("name", ["bench.json", "outages.parquet", "ages.parquet", "leaderboard.parquet"])
def test_a_missing_file_is_named(bench_folder, tmp_path, name):
    copy = shutil.copytree(bench_folder, tmp_path / "copy")
    (copy / name).unlink()
    with pytest.raises(ConfigError, match=name):
        write_bench_report(copy)


@pytest.mark.parametrize("name", ["bench.json", "runs.parquet"])
def test_a_broken_file_is_named(bench_folder, tmp_path, name):
    copy = shutil.copytree(bench_folder, tmp_path / "copy")
    (copy / name).write_text("{", "utf-8")
    with pytest.raises(ConfigError, match=name):
        write_bench_report(copy)


def test_a_missing_column_is_named(bench_folder, tmp_path):
    copy = shutil.copytree(bench_folder, tmp_path / "copy")
    pq.write_table(pq.read_table(copy / "ages.parquet").drop(["bound"]), copy / "ages.parquet")
    with pytest.raises(ConfigError, match="lacks the columns bound"):
        write_bench_report(copy)


def test_an_empty_table_is_a_page_too(bench_folder, tmp_path):
    copy = shutil.copytree(bench_folder, tmp_path / "copy")
    for name in ("outages", "ages", "tracks", "runs", "leaderboard", "pairs"):
        pq.write_table(pq.read_table(copy / f"{name}.parquet").slice(0, 0), copy / f"{name}.parquet")
    assert bench_payload(read_bench(copy))["outages"] == []
    assert write_bench_report(copy).stat().st_size > 50_000


def test_rows_of_a_group_are_found_whatever_their_order():
    columns = {"a": np.array(["x", "y", "x", "y"], object), "b": np.array([1.0, 2.0, 1.0, 3.0])}
    found = {key: rows.tolist() for key, rows in bench_files.groups(columns, ("a", "b"))}
    assert found == {("x", 1.0): [0, 2], ("y", 2.0): [1], ("y", 3.0): [3]}


@pytest.mark.parametrize(("suffix", "magic"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_figures_for_papers(bench_folder, tmp_path, suffix, magic):
    pytest.importorskip("matplotlib", reason="the extra figures is not installed")
    copy = shutil.copytree(bench_folder, tmp_path / "copy")
    written = write_figures(copy, suffix)
    assert {path.stem for path in written} == {
        *("track-kestrel-avenue", "track-harbour-loop"),
        *(f"leaderboard-{p}" for p in ("passes", "isolated")),
        *(f"ages-{p}-{n}-s" for p in ("passes", "isolated") for n in (10, 60)),
    }
    assert all(path.read_bytes().startswith(magic) for path in written)
    assert all(path.parent == copy / "figures" for path in written)


def test_without_matplotlib_one_line_says_what_to_install(bench_folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'gapless\[figures\]'"):
        write_figures(bench_folder, "png")
