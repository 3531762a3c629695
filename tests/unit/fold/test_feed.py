"""The order in which a navigator hears things: by arrival."""

from dataclasses import replace

import numpy as np
import pytest

from gapless.fold.feed import events
from gapless.simulate import Receiver, WheelSensor, simulate
from gapless.trip.events import ImuBlock

LOG = simulate("urban", "perfect", 20.0, 1, receiver=Receiver(rate=4.0), wheels=WheelSensor(rate=3.0))
OFFSETS = {"position": -0.15, "velocity": 0.3, "odometer": 0.07}


def told(feed):
    """Readings with the time that the IMU had reached when they came."""
    now, found = -np.inf, []
    for event in feed:
        if isinstance(event, ImuBlock):
            now = float(event.time[-1])
        else:
            found += [(now, r) for r in event]
    return found


def test_every_sample_once_and_in_order():
    blocks = [e for e in events(LOG, OFFSETS) if isinstance(e, ImuBlock)]
    whole = ImuBlock.join(blocks)
    for name in ("time", "dt", "dtheta", "dvel"):
        assert np.array_equal(getattr(whole, name), getattr(LOG.imu, name))
    assert min(len(b.time) for b in blocks) > 0


def test_readings_arrive_at_their_stamp_and_hold_at_their_offset():
    found = told(events(LOG, OFFSETS))
    for channel, stamps in (
        ("position", LOG.gnss.time),
        ("velocity", LOG.gnss.time),
        ("odometer", LOG.odometer.time),
    ):
        mine = [(now, r) for now, r in found if r.channel == channel]
        np.testing.assert_allclose([r.time for _, r in mine], stamps + OFFSETS[channel], rtol=0, atol=1e-12)
        # every sample stamped before the arrival has been felt, none after it
        for (now, _), stamp in zip(mine, stamps, strict=True):
            assert now < stamp <= now + 0.0101 or (now == -np.inf and stamp <= LOG.start)


def test_position_and_velocity_of_an_epoch_arrive_together():
    pairs = [e for e in events(LOG, OFFSETS) if not isinstance(e, ImuBlock) and len(e) == 2]
    assert len(pairs) == len(LOG.gnss)


@pytest.mark.parametrize("cut", [7.0, 7.25, 7.503])
def test_parts_make_the_whole(cut):
    whole = list(events(LOG, OFFSETS))
    parts = [*events(LOG, OFFSETS, end=cut), *events(LOG, OFFSETS, start=cut)]
    assert told(parts) != []
    assert [r.time for _, r in told(parts)] == [r.time for _, r in told(whole)]
    samples = [ImuBlock.join([e for e in feed if isinstance(e, ImuBlock)]) for feed in (parts, whole)]
    assert np.array_equal(samples[0].time, samples[1].time)


def test_half_a_fix_is_half_a_reading():
    v_n, lla = LOG.gnss.v_n.copy(), LOG.gnss.lla.copy()
    v_n[10:20], lla[15:25] = np.nan, np.nan
    log = replace(LOG, odometer=None, gnss=replace(LOG.gnss, v_n=v_n, lla=lla))
    found = [r.channel for _, r in told(events(log, {}))]
    assert found.count("position") == len(LOG.gnss) - 10
    assert found.count("velocity") == len(LOG.gnss) - 10


def test_intervals():
    gnss = LOG.gnss.take((LOG.gnss.time < 3.0) | (LOG.gnss.time > 17.9))
    found = [r for _, r in told(events(replace(LOG, gnss=gnss), {})) if r.channel == "position"]
    gaps = [r.interval for r in found]
    assert gaps[0] == 1.0
    np.testing.assert_allclose(gaps[1:12], 0.25, atol=1e-9)
    assert gaps[12] == 10.0, "an outage counts for ten seconds"


def test_thinning():
    times = [r.time for _, r in told(events(LOG, {}, thin=0.45)) if r.channel == "position"]
    assert np.diff(times).min() >= 0.449
    assert len(times) == 41
