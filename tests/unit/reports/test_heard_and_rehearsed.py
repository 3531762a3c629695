"""Sections of the page on wheels and rehearsals."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from fake_drive import START, make

from gapless.reports import rehearsals, wheels
from gapless.reports.report import page
from gapless.reports.summary import summarise
from gapless.trip.exhibits import Candidate, Chosen, Heard, Performance, Rehearsals, Standing, WheelsHeard

NOBODY, WHEELS = Candidate("", ""), Candidate("wheels", "")


@pytest.fixture(scope="module")
def run():
    recording, solution = make(length=400.0, outages=((240.0, 300.0),))
    rng = np.random.default_rng(2)
    orders = 0.2 + 0.01 * np.arange(311)
    readings = tuple(Heard(START + 245.0 + k, 8.0, 0.2, 8.1, 0.9 if k in (7, 8) else 0.02) for k in range(20))
    heard = WheelsHeard(
        200.4,
        orders,
        0.1 * rng.standard_normal((6, 311)),
        np.full((6, 311), 0.1),
        2.0,
        7.0,
        readings,
        3,
    )
    told = Rehearsals(
        60.0,
        (
            Performance(START + 100.0, START + 160.0, ((NOBODY, 12.0), (WHEELS, 6.0))),
            Performance(START + 120.0, START + 180.0, ((NOBODY, 10.0),)),
        ),
        (Standing("wheels", "bridge", 1, 0.7, 0.5, 0.9, True),),
        (Chosen(START + 160.0, NOBODY, 1.0), Chosen(START + 180.0, WHEELS, 1.3)),
    )
    return recording, replace(solution, exhibits=(heard, told))


def test_summary_says_it_all_and_is_json(run):
    told = json.loads(json.dumps(summarise(run[1]), allow_nan=False))
    assert np.shape(told["wheels"]["height"]) == np.shape(told["wheels"]["error"]) == (6, 311)
    assert told["wheels"]["circumference"] == 2.0
    assert told["wheels"]["readings"]["own"] == [8.1] * 20
    assert max(told["wheels"]["readings"]["slips"]) == 0.9
    assert told["rehearsals"]["performances"][0]["worst"] == {"nobody": 12.0, "wheels": 6.0}
    assert told["rehearsals"]["choices"][-1] == {"time": START + 180.0, "candidate": "wheels", "scale": 1.3}


def test_page_has_both_sections_in_words(run):
    recording, solution = run
    text = page(solution, recording, None)
    assert '<section id="wheels">' in text
    assert '<section id="rehearsals">' in text
    assert "20 speeds were read" in text
    assert "2 of them seem to be of wheels that slipped." in text
    assert "2.00\u00a0m</b> circumference" in text
    # of the one rehearsal that the wheels took part in
    assert "<b>12.0\u00a0m</b> without, and <b>6.00\u00a0m</b> with wheels" in text
    assert "nobody at first, wheels from 180&nbsp;s on" in text


def test_charts(run):
    recording, solution = run
    told = summarise(solution)
    orders, speeds, off, slip = wheels.charts(told, recording.gnss)
    assert orders["marks"] == pytest.approx([0.5, 1.0, 1.5, 2.0, 2.5, 3.0])
    assert [name for name, _ in speeds["series"]] == ["wheels", "filter before", "fixes, withheld"]
    assert off["title"] == "Reading less the withheld fixes"
    assert slip["range"] == [0.0, 1.0]
    assert np.argmax(slip["series"][0][1]) == 7
    alone = [one["title"] for one in wheels.charts(told, None)]
    assert alone[-2] == "Reading less the filter before"
    worst, factor = rehearsals.charts(told)
    # nobody until 180 s, the second series from then on
    assert [strip[2] for strip in worst["strips"]] == [0, 1]
    assert worst["strips"][1][0] == 180.0
    assert np.isnan(worst["series"][1][1][1])
    assert factor["series"][0][1].tolist() == [1.0, 1.3]


def test_what_was_not_heard_is_said_and_what_was_not_asked_is_not_there(run):
    recording, solution = run
    heard = replace(solution.exhibits[0], circumference=None, readings=())
    none = Rehearsals(60.0, (), (), ())
    text = page(replace(solution, exhibits=(heard, none)), recording, None)
    assert "No comb stands out" in text
    assert "No speed was read" in text
    assert "No outage was rehearsed" in text
    bare = page(replace(solution, exhibits=()), recording, None)
    assert 'id="wheels"' not in bare
    assert 'id="rehearsals"' not in bare
