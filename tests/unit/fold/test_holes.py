"""Holes in an IMU's log: bridged while they are short, doubted while they are long."""

from dataclasses import replace
from functools import cache

import numpy as np

from gapless import earth
from gapless.evaluation import score
from gapless.measurements.stillness import Stillness
from gapless.runs.fuse import fuse
from gapless.scenarios import Outage
from gapless.simulate import simulate
from gapless.units import DEG

OUTAGE = Outage(180.0, 230.0)


@cache
def drive():
    return simulate("urban", "consumer", 240.0, seed=8)


def without(*holes):
    log = drive()
    t = log.imu.time - log.start
    kept = np.ones(len(t), bool)
    for begin, seconds in holes:
        kept &= (t <= begin) | (t > begin + seconds + 1e-6)
    return replace(log, imu=log.imu.take(kept))


def worst(log):
    solution = fuse(log, outages=[OUTAGE])
    (one,) = score(solution, log).outages
    assert one.counts
    return one, solution.trajectory


def test_an_outage_with_short_holes_is_bridged_like_one_without():
    whole, _ = worst(drive())
    holed, rows = worst(without((185.0, 0.3), (195.0, 1.0), (204.0, 2.0)))
    # what a car may do in two seconds unseen, and its velocity keeps: a metre or two a second of it at worst
    assert holed.horizontal_max < whole.horizontal_max + 20.0
    assert holed.coverage_95 > 0.7
    outage = rows.slice(181.0, 229.0)
    assert np.allclose(np.diff(outage.time), 0.1, atol=0.011)  # rows in holes as everywhere
    assert holed.heading_max < 10.0 * DEG


def test_fixes_in_a_hole_wait_for_its_end_and_are_used():
    log = without((150.2, 1.9))
    told = fuse(log).innovations["position"]
    inside = (told.time > log.start + 150.2) & (told.time < log.start + 152.1)
    assert inside.sum() == 2
    assert np.isfinite(told.factor[inside]).all()


def test_a_long_hole_in_an_outage_keeps_the_heading_in_doubt():
    log = without((195.0, 4.0))
    rows = fuse(log, outages=[OUTAGE]).trajectory
    before, after, end = (
        rows.take(np.array([int(np.searchsorted(rows.time, t))])) for t in (194.9, 199.2, 229.9)
    )
    assert 3.0 * DEG < after.sd[0, 8] < 60.0 * DEG
    assert after.sd[0, 8] > before.sd[0, 8]
    truth = log.reference.take(np.array([int(np.searchsorted(log.reference.time, end.time[0]))]))
    off = earth.lla_to_ned(end.lla[0], truth.lla[0])[:2]
    nn, ee, ne = end.sd[0, 0] ** 2, end.sd[0, 1] ** 2, end.horizontal[0]
    d2 = (ee * off[0] ** 2 - 2.0 * ne * off[0] * off[1] + nn * off[1] ** 2) / (nn * ee - ne**2)
    assert d2 < 9.2  # 99 % of two degrees


def test_standing_must_last_anew_after_a_hole():
    rule = Stillness(filled=40, lasted=3.0)
    rule.lost()
    assert (rule.filled, rule.lasted) == (0, 0.0)
