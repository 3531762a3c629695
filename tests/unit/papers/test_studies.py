"""What papers show beside their drives, from inputs whose answers are known."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.papers import studies
from gapless.papers.drives import make
from gapless.papers.experiment import Reproduction
from gapless.papers.figures import figures
from gapless.papers.liu2019 import CHANNELS
from gapless.papers.model import Receiver, Window
from gapless.papers.tables import tables
from gapless.trip.motion import offset_ned

MILLIMETRE = (0.001, 0.001, 0.001)
EXACT = Receiver(
    position_white=MILLIMETRE, position_correlated=(0.0, 0.0, 0.0), velocity=MILLIMETRE, stated=1.0
)


@pytest.fixture(scope="module")
def short(small):
    one = small.experiments[0]
    return replace(one, drive=replace(one.drive, grade="perfect", receiver=EXACT))


def test_increments_are_how_far_the_car_went(short):
    recording = make(short.drive, 1)
    x, y = studies._increments(recording, 60.0, 110.0)
    truth = recording.reference
    at = [int(np.searchsorted(truth.time, t - 1e-6)) for t in recording.gnss.time]
    first = int(np.searchsorted(recording.gnss.time, recording.start + 60.0))
    rows = np.array(at[first : first + len(y) + 1])
    want = offset_ned(truth.lla[rows[1:]], truth.lla[rows[:-1]])
    assert np.allclose(y, want, atol=0.008)  # two fixes of 1 mm: five sigma
    k, imu = 7, recording.imu
    begin, end = recording.gnss.time[first + k], recording.gnss.time[first + k + 1]
    inside = (imu.time > begin + 1e-6) & (imu.time <= end + 1e-6)
    assert x[k] == pytest.approx([*imu.dvel[inside].sum(axis=0), *imu.dtheta[inside].sum(axis=0)])


def test_an_ins_runs_free_from_where_it_is_left(short):
    recording = make(short.drive, 1)
    x, y = studies._free_running(short, recording, 80.0, 130.0)
    assert x.shape == (50, 6)
    assert np.hypot(x[:, 0], x[:, 1]) == pytest.approx(1.0)
    # no sensor errs: what is left comes of the attitude at 80 s, found from fixes of a millimetre
    assert np.abs(y[0, 2:]).max() < 0.01
    assert np.abs(y[0, 2:]).max() < np.abs(y[-1, 2:]).max() < 50.0


@pytest.fixture(scope="module")
def done(small, monkeypatch_module):
    one = small.experiments[0]
    lying = replace(one, drive=replace(one.drive, windows=(Window("GNSS on", 60.0, 100.0, withheld=False),)))
    found = {name: studies.STUDIES[name](lying) for name in ("denoised", "fitness")}
    return Reproduction(small, (), 0.0, found, {"convergence": "not today"})


@pytest.fixture(scope="module")
def monkeypatch_module():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(studies, "FROM", 60.0)
        patch.setattr(studies, "UNTIL", 80.0)
        patch.setattr(studies, "GENERATIONS", 3)
        yield patch


def test_denoising_is_set_beside_table_2(done):
    found = done.studies["denoised"]
    assert found.raw.shape == found.denoised.shape == (6, 1000)
    raw, clean = np.array(found.ratios["raw"]), np.array(found.ratios["EMD"])
    assert (clean[3:] > raw[3:] + 3.0).all()  # consumer gyros: noise over motion, 3 dB is half of it
    table = next(t for t in tables(done) if t.title.startswith("Table 2"))
    assert table.rows[0][:2] == ("raw", "-11.4")
    assert len(table.head) == 1 + 2 * len(CHANNELS)


def test_a_search_never_gets_worse_at_its_best_seen(done):
    history = done.studies["fitness"].history
    assert list(history) == ["north", "east", "down"]
    for of in history.values():
        assert of.shape == (3, 2)
        assert (of[:, 0] <= of[:, 1]).all()


def test_studies_are_drawn_and_what_was_not_done_is_said(done):
    assert set(figures(done)) == {"denoised", "fitness"}
    told = next(t for t in tables(done) if t.title == "Not shown")
    assert told.rows == (("convergence", "not today"),)


def test_a_larger_network_fits_better(small, monkeypatch):
    monkeypatch.setattr(studies, "NODES", (2, 20))
    monkeypatch.setattr(studies, "_free_running", lambda *_: _wave())
    found = studies.convergence(small.experiments[0])
    for misfit in found.misfit.values():
        assert misfit[1] < 0.5 * misfit[0]


def _wave():
    t = np.linspace(0.0, 1.0, 200)
    x = np.column_stack([t, t**2, np.sin(3.0 * t), np.cos(3.0 * t), t, t])
    return x, np.column_stack([np.sin(5.0 * t), np.cos(4.0 * t), t**3, np.sin(2.0 * t)])
