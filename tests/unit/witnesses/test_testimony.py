"""A channel's standing: how it is lost, and what gives it back."""

import numpy as np
import pytest

from gapless.witnesses.increments import Slack
from gapless.witnesses.testimony import (
    BRIEF,
    FORGETS,
    INSISTS,
    KNOWN,
    MANY,
    REPEATS,
    SETTLED,
    Said,
)
from gapless.witnesses.testimony import Testimony as Channel

PATIENCE, RATE, SD = 30.0, 5.0, 1.0
SLACK = Slack(0.5)
DRIVEN = 5.0


def said(time, off=0.0, fits=True, logged=None, rests=False, nis=1e3):
    """Of a car that drives on steadily: what it says but for that is how far off it is.

    The last digits of what is logged are noise, so that no two are the same.
    """
    value = np.full(2, off, float)
    own = value + 1e-3 * np.sin(1e3 * time) if logged is None else np.full(2, logged, float)
    return Said(time, own, value + DRIVEN * time, value, np.full(2, SD**2), fits, 1.0 if fits else nis, rests)


def hears(channel, readings, slack=SLACK, denied=False, contradicted=False, accused=False):
    return [channel.hear(one, slack, denied, contradicted, accused) for one in readings]


def times(start, end):
    return np.arange(start, end - 1e-9, 1.0 / RATE)


def settled(patience=PATIENCE):
    channel = Channel(2, patience)
    assert set(hears(channel, (said(t) for t in times(0.0, 5.0)))) == {"use"}
    return channel


def test_a_spike_costs_one_reading():
    channel = settled()
    assert hears(channel, [said(5.0, 100.0, False), said(5.2), said(5.4)]) == ["silence", "use", "use"]
    assert channel.heard
    assert channel.lies == 1


def test_a_lie_that_lasted_must_have_followed_before_it_is_heard_again():
    """A leap back is a leap, too: only what goes on as was felt counts."""
    channel = settled()
    away = hears(channel, (said(t, 100.0, False) for t in times(5.0, 5.0 + 2.0 * BRIEF)))
    assert set(away) == {"silence"}
    back = 5.0 + 2.0 * BRIEF
    ruled = hears(channel, (said(t) for t in times(back, back + 2.0 * SETTLED)))
    assert ruled.index("use") == pytest.approx(SETTLED * RATE, abs=1)
    assert "use" not in ruled[: ruled.index("use")]
    assert set(ruled[ruled.index("use") :]) == {"use"}


def test_patience():
    """What moved away once and goes on as was felt is believed after so long, and then used."""
    channel = settled()
    ruled = hears(channel, (said(t, 40.0, False) for t in times(5.0, 50.0)))
    assert ruled.index("believe") == pytest.approx(PATIENCE * RATE, abs=1)
    assert set(ruled[: ruled.index("believe")]) == {"silence"}
    assert set(hears(channel, (said(t, 40.0) for t in times(50.0, 60.0)))) == {"use"}


def test_others_that_are_with_the_filter_outlast_patience():
    channel = settled()
    ruled = hears(channel, (said(t, 40.0, False) for t in times(5.0, 200.0)), contradicted=True)
    assert set(ruled) == {"silence"}


def test_what_was_led_astray_meanwhile_has_a_short_way_back():
    """Silenced for a while, it leaps once more, and from there on follows: no other half minute."""
    channel = settled()
    hears(channel, (said(t, 3.0 * t, False) for t in times(5.0, 15.0)))
    ruled = hears(channel, (said(t, 100.0, False) for t in times(15.0, 60.0)))
    assert ruled.index("believe") / RATE < SETTLED + 1.0


@pytest.mark.parametrize("fits", [False, True])
def test_what_repeats_itself_is_never_believed(fits):
    """The same bits while something else was felt: neither after any patience, nor where it fits."""
    channel = settled()
    felt = (said(t, -8.0 * (t - 5.0), False, logged=1.0) for t in times(5.0, 10.0))
    assert "silence" in hears(channel, felt)
    ruled = hears(channel, (said(t, -40.0, fits, logged=1.0) for t in times(10.0, 150.0)))
    assert set(ruled) == {"silence"}


def test_bits_that_repeat_where_nothing_moves_are_no_lie():
    """A receiver that holds its place at a traffic light."""
    channel = settled()
    assert set(hears(channel, (said(t, logged=0.0) for t in times(5.0, 60.0)))) == {"use"}


