"""Smoothing a whole recording: better than the filter, sure of itself no more than it may be, bits that do
not depend on how the way back is cut."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec.structs import replace as change

from gapless import earth
from gapless.errors import ConfigError
from gapless.evaluation import nees, score
from gapless.runs import smooth as module
from gapless.runs.fuse import fuse
from gapless.runs.smooth import smooth
from gapless.scenarios import plan
from gapless.simulate import Receiver, simulate
from gapless.systems.library import parse
from gapless.systems.recipe import Clock, System

WHITE = Receiver(
    position_white=(1.0, 1.0, 2.0), position_correlated=(0.0, 0.0, 0.0), velocity=(0.1, 0.1, 0.2)
)
BASE = System()
HONEST = change(
    BASE,
    sensors=("position", "velocity"),
    constraints=(),
    clock=Clock(0.0, 0.0, 0.0),
    gnss=change(BASE.gnss, wander=0.0, position_correlation=0.0, velocity_correlation=0.0, jitter=0.0),
)
"""Takes the receiver for what it is, so that errors have the size that is stated."""


@pytest.fixture(scope="module")
def drive():
    return simulate("urban", "liu2019", 300.0, 4, receiver=WHITE)


def errors(solution, log):
    """North, east, down at the rows that the truth has, and the covariance of the first two."""
    t, truth = solution.trajectory, log.reference
    k = np.searchsorted(truth.time, t.time - 1e-6)
    known = np.flatnonzero(np.abs(truth.time[np.minimum(k, len(truth) - 1)] - t.time) < 1e-6)
    error = np.array([earth.lla_to_ned(t.lla[i], truth.lla[k[i]]) for i in known])
    c = np.zeros((len(known), 2, 2))
    c[:, 0, 0], c[:, 1, 1] = t.sd[known, 0] ** 2, t.sd[known, 1] ** 2
    c[:, 0, 1] = c[:, 1, 0] = t.horizontal[known]
    return error, c


def test_outages_shrink(drive):
    outages = plan(["120:180"], drive.duration)
    before, after = (score(f(drive, outages=outages), drive) for f in (fuse, smooth))
    assert after.outages[0].horizontal_max < before.outages[0].horizontal_max
    assert after.aided.horizontal_rmse < before.aided.horizontal_rmse


def test_segments_change_no_bit(drive, monkeypatch):
    whole = {}
    for length in (1e9, 47.0):
        monkeypatch.setattr(module, "SEGMENT", length)
        whole[length] = smooth(drive, outages=plan(["120:180"], drive.duration))
    one, other = (s.trajectory for s in whole.values())
    for name in ("time", "lla", "v_n", "euler", "sd", "horizontal"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


def test_it_ends_where_the_filter_ends(drive):
    """At the last row nothing is later: the log ends between two fixes."""
    drive = drive.slice(-np.inf, 299.555)
    forward = fuse(drive, change(HONEST, filter=change(HONEST.filter, covariance_period=0.1)))
    back = smooth(drive, HONEST)
    assert np.abs(back.trajectory.v_n[-1] - forward.trajectory.v_n[-1]).max() < 1e-9
    assert np.allclose(back.trajectory.sd[-1], forward.trajectory.sd[-1], rtol=1e-9)


def test_deviations_are_as_large_as_the_errors():
    values = []
    for seed in range(1, 13):
        log = simulate("urban", "liu2019", 200.0, seed, receiver=WHITE)
        error, covariance = errors(smooth(log, HONEST, plan(["100:150"], log.duration)), log)
        values.append(nees(error[::50, :2], covariance[::50]))
    found = np.concatenate([v[np.isfinite(v)] for v in values])
    # 12 drives of some 30 moments, those of a drive alike over tens of seconds: some 60 independent values
    # of mean 2 and standard deviation 2, three of their mean's deviations
    assert abs(found.mean() - 2.0) < 3.0 * 2.0 / np.sqrt(60.0), found.mean()
    assert len(found) > 300


def test_a_hole_in_the_log_is_no_end(drive):
    logged = (drive.imu.time < 150.0) | (drive.imu.time > 162.0)
    torn = replace(drive, imu=drive.imu.take(logged))
    error, _ = errors(smooth(torn), torn)
    assert np.isfinite(error).all()
    assert np.hypot(error[-300:, 0], error[-300:, 1]).max() < 5.0


def test_what_it_cannot_do_is_said(drive):
    forward = change(BASE, filter=change(BASE.filter, correction="feedforward"))
    with pytest.raises(ConfigError, match="feedback"):
        smooth(drive, forward)
    with pytest.raises(ConfigError, match="10 rows a second at most"):
        smooth(drive, rate=50.0)


def test_it_says_that_it_looked_back(drive):
    assert smooth(drive, HONEST).decisions[0].name == "smoothing"


def recipe(text):
    return parse(text + "\n[clock]\nposition = 0.0\nvelocity = 0.0\n", "recipe")


def test_a_variational_cubature_smoother_is_a_recipe(drive):
    """VB-ACKS of georges2015, on a drive whose fixes are three times worse than they state."""
    worse = replace(drive, gnss=replace(drive.gnss, sd_position=drive.gnss.sd_position / 3.0))
    rmse = {}
    for name, rules in {"crts": '["gate"]', "vb-acks": '["variational"]'}.items():
        system = recipe(f'constraints = []\n[filter]\nmoments = "cubature"\n[adaptation]\ngnss = {rules}')
        for f in (fuse, smooth):
            error, _ = errors(f(worse, system), worse)
            rmse[name, f.__name__] = np.sqrt(np.mean(np.square(error[300:, :2])))
    assert rmse["vb-acks", "smooth"] < rmse["vb-acks", "fuse"]
    assert rmse["crts", "smooth"] < rmse["crts", "fuse"]
    assert rmse["vb-acks", "fuse"] < rmse["crts", "fuse"]


def test_a_fading_filter_is_smoothed_and_an_improved_one_refused(drive):
    fading = recipe('[adaptation]\ngnss = ["fading", "gate"]')
    error, _ = errors(smooth(drive, fading), drive)
    assert np.isfinite(error).all()
    assert np.sqrt(np.mean(np.square(error[300:, :2]))) < 1.5
    with pytest.raises(ConfigError, match=r"improved_fading does not take; leave it out of adaptation\.gnss"):
        smooth(drive, recipe('[adaptation]\ngnss = ["improved_fading"]'))
