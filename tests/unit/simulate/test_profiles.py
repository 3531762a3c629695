import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.errors import ConfigError
from gapless.simulate import PROFILES, Path, drive, profile, rates
from gapless.simulate.profiles import KMH, fit
from gapless.units import DEG


def test_wang2018_reaches_the_speeds_of_its_table():
    path = drive("wang2018", 1800.0)
    assert path.duration == 784.0
    at = np.array([3.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 780.0])
    assert_allclose(path.speed(at), [0.0, 18.0, 8.0, 8.0, 17.0, 8.0, 8.0, 0.0], atol=1e-12)
    assert_allclose(
        path.heading(np.array([100.0, 300.0, 780.0])), np.array([45.0, 135.0, 225.0]) * DEG, atol=1e-12
    )


@pytest.mark.parametrize("name", sorted(PROFILES))
def test_profiles_keep_time_and_start_at_rest(name):
    segments = profile(name)(400.0, np.random.default_rng(3))
    assert_allclose(sum(s.duration for s in segments), 400.0, atol=1e-9)
    path = Path.from_segments(segments, (0.5, 0.5, 0.0))
    t = np.linspace(0.0, 400.0, 8001)
    assert path.speed(t).min() > -1e-9
    assert_allclose(path.speed(np.linspace(0.0, 4.0, 9)), 0.0)
    omega, f = rates(path, t)
    assert np.abs(f[:2]).max() < 5.0  # half a g: what tyres and passengers stand
    assert np.abs(f[2] + 9.8).max() < 2.5
    assert np.abs(omega).max() < 60.0 * DEG


def test_urban_stops_and_turns_within_its_speeds():
    path = drive("urban", 1800.0, seed=2)
    t = np.arange(0.0, 1800.0, 0.1)
    v = path.speed(t)
    assert 30.0 * KMH < v.max() <= 60.0 * KMH + 1e-9
    stops = np.flatnonzero(np.diff((v < 1e-6).astype(int)) == 1)
    assert len(stops) >= 10
    assert np.ptp(path.heading(t)) > np.pi
    assert np.abs(path.pitch(t)).max() <= 0.04 + 1e-12


def test_highway_runs_between_its_speeds():
    path = drive("highway", 900.0, seed=4)
    v = path.speed(np.arange(120.0, 900.0, 0.5))
    assert v.min() >= 69.9 * KMH
    assert v.max() <= 120.1 * KMH


def test_the_seed_is_the_drive():
    t = np.linspace(0.0, 300.0, 50)
    assert np.array_equal(drive("urban", 300.0, 5).position(t), drive("urban", 300.0, 5).position(t))
    assert not np.array_equal(drive("urban", 300.0, 5).position(t), drive("urban", 300.0, 6).position(t))


def test_fit_cuts_the_last_segment():
    segments = profile("wang2018")(26.0, np.random.default_rng(0))
    assert [s.duration for s in segments] == [5.0, 20.0, 1.0]
    assert fit(segments, 100.0) == segments


def test_unknown_profile_names_the_known_ones():
    with pytest.raises(ConfigError, match=r"no profile 'moon'.*urban"):
        profile("moon")
