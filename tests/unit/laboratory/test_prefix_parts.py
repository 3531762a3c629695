"""The parts of the prefix check: what is spoilt, where it looks, what counts as a difference."""

from dataclasses import replace

import numpy as np

from gapless.laboratory.prefix import first_difference, samples, spoil
from gapless.scenarios import Outage, plan, withhold
from gapless.trip.motion import offset_ned
from gapless.trip.recording import Trajectory


def rows(n=100):
    t = np.arange(n) / 10.0
    one = np.ones((n, 9))
    return Trajectory(t, one[:, :3], one[:, :3], one[:, :3], one, one[:, 0], np.full(n, "ins"))


def test_what_is_withheld_is_spoilt_and_nothing_else(late):
    outages = plan(["110:125", "150:165,effect=velocity", "190:200,effect=noisy"], late)
    spoilt = spoil(late, outages, np.random.default_rng(1))
    assert spoilt.reference is None
    moved = np.linalg.norm(offset_ned(spoilt.gnss.lla, late.gnss.lla), axis=1)
    faster = np.linalg.norm(spoilt.gnss.v_n - late.gnss.v_n, axis=1)
    t = late.gnss.time - late.start
    silent, slow = (t >= 110) & (t < 125), (t >= 150) & (t < 165)
    np.testing.assert_array_equal(moved > 0.0, silent | slow)
    np.testing.assert_array_equal(faster > 0.0, silent)
    assert np.median(moved[silent]) > 1000.0
    kept, left = (withhold(g, outages, late.start) for g in (late.gnss, spoilt.gnss))
    for name in ("time", "lla", "v_n", "sd_velocity"):
        np.testing.assert_array_equal(getattr(kept, name), getattr(left, name))


def test_the_first_the_last_and_three_more_are_looked_at():
    outage = Outage(2.0, 5.0)
    chosen = [samples(rows(), outage, 0.0, np.random.default_rng(s)) for s in range(30)]
    for times in chosen:
        assert (times[0], times[-1]) == (2.0, 4.9)
        assert 2 <= len(times) <= 5
        assert list(times) == sorted(set(times))
    assert len({t for times in chosen for t in times}) > 20
    assert samples(rows(), Outage(20.0, 30.0), 0.0, np.random.default_rng(0)) == ()


def test_a_difference_in_one_bit_of_one_row_is_found():
    a = rows()
    lla = a.lla.copy()
    lla[40, 1] = np.nextafter(lla[40, 1], 2.0)
    b = replace(a, lla=lla)
    assert first_difference(a, b, -np.inf, (9.0,)) == 4.0
    assert first_difference(a, b, -np.inf, (2.0, 3.9)) is None
    assert first_difference(a, b, 4.0, (9.0,)) is None
    assert first_difference(a, a, -np.inf, (9.0,)) is None


def test_a_missing_row_is_a_difference_and_unknown_values_are_not():
    a = rows()
    assert first_difference(a, a.take(slice(0, 40)), -np.inf, (9.0,)) == 4.0
    unknown = replace(a, euler=np.full((100, 3), np.nan))
    assert first_difference(unknown, unknown, -np.inf, (9.0,)) is None
    assert first_difference(a, unknown, -np.inf, (9.0,)) == 0.0
