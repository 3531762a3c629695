"""What real logs are full of: mended, said, and never with the help of later rows."""

import numpy as np
import pytest

from gapless import io
from gapless.io.clock import HEAD, even_stamps, nominal_interval

pd = pytest.importorskip("pandas")


def read(drive, **kwargs):
    frames = {k: v if isinstance(v, pd.DataFrame) else pd.DataFrame(v) for k, v in drive.items()}
    return io.recording_from_frames(**frames, **kwargs)


def says(recording, words):
    return [note for note in recording.notes if words in note.what]


def ticks(rate=100.03, tick=0.01, n=20_000, burst=1):
    """True sampling times, and what a clock that ticks every `tick` s stamps them with."""
    true = 50.0 + np.arange(n) / rate
    stamped = np.floor(true / tick) * tick
    return true, np.repeat(stamped[::burst], burst)[:n]


@pytest.mark.parametrize(("rate", "tick"), [(100.03, 0.01), (200.0, 0.01), (104.0, 0.01), (100.0, 0.05)])
def test_ticks_become_even(rate, tick):
    true, stamped = ticks(rate, tick)
    mended, begin = even_stamps(stamped, nominal_interval(stamped))
    assert begin < 5000
    settled = slice(begin + 500, None)  # ten time constants of 1 / GAIN = 50 samples
    error = mended[settled] - true[settled]
    step = np.diff(mended[settled])
    assert (np.diff(mended) > 0.0).all()
    # the constant part (half a tick) belongs to the clock offset; the rest is the filter's jitter,
    # about q sqrt(GAIN / 24) where ticks hit at random, more where they beat slowly: a third of a tick
    assert np.std(error) < tick / 3.0
    assert np.abs(error).max() < 1.1 * tick
    assert step.max() < 1.6 / rate  # as against two whole ticks


def test_tick_mending_is_causal():
    _, stamped = ticks()
    whole, _ = even_stamps(stamped, nominal_interval(stamped))
    for end in (HEAD + 1, 5001, 12_345):
        part, _ = even_stamps(stamped[:end], nominal_interval(stamped[:end]))
        np.testing.assert_array_equal(part, whole[:end])


def test_gap_in_ticks_is_jumped():
    _, stamped = ticks()
    stamped[15_000:] += 7.0
    mended, _ = even_stamps(stamped, nominal_interval(stamped))
    assert abs(mended[15_000] - stamped[15_000]) < 1e-9
    assert 6.9 < mended[15_000] - mended[14_999] < 7.1


def test_one_repeated_stamp(drive):
    drive["imu"]["time"][5000] = drive["imu"]["time"][4999]
    r = read(drive)
    assert (r.imu.dt > 0.0).all()
    assert says(r, "1 stamps repeat")
    # the clock was right before and after: it stays within an interval of it
    np.testing.assert_allclose(r.imu.time, 1000.0 + np.arange(1, 10001) / 100.0, atol=0.0101)
    np.testing.assert_allclose(r.imu.time[6000:], 1000.0 + np.arange(6001, 10001) / 100.0, atol=1e-6)


def test_reading_is_causal(drive):
    imu = drive["imu"]
    imu["time"] = np.floor(imu["time"] / 0.013) * 0.013  # ticks
    imu["gyro_x"][[2000, 4000]] = np.nan
    imu["accel_y"][3000] = 1e6
    imu["time"][7000:] += 3.0
    whole = read(drive)
    for end in (1500, 3002, 7001, 9000):
        part = read(
            drive | {"imu": pd.DataFrame(imu).iloc[:end], "gnss": pd.DataFrame(drive["gnss"]).iloc[:300]}
        )
        n = len(part.imu)
        for name in ("time", "dt", "dtheta", "dvel"):
            np.testing.assert_array_equal(getattr(part.imu, name), getattr(whole.imu, name)[:n])
        np.testing.assert_array_equal(part.gnss.lla, whole.gnss.lla[:300])


def test_row_without_value_is_bridged(drive):
    drive["imu"]["gyro_y"][[100, 200, 201]] = np.nan
    drive["imu"]["accel_z"][300] = np.inf
    r = read(drive)
    assert len(r.imu) == 9996
    assert says(r, "without a value")[0].count == 4
    # no time is lost: 1e-9 s covers the rounding of 10,000 stamps of 1e3 s
    assert abs(r.imu.dt.sum() - 100.0) < 1e-9
    assert abs(r.imu.dt[199] - 0.03) < 1e-9  # rows 200, 201 and 202 of the log