def test_a_velocity_that_repeats_itself_is_dead_however_well_it_fits():
    channel = settled()
    ruled = hears(channel, (said(t, logged=7.0) for t in times(5.0, 60.0)))
    assert ruled.index("silence") == pytest.approx(max(REPEATS * RATE, MANY), abs=2)
    assert set(ruled[ruled.index("silence") :]) == {"silence"}


def test_a_copy_has_no_noise_to_hide_behind():
    """What would pass for noise of a live reading is none of one that repeats itself."""
    for off, ruled in ((0.02, {"use"}), (0.2, {"use", "silence"})):
        # over 8 s 0.16 and 1.6; of noise, 5 sqrt(2) are left to a reading, 0.4 sqrt(2) to a copy
        live = [said(5.0 + t, off * t) for t in times(0.0, REPEATS + 30.0)]
        copy = [said(5.0 + t, off * t, logged=0.5) for t in times(0.0, REPEATS + 30.0)]
        assert set(hears(settled(), live, Slack(0.0))) == {"use"}
        assert set(hears(settled(), copy, Slack(0.0))) == ruled


def test_what_insists_is_believed():
    channel = settled()
    ruled = hears(channel, (said(t, fits=False) for t in times(5.0, 12.0)))
    assert ruled.index("believe") == pytest.approx(INSISTS * RATE, abs=1)
    assert "silence" not in ruled


def test_a_surprise_that_wanes_is_a_mistake_that_passes():
    """To less than `WANES` of its largest, by the time that patience is over."""
    ruled = hears(settled(), (said(t, fits=False, nis=1e3 * np.exp(5.0 - t)) for t in times(5.0, 12.0)))
    assert set(ruled) == {"use"}


def test_one_that_fits_in_between_breaks_it():
    channel = settled()
    ruled = hears(channel, (said(t, fits=k % 8 == 0) for k, t in enumerate(times(5.0, 40.0))))
    assert set(ruled) == {"use"}


def test_what_is_denied_and_insists_is_silenced_until_patience_is_over():
    """Which it is not while others contradict it."""
    for contradicted, after in ((False, "believe"), (True, "silence")):
        readings = (said(t, fits=False) for t in times(5.0, 6.0 + INSISTS + PATIENCE))
        ruled = hears(settled(), readings, denied=True, contradicted=contradicted)
        silent = ruled.index("silence")
        assert silent == pytest.approx(INSISTS * RATE, abs=1)
        assert set(ruled[:silent]) == {"use"}
        assert set(ruled[silent : silent + int(PATIENCE * RATE) - 1]) == {"silence"}
        assert after in ruled[silent + int(PATIENCE * RATE) - 1 :]


@pytest.mark.parametrize("lies", [1, 2])
def test_who_lied_before_is_believed_later(lies):
    channel = settled()
    for k in range(lies):
        hears(channel, [said(5.0 + k, 100.0, False), said(5.2 + k), said(5.4 + k)])
    begin = 6.0 + lies
    hears(channel, (said(t) for t in times(begin - 0.4, begin)))
    ruled = hears(channel, (said(t, fits=False) for t in times(begin, begin + 60.0)))
    assert ruled.index("believe") == pytest.approx(INSISTS * (1.0 + KNOWN * lies) * RATE, abs=1)


def test_who_is_accused_is_silenced_and_heard_again_as_after_a_lie():
    channel = settled()
    assert set(hears(channel, (said(t) for t in times(5.0, 10.0)), accused=True)) == {"silence"}
    ruled = hears(channel, (said(t) for t in times(10.0, 20.0)))
    assert ruled.index("use") == pytest.approx(SETTLED * RATE, abs=1)


def test_a_car_that_rests_by_one_that_was_silenced_follows_nothing():
    """Zeros of a receiver that has stopped look like a steady drive."""
    channel = settled()
    ruled = hears(channel, (said(t, 15.0, False, rests=True) for t in times(5.0, 100.0)))
    assert set(ruled) == {"silence"}


def test_after_a_silence_of_its_own_it_is_new():
    """But for its lies."""
    channel = settled()
    hears(channel, [said(5.0, 100.0, False)])
    assert not channel.heard
    assert hears(channel, [said(5.0 + FORGETS + 0.1, 300.0)]) == ["use"]
    assert channel.lies == 1


def test_a_copy_goes_on_alone():
    channel = settled()
    before, rows = dict(vars(channel)), channel.past.rows.copy()
    twin = channel.copy()
    lie = [said(t, 100.0 * t, False) for t in times(5.0, 20.0)]
    assert hears(twin, lie) == hears(channel.copy(), lie)
    assert vars(channel) == before
    assert np.array_equal(channel.past.rows, rows)
    assert channel.past.n == len(rows[rows[:, 0] > 0.0]) + 1
