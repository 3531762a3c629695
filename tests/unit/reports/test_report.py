import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import fake_drive
import numpy as np
import packing
import pymap3d
import pytest

from gapless.evaluation import score
from gapless.reports import write_report
from gapless.reports.decimate import POINTS
from gapless.reports.page import asset
from gapless.reports.payload import payload
from gapless.reports.report import page
from gapless.trip.recording import Note
from gapless.trip.solution import Decision, Notice

SVG_NAMESPACE = "http://www.w3.org/2000/svg"
"""A name, not an address: nothing is fetched from it."""
VOID = {"meta", "input", "br", "link", "img"}


class Page(HTMLParser):
    """A parser that checks nesting and keeps what tests ask about."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.words, self.data = [], [], [], ""
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open and self.open[-1][0] not in ("script", "style"):
            self.words.append(data)
        elif self.open and self.open[-1][1].get("id") == "data":
            self.data += data


def loads_nothing(html):
    for tag, attributes in Page(html).tags:
        assert not {"src", "href", "srcset", "data", "action"} & set(attributes), tag
    own = html.replace(asset("vendor/uPlot.iife.min.js"), "").replace(SVG_NAMESPACE, "")
    assert not re.search(
        r"https?://|//[a-z]+\.|@import|url\(|fetch\(|XMLHttp|WebSocket|import\(|\beval\b", own
    )
    assert not re.search(r"fetch\(|XMLHttp|WebSocket|import\(|\beval\b", html)
    assert "default-src 'none'" in html  # the browser itself forbids the rest


@pytest.fixture(scope="module")
def html(drive):
    recording, solution, scores = drive
    return page(solution, recording, scores)


def test_one_file_that_loads_nothing(drive, html, tmp_path):
    recording, solution, scores = drive
    path = tmp_path / "report.html"
    write_report(solution, recording, scores, path)
    assert path.read_text(encoding="utf-8") == html
    loads_nothing(html)
    assert asset("vendor/uPlot.LICENSE") in html  # a copy of the library goes with its licence


def test_it_is_sound_and_semantic(html):
    found = Page(html)
    tags = [tag for tag, _ in found.tags]
    for tag in ("header", "main", "footer", "h1", "dl", "table", "caption", "figure"):
        assert tag in tags
    assert tags.count("h1") == 1
    assert all("scope" in a for tag, a in found.tags if tag == "th")
    assert all(a.get("aria-label") for tag, a in found.tags if tag == "canvas")
    ids = [a["id"] for _, a in found.tags if "id" in a]
    assert len(ids) == len(set(ids))


def test_tables_stand_without_a_script(drive, html):
    _, solution, scores = drive
    words = " ".join(Page(html).words)
    for decision in solution.decisions:
        assert decision.evidence in words
    for note in solution.notes:
        assert note.what in words
    for one in scores.outages:
        assert f"{one.horizontal_max:.1f}\u00a0m" in words
    for label in ("Non-holonomic", "Zero velocity", "Mean NIS / dof", "Gyro bias"):
        assert label in words


HOSTILE = '</script><script>alert("x")</script><!--<b>&amp;\u2028$name'


def test_strings_from_outside_are_harmless(drive):
    recording, solution, scores = drive
    hostile = replace(
        solution,
        name=HOSTILE,
        system=HOSTILE,
        decisions=(Decision(HOSTILE, HOSTILE, HOSTILE, HOSTILE, HOSTILE),),
        notes=(Note(HOSTILE, HOSTILE, 1),),
        states={HOSTILE: solution.states["mounting"]},
        states_sd={HOSTILE: solution.states_sd["mounting"]},
        innovations={HOSTILE: solution.innovations["odometer"]},
    )
    text = page(hostile, replace(recording, name=HOSTILE), scores)
    found = Page(text)
    assert [tag for tag, _ in found.tags].count("script") == 3
    assert "b" not in {tag for tag, a in found.tags if a}
    assert text.count("</script>") == 3
    assert HOSTILE in " ".join(found.words)
    shown = HOSTILE.capitalize()  # an unknown state is titled by its name
    assert any(chart["title"] == shown for chart in json.loads(found.data)["charts"])


def test_data_is_decimated_to_what_a_screen_shows(drive, html):
    data = json.loads(Page(html).data)
    for chart in data["charts"]:
        times = packing.times(data["times"][chart["t"]])
        assert len(times) <= POINTS + 10  # a bucket more for each stretch of the focus
        assert (np.diff(times) >= 0).all()
        assert chart["range"][0] < chart["range"][1]
        for series in chart["series"]:
            assert len(packing.values(series["y"])) == len(times)
            assert "band" not in series or len(packing.values(series["band"])) == len(times)
    assert len(data["track"]["t"]) <= 4000
    assert f"{len(drive[1].trajectory)} rows in about {POINTS} points" in data["embedded"]
    titles = [chart["title"] for chart in data["charts"]]
    assert titles[0] == "Horizontal error"
    assert {"Speed", "Heading", "Gyro bias", "Odometer", "Zero angular rate"} <= set(titles)


def test_an_hour_at_ten_hertz_stays_below_two_megabytes():
    recording, solution = fake_drive.make(length=3620.0)
    assert len(solution.trajectory) == 36_000
    assert len(page(solution, recording, score(solution, recording)).encode()) < 2_000_000


def test_the_track_is_in_metres_east_and_north(drive):
    recording, solution, scores = drive
    track = payload(solution, recording, scores)["track"]
    t = solution.trajectory
    middle = t.lla[len(t) // 2]
    lla = np.array([np.interp(track["t"], t.time - solution.start, t.lla[:, k]) for k in range(3)])
    north, east, _ = pymap3d.geodetic2ned(*np.degrees(lla[:2]), lla[2], *np.degrees(middle[:2]), middle[2])
    # Tangent plane against the ellipsoid: east shrinks by d_north tan(lat) / R, 3e-4 at 2 km; 1 cm rounding.
    np.testing.assert_allclose(track["x"], east, rtol=1e-3, atol=0.1)
    np.testing.assert_allclose(
        track["y"], north, rtol=1e-3, atol=0.6
    )  # d_east^2 tan(lat) / 2R: 0.3 m at 2 km


def test_ellipses_are_those_of_the_covariance(drive):
    recording, solution, scores = drive
    ellipses = payload(solution, recording, scores)["track"]["ellipses"]
    assert len(ellipses) == 72
    t = solution.trajectory
    for time, _, _, major, minor, angle in ellipses[::9]:
        (row,) = np.flatnonzero(np.abs(t.time - solution.start - time) < 0.01)
        p = np.diag(t.sd[row, 1::-1] ** 2) + t.horizontal[row] * (1 - np.eye(2))  # east, north
        axis = np.array([np.cos(angle), np.sin(angle)])
        scale = -2.0 * np.log(0.05)
        # Axes are rounded to 1 mm of 1 m or more, angles to 1 mrad.
        np.testing.assert_allclose(scale * p @ axis, major**2 * axis, atol=4e-3 * major**2)
        assert np.sqrt(scale**2 * np.linalg.det(p)) == pytest.approx(major * minor, rel=2e-3)


def test_fixes_are_split_into_used_and_withheld(drive):
    recording, solution, scores = drive
    used, away = payload(solution, recording, scores)["track"]["fixes"]
    assert len(away["t"]) == 180  # three times 60 s at 1 Hz
    assert len(used["t"]) == len(recording.gnss) - 180


def test_without_reference_outages_or_scores_it_shows_innovations():
    recording, solution = fake_drive.make(length=200.0, outages=(), reference=False)
    text = page(replace(solution, notes=()), replace(recording, notes=()), None)
    data = json.loads(Page(text).data)
    assert data["track"]["reference"] is None
    assert data["outages"] == data["track"]["ellipses"] == data["track"]["coasting"] == []
    groups = {chart["group"] for chart in data["charts"]}
    assert "Innovations" in groups
    assert "Errors" not in groups
    assert "Nothing had to be mended" in text


def test_withheld_fixes_as_truth_are_called_that():
    recording, solution = fake_drive.make(reference=False)
    text = page(solution, recording, score(solution, recording))
    assert "Horizontal distance to the fixes" in text
    assert "in outages the withheld fixes" in text


def test_a_solution_that_knows_hardly_anything_still_makes_a_page():
    recording, solution = fake_drive.make(length=200.0, outages=((100.0, 130.0),))
    t = solution.trajectory
    nan = np.full_like
    bare = replace(
        t,
        v_n=nan(t.v_n, np.nan),
        euler=nan(t.euler, np.nan),
        sd=nan(t.sd, np.nan),
        horizontal=nan(t.horizontal, np.nan),
    )
    bare = replace(solution, trajectory=bare, states={}, states_sd={}, innovations={}, decisions=(), notes=())
    data = json.loads(Page(page(bare, recording, score(bare, recording))).data)
    assert data["track"]["ellipses"] == []


def test_what_was_noticed_heads_the_page(drive, html):
    recording, solution, scores = drive
    notice = Notice(300.0, 343.0, "position", f"position {HOSTILE} not believed", "silenced")
    text = page(replace(solution, notices=(notice,), verdict=f"Disturbed: {HOSTILE}."), recording, scores)
    words = " ".join(Page(text).words)
    assert words.index("Disturbed: ") < words.index("fused by the system")
    assert (
        words.index("Noticed on the way") < words.index(notice.text) < words.index("Noticed in the recording")
    )
    assert text.count("</script>") == 3
    assert 'class="verdict"' not in html
    assert "Noticed on the way" not in html