def test_holes_and_gaps_are_left_open_and_short_silence_covered(drive):
    drive["imu"]["time"][2000:] += 0.08
    drive["imu"]["time"][4000:] += 0.3
    drive["imu"]["time"][6000:] += 5.0
    r = read(drive)
    start = r.imu.time - r.imu.dt
    opened = np.flatnonzero(start[1:] - r.imu.time[:-1] > 1e-6) + 1
    assert opened.tolist() == [4000, 6000]
    np.testing.assert_allclose(r.imu.dt[[4000, 6000]], 0.01, atol=1e-9)
    assert abs(r.imu.dt[2000] - 0.09) < 1e-9
    assert says(r, "holes, 0.3 s in all, the longest 0.31 s; bridged")[0].count == 1
    assert says(r, "gaps, 5.0 s in all")[0].count == 1
    assert says(r, "covered by the next")[0].count == 1


def test_jitter_is_said(drive):
    drive["imu"]["time"] += np.random.default_rng(1).uniform(0.0, 0.002, 10_000)
    r = read(drive)
    np.testing.assert_array_equal(r.imu.time, drive["imu"]["time"])
    assert says(r, "taken as stamped")


def test_repeated_rows_and_spikes_are_dropped(drive):
    imu = pd.DataFrame(drive["imu"])
    imu = pd.concat([imu.iloc[:501], imu.iloc[500:]], ignore_index=True)
    imu.loc[800, "gyro_z"] = 5000.0
    r = read(drive | {"imu": imu})
    assert len(r.imu) == 9999
    assert says(r, "repeat one before")[0].count == 1
    assert says(r, "impossible values")[0].count == 1


def test_standard_deviations(drive):
    gnss = drive["gnss"]
    gnss["fix"][:] = np.repeat([1, 2, 4, 5, 3], 100)[: len(gnss["time"])]
    gnss["sd_north"][:4] = [0.0, np.nan, -1.0, 9999.0]
    gnss["sd_down"][250] = 0.0
    gnss["sd_east"][251] = 1e-4
    gnss["sd_v_north"][:3] = [0.0, np.nan, 0.001]
    r = read(drive)
    np.testing.assert_array_equal(r.gnss.sd_position[:5, 0], [3.0, 3.0, 3.0, 3.0, 1.5])
    assert (r.gnss.sd_position[250, 2], r.gnss.sd_position[251, 1]) == (0.04, 0.005)
    np.testing.assert_array_equal(r.gnss.sd_velocity[:4, 0], [0.1, 0.1, 0.02, 0.1])
    assert set(r.gnss.fix) == {1, 2, 4, 5}
    assert [n.count for n in says(r, "missing, zero or absurd")] == [5, 2]
    assert [n.count for n in says(r, "raised to it")] == [1, 1]


def test_fixes_without_position_or_code(drive):
    gnss = drive["gnss"]
    gnss["lat"][10] = np.nan  # a velocity is left
    gnss["lat"][11] = gnss["v_east"][11] = np.nan
    gnss["fix"][[12, 13]] = [0, 6]  # none; dead reckoned
    gnss["fix"][14] = np.nan
    gnss["lat"][15], gnss["lon"][15], gnss["v_down"][15] = 0.0, 0.0, np.nan
    r = read(drive)
    assert len(r.gnss) == len(gnss["time"]) - 4
    assert np.isnan(r.gnss.lla[10]).all()
    assert np.isfinite(r.gnss.v_n[10]).all()
    assert says(r, "without a usable fix")[0].count == 4
    assert says(r, "without a fix code")[0].count == 1
    del gnss["fix"]
    assert says(read(drive), "no fix code")[0].count == len(gnss["time"])


def test_fixes_out_of_order_are_dropped(drive):
    time = drive["gnss"]["time"]
    time[50] = time[49]  # an epoch twice
    time[100] = time[90]  # one that comes late
    time[200] = 99_999.0  # one from a clock that jumped, and came back
    r = read(drive)
    assert len(r.gnss) == len(time) - 3
    assert (np.diff(r.gnss.time) > 0.0).all()
    assert r.gnss.time[-1] == time[-1]
    assert says(r, "repeats with other values")[0].count == 1
    assert says(r, "out of line with those around it")[0].count == 2


def test_velocity_spikes_are_left_to_the_gate(drive):
    drive["gnss"]["v_north"][::40] += 400.0
    r = read(drive)
    assert r.gnss.v_n[40, 0] > 390.0


def test_given_intervals_are_kept_and_lost_rows_bridged(drive):
    rng = np.random.default_rng(3)
    drive["imu"]["dt"] = 0.01 - rng.uniform(0.0, 1e-4, 10_000)
    drive["imu"]["gyro_x"][[400, 401]] = np.nan
    r = read(drive)
    expected = np.delete(drive["imu"]["dt"], [400, 401])
    expected[400] = drive["imu"]["time"][402] - drive["imu"]["time"][399]
    np.testing.assert_array_equal(r.imu.dt, expected)
