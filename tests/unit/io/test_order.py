"""Rows out of order: late ones put in their place, copies and stray stamps dropped, anything else refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gapless.errors import RecordingError
from gapless.io.log import Log
from gapless.io.order import in_order, one_an_epoch


def log(time, **columns):
    time = np.asarray(time, float)
    return Log("imu.csv", {"time": time, "x": np.arange(len(time)) * 1.0, **columns}, first_row=2)


def ordered(given_log):
    notes = []
    return in_order(given_log, notes), {note.what.split(",")[0]: note.count for note in notes}


def refusal(given_log):
    with pytest.raises(RecordingError) as error:
        in_order(given_log, [])
    line = str(error.value)
    assert "\n" not in line
    assert "sort" not in line  # it would shuffle two stretches of time into one
    return line


GRIDS = {
    "even": lambda n: 0.01 * np.arange(n),
    "jittered": lambda n: 0.01 * (np.arange(n) + np.random.default_rng(2).uniform(-0.3, 0.3, n)),
    "with gaps": lambda n: 0.01 * np.arange(n) + 7.0 * (np.arange(n) > 50) + 60.0 * (np.arange(n) > 200),
    "one a second": lambda n: 1e9 + np.arange(n),
}


@pytest.mark.parametrize("grid", GRIDS)
@settings(max_examples=40, deadline=None)
@given(st.sets(st.integers(0, 149), max_size=8))
def test_few_neighbours_exchanged_change_nothing(grid, pairs):
    """First and last rows too; no row takes part in two exchanges."""
    whole = log(GRIDS[grid](300))
    rows = np.arange(300)
    for k in pairs:
        rows[[2 * k, 2 * k + 1]] = rows[[2 * k + 1, 2 * k]]
    found, notes = ordered(whole.take(rows))
    for name in ("time", "x"):
        np.testing.assert_array_equal(found[name], whole[name])
    np.testing.assert_array_equal(found.rows, whole.take(np.arange(300)).rows)
    assert sum(notes.values()) == 2 * len(pairs)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 280), st.integers(2, 9))
def test_a_row_that_comes_late_is_put_where_its_hole_is(k, late):
    whole = log(0.01 * np.arange(300))
    rows = np.insert(np.delete(np.arange(300), k), k + late, k)
    found, _ = ordered(whole.take(rows))
    np.testing.assert_array_equal(found["x"], whole["x"])


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 297), st.one_of(st.integers(2, 250), st.floats(1.3, 250.0)))
def test_a_clock_set_back_is_never_mended(k, by):
    """By so many intervals: nearer than 1.3 a row looks like a stray one, and by one like a tick."""
    time = np.arange(300.0) - by * (np.arange(300) >= k)
    assert f"imu.csv:{k + 2}: the clock starts anew or was set back" in refusal(log(time))


@pytest.mark.parametrize("tail", [2, 3, 10])
def test_a_restart_shortly_before_the_end(tail):
    time = np.arange(300.0)
    time[-tail:] -= time[-tail]
    assert f"imu.csv:{302 - tail}: the clock starts anew" in refusal(log(time))


def test_rows_to_part_a_log_at_are_named():
    time = np.concatenate([np.arange(100.0), np.arange(50.0), np.arange(70.0)])
    assert "rows 2 to 101, 102 to 151, 152 to 221 are drives apart" in refusal(log(time))


@pytest.mark.parametrize(
    "rows",
    [
        np.repeat(np.arange(300), 2),
        np.tile(np.arange(300), 2),
        np.append(np.arange(300), np.arange(100, 300)),
    ],
    ids=["each twice", "the whole file twice", "its end twice"],
)
def test_the_same_rows_twice(rows):
    whole = log(0.01 * np.arange(300), y=np.where(np.arange(300) % 3, np.nan, 1.0))
    found, notes = ordered(whole.take(rows))
    np.testing.assert_array_equal(found["x"], whole["x"])
    assert notes == {"rows that repeat one before dropped": len(rows) - 300}


def test_single_stray_stamps_are_dropped():
    time = 0.01 * np.arange(300)
    time[[50, 120, 200]] = [1e9, -40.0, time[150]]
    found, notes = ordered(log(time))
    np.testing.assert_array_equal(found["x"], np.delete(np.arange(300.0), [50, 120, 200]))
    assert notes == {"rows whose stamp is out of line with those around it dropped": 3}


def test_two_clocks_in_one_file():
    time = np.column_stack([np.arange(300.0), 5000.0 + np.arange(300.0)]).ravel()
    assert "rows of two devices or two runs stand among each other: keep those of one" in refusal(log(time))


def test_stamps_at_random():
    assert "goes back again and again" in refusal(log(np.random.default_rng(1).permutation(300)))


def test_coarse_ticks_are_left_to_the_clock_filter():
    time = np.floor(np.arange(300) / 3.0)
    found, notes = ordered(log(time))
    np.testing.assert_array_equal(found["time"], time)
    assert not notes


def test_epochs_with_two_rows():
    time = np.arange(100.0)
    time[[10, 20]] = time[[9, 19]]
    notes = []
    assert len(one_an_epoch(log(time), notes)) == 98
    assert notes[0].count == 2
    with pytest.raises(RecordingError, match=r"imu.csv:3: 50 of 100 .* keep one row an epoch"):
        one_an_epoch(log(np.repeat(np.arange(50.0), 2)), [])
