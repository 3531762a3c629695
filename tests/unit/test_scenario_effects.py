"""What an outage leaves of the fixes, and where outages are found in a drive."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gapless import earth
from gapless.errors import ConfigError
from gapless.scenarios import KINDS, At, Effect, Gaps, Outage, Periodic, Random, parse, plan, withhold
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Gnss, Imu, Recording

ORIGIN = np.array([0.77, 2.0, 50.0])
START = 1000.0


def log(speed, rate=10.0, yaw_rate=None):
    """A receiver at `rate` and a silent IMU, from a speed [m/s] and a rate of turn [rad/s] over time."""
    n = len(speed)
    t = START + np.arange(n) / rate
    course = np.cumsum(np.zeros(n) if yaw_rate is None else yaw_rate) / rate
    v_n = np.column_stack([speed * np.cos(course), speed * np.sin(course), 0.0 * t])
    lla = earth.ned_to_lla(np.cumsum(v_n, axis=0) / rate, ORIGIN)
    one = np.ones((n, 3))
    zero = np.zeros((n, 3))
    return Recording("drive", Imu.from_rates(t, zero, zero), Gnss(t, lla, one, v_n, one, np.ones(n, int)))


@pytest.fixture
def steady():
    return log(np.full(1200, 10.0))


def apart(one, other):
    return offset_ned(one.lla, other.lla)


def struck(gnss, text):
    return withhold(gnss, [parse(text)], START)


def test_noise_has_the_size_asked_for_and_stays_inside(steady):
    found = struck(steady.gnss, "20:100,effect=noisy:30")
    error = apart(found, steady.gnss)
    inside = (found.time >= START + 20) & (found.time < START + 100)
    # 2,400 values: the sample deviation is within 4 / sqrt(2 n) = 6 % with all but 1e-4 of chance
    assert np.std(error[inside]) == pytest.approx(30.0, rel=0.06)
    assert np.abs(error[~inside]).max() == 0.0
    assert np.std((found.v_n - steady.gnss.v_n)[inside]) == pytest.approx(3.0, rel=0.06)
    np.testing.assert_array_equal(found.sd_position, steady.gnss.sd_position)


def test_a_bias_is_one_vector(steady):
    error = apart(struck(steady.gnss, "20:100,effect=biased"), steady.gnss)[200:1000]
    # m: the metres are turned into angles at each fix's own latitude, 1 km apart
    np.testing.assert_allclose(np.linalg.norm(error, axis=1), 20.0, atol=1e-3)
    assert np.ptp(error, axis=0).max() < 0.01


def test_thinned_leaves_two_a_second(steady):
    found = struck(steady.gnss, "20:100,effect=thinned")
    inside = found.slice(START + 20, START + 100)
    assert len(inside) == 160
    np.testing.assert_allclose(np.diff(inside.time), 0.5, atol=1e-9)
    assert len(found) == 1200 - 800 + 160
    slow = replace(steady, gnss=steady.gnss.take(slice(None, None, 10)))
    assert len(struck(slow.gnss, "20:100,effect=thinned")) == len(slow.gnss)  # 1 Hz is below 2 Hz already


def test_velocity_only(steady):
    found = struck(steady.gnss, "20:100,effect=velocity")
    assert np.isnan(found.lla[200:1000]).all()
    assert np.isfinite(found.lla[1000:]).all()
    np.testing.assert_array_equal(found.v_n, steady.gnss.v_n)


def test_spikes_are_the_last_fix_before_and_the_first_three_after(steady):
    found = struck(steady.gnss, "20:100,effect=spiked:50")
    assert not len(found.slice(START + 20, START + 100))
    kept = steady.gnss.take(np.r_[0:200, 1000:1200])
    jumped = np.linalg.norm(apart(found, kept), axis=1)
    assert np.flatnonzero(jumped > 0.0).tolist() == [199, 200, 201, 202]
    np.testing.assert_allclose(jumped[199:203], 50.0, atol=1e-3)  # m, second order of the displacement


def test_an_outage_that_the_log_has_not_come_to_touches_nothing(steady):
    early = steady.gnss.slice(0.0, START + 60.0)
    for kind in sorted(set(KINDS) - {"real"}):
        np.testing.assert_array_equal(struck(early, f"80:100,effect={kind}").lla, early.lla)


def test_a_fix_that_returns_wrong_stays_wrong_for_ten_seconds(steady):
    found = struck(steady.gnss, "20:100,effect=wrong")
    kept = steady.gnss.take(np.r_[0:200, 1000:1200])
    error = np.linalg.norm(apart(found, kept), axis=1)
    assert np.flatnonzero(error > 0.0).tolist() == list(range(200, 300))
    np.testing.assert_allclose(error[200:300], 20.0, atol=1e-3)
    assert parse("20:100,effect=wrong").until == 110.0
    assert parse("20:100").until == 100.0


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"silent", "real"}))
def test_an_effect_depends_on_seed_and_start_alone_and_on_nothing_later(steady, kind):
    text = f"20:100,effect={kind}"
    whole = struck(steady.gnss, text)
    again = withhold(steady.gnss, [parse("110:115"), parse(text)], START)
    cut = struck(steady.gnss.slice(0.0, START + 60.0), text)
    outage = parse(text)
    reseeded = replace(outage, effect=replace(outage.effect, seed=1))
    other = withhold(steady.gnss, [reseeded], START)
    n = int(np.searchsorted(whole.time, START + 100.0))
    for name in ("time", "lla", "v_n"):
        a, b, c = (getattr(g, name) for g in (whole, again, cut))
        np.testing.assert_array_equal(a[:n], b[:n])
        np.testing.assert_array_equal(a[: len(c)], c)
    draws = kind in ("noisy", "biased", "spiked", "wrong")
    assert np.array_equal(whole.lla, other.lla, equal_nan=True) is not draws


@given(
    every=st.floats(20.0, 400.0),
    share=st.floats(0.05, 1.0),
    first=st.floats(0.0, 500.0),
    seed=st.integers(0, 2**31),
    duration=st.floats(10.0, 4000.0),
)
def test_random_outages_fit_and_keep_apart(every, share, first, seed, duration):
    random = Random(every, share * every, first, seed)
    found = random.expand(duration)
    assert len(found) == max(0, int((duration - first) // every))
    assert random.expand(duration) == found
    slack = 2e-3  # s: starts are rounded to the millisecond
    for a, b in pairwise(found):
        assert b.start >= a.end + min(30.0, 0.5 * (every - random.length)) - slack
    if found:
        assert found[0].start >= first - slack
        assert found[-1].end <= duration + slack


def test_seeds_differ_and_starts_are_spread_evenly():
    assert Random(180.0, 60.0, 240.0, 1).expand(2000.0) != Random(180.0, 60.0, 240.0, 2).expand(2000.0)
    starts = [o.start for s in range(400) for o in Random(100.0, 20.0, 0.0, s).expand(1000.0)]
    # ten starts in each of 400 plans: by symmetry their mean is the middle, 490; sd below 300 / sqrt(4000)
    assert np.mean(starts) == pytest.approx(490.0, abs=4 * 300 / np.sqrt(4000))


def test_real_gaps_are_found_and_nothing_is_withheld(steady):
    keep = np.r_[0:200, 260:500, 503:1200]
    gnss = steady.gnss.take(keep)
    lla = gnss.lla.copy()
    lla[(gnss.time >= START + 80) & (gnss.time < START + 88)] = np.nan
    drive = replace(steady, gnss=replace(gnss, lla=lla))
    found = plan(["gaps=5"], drive)
    assert [(round(o.start, 6), round(o.end, 6)) for o in found] == [(20.0, 26.0), (80.0, 88.0)]
    left = withhold(drive.gnss, found, START)
    np.testing.assert_array_equal(left.time, drive.gnss.time)
    with pytest.raises(ConfigError, match="no outage fits"):
        plan(["gaps=9"], drive)


def test_outages_begin_in_turns_at_stops_and_at_speed():
    speed = np.full(3000, 10.0)
    speed[500:700] = 0.0
    speed[2000:2500] = 20.0
    turn = np.zeros(3000)
    turn[1000:1060] = turn[1500:1560] = np.radians(15.0)
    drive = log(speed, yaw_rate=turn)
    (stop,) = plan(["at=stop,every=100,length=30,first=0"], drive)
    # the second from 51 s on: two seconds after the car stood
    assert stop.start == pytest.approx(51.9, abs=0.15)
    turns = plan(["at=turn,every=20,length=10,first=20"], drive)
    # half of 8 deg/s over two seconds is enough, so up to a second before the turn
    assert [o.start for o in turns] == pytest.approx([100.0, 150.0], abs=1.0)
    fast = plan(["at=speed,every=30,length=10,first=20"], drive)
    assert [o.start for o in fast] == pytest.approx([200.0, 230.0], abs=0.15)


@pytest.mark.parametrize(
    "text",
    [
        "240:300.5",
        "1234.5678:1300.25,effect=wrong:15",
        "every=180,length=60,first=240,shift=60,effect=noisy:10",
        "random=180,length=60,first=240,seed=7",
        "random=180,length=60,first=240,seed=0,effect=spiked:80",
        "at=stop,every=180,length=60,first=240,effect=velocity",
        "1:2,effect=noisy:10:3",
        "gaps=5",
    ],
)
def test_plans_are_written_as_they_are_read(text):
    assert str(parse(text)) == text
    assert parse(str(parse(text))) == parse(text)


def test_an_effect_without_a_size_takes_the_default():
    assert parse("1:2,effect=noisy").effect == Effect("noisy", 10.0)
    assert parse("1:2,effect=velocity").effect == Effect("velocity")
    assert parse("every=9,length=3,first=1") == Periodic(9.0, 3.0, 1.0)
    assert parse("at=turn,every=9,length=3,first=1") == At("turn", 9.0, 3.0, 1.0)
    assert parse("gaps=2") == Gaps(2.0)
    assert str(Outage(1.0, 2.0)) == "1:2"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1:2,effect=fog", "'fog' is unknown; write effect=silent|noisy"),
        ("1:2,effect=real", "'real' is unknown"),
        ("1:2,effect=velocity:3", "has no size"),
        ("1:2,effect=noisy:0", "above zero"),
        ("1:2,effect=noisy:x", "'x' is not a number"),
        ("1:2,effect=noisy:1:2.5", "seed 2.5 is not a whole number"),
        ("1:2,effect=noisy:1:2:3", "at most a seed"),
        ("1:2,size=3", "'size' is unknown here"),
        ("random=180,length=60", "first missing"),
        ("random=180,length=60,first=240,seed=1.5", "not a whole number"),
        ("random=60,length=61,first=240", "overlap"),
        ("at=roof,every=180,length=60,first=240", "at=turn|stop|speed"),
        ("at=turn,length=60,first=240", "every missing"),
        ("gaps=0", "above zero"),
        ("gaps=5,effect=noisy", "nothing is withheld"),
        ("gaps=5,every=3", "'every' is unknown here"),
        ("length=60,first=240", "make no plan"),
    ],
)
def test_slips_are_refused_in_one_line(text, says):
    with pytest.raises(ConfigError) as caught:
        parse(text)
    assert says in str(caught.value)
    assert repr(text) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["gaps=5", "at=stop,every=180,length=60,first=240"])
def test_a_plan_that_looks_into_the_recording_needs_it(text):
    with pytest.raises(ConfigError, match="give the recording, not its duration"):
        plan([text], 900.0)
