"""A score is had of any solution: what is no covariance holds nothing, and is counted."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from gapless.evaluation import nees, score
from gapless.reports import summarise
from gapless.reports.terminal import summary_lines
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate import simulate
from gapless.systems.recipe import System


@pytest.fixture(scope="module")
def run():
    drive = simulate("urban", "consumer", 120.0, 1)
    return drive, fuse(drive, System(), [Outage(80.0, 100.0)])


ROWS = slice(200, 500)


def stated(solution, what, value, rows=ROWS):
    path = solution.trajectory
    column = getattr(path, what).copy()
    column[rows] = value
    return replace(solution, trajectory=replace(path, **{what: column}))


@pytest.mark.parametrize("value", [np.nan, np.inf, 0.0, 1e38, 1e200, 1e-200])
def test_a_deviation_that_is_none_holds_nothing(run, value):
    drive, solution = run
    whole, part = score(solution, drive), score(stated(solution, "sd", value), drive)
    assert whole.unstated == 0
    assert 250 < part.unstated < 350  # truth at 10 Hz, between rows at 10 Hz
    assert part.aided.coverage < whole.aided.coverage - 0.1
    assert np.isfinite(part.aided.nees.mean)
    text = " ".join(" ".join(summary_lines(summarise(stated(solution, "sd", value), part))).split())
    assert f"{part.unstated} epochs state no covariance" in text
    assert "state no covariance" not in " ".join(summary_lines(summarise(solution, whole)))


def test_one_that_is_singular_too(run):
    drive, solution = run
    sd = solution.trajectory.sd
    found = score(stated(solution, "horizontal", (sd[:, 0] * sd[:, 1])[ROWS]), drive)
    assert found.unstated > 250


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e38, 1e300])
@pytest.mark.parametrize("what", ["lla", "v_n", "euler", "sd", "horizontal"])
@pytest.mark.parametrize("rows", [ROWS, slice(None)], ids=["some", "all"])
def test_nothing_ends_in_a_traceback(run, what, value, rows):
    drive, solution = run
    odd = stated(solution, what, value, rows)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for truth in (drive, replace(drive, reference=None)):
            summarise(odd, score(odd, truth))


def test_size_alone_makes_nothing_singular():
    """Correlations are looked at, so units do not matter."""
    rng = np.random.default_rng(2)
    e, c = rng.standard_normal((50, 2)), np.array([[2.0, 0.5], [0.5, 1.0]])
    plain = nees(e, np.tile(c, (50, 1, 1)))
    for scale in (1e-30, 1e6, 1e30):
        np.testing.assert_allclose(nees(scale * e, np.tile(scale**2 * c, (50, 1, 1))), plain, rtol=1e-12)
