import numpy as np
import pytest

from gapless.errors import ConfigError
from gapless.scenarios import Outage, Periodic, parse, plan, withheld, withhold
from gapless.trip.recording import Gnss


def fixes(time):
    n = len(time)
    column = np.arange(3.0 * n).reshape(n, 3)
    return Gnss(np.asarray(time, float), column, column, column, column, np.ones(n, int))


def test_a_stretch_reads_as_written():
    outage = parse("240:300.5")
    assert outage == Outage(240.0, 300.5)
    assert outage.length == 60.5
    assert parse(str(outage)) == outage


def test_a_periodic_plan_reads_as_written_in_any_order():
    assert parse("every=180,length=60,first=240") == Periodic(180.0, 60.0, 240.0)
    shifted = parse(" shift=60, first=240,length=60,every=180")
    assert shifted == Periodic(180.0, 60.0, 240.0, 60.0)
    assert parse(str(shifted)) == shifted


def test_a_periodic_plan_expands_to_whole_outages_only():
    periodic = Periodic(180.0, 60.0, 240.0, 60.0)
    assert periodic.expand(540.0) == (Outage(300.0, 360.0), Outage(480.0, 540.0))
    assert periodic.expand(539.9) == (Outage(300.0, 360.0),)
    assert periodic.expand(100.0) == ()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("300:240", "does not end after it starts"),
        ("240:240", "does not end after it starts"),
        ("-5:10", "negative"),
        ("240:inf", "not finite"),
        ("nan:10", "not finite"),
        ("a:10", "'a' is not a number"),
        ("240", "neither"),
        ("", "neither"),
        ("1:2:3", "neither"),
        ("every=180,length=60", "first missing"),
        ("every=180", "length and first missing"),
        ("every=180,length=60,first=240,size=3", "'size' is unknown"),
        ("every=180,every=60,first=240,length=3", "'every' is given twice"),
        ("every=180,length=0,first=240", "above zero"),
        ("every=0,length=0,first=240", "above zero"),
        ("every=1e-9,length=1e-10,first=240", "every is less than 1 s"),
        ("every=60,length=61,first=240", "overlap"),
        ("every=60,length=,first=240", "not a number"),
    ],
)
def test_bad_outages_are_refused_with_the_form_that_works(text, says):
    with pytest.raises(ConfigError) as caught:
        parse(text)
    message = str(caught.value)
    assert repr(text) in message
    assert says in message
    assert "240:300" in message or "every=180,length=60,first=240" in message
    assert "\n" not in message


def test_a_plan_is_sorted_and_outages_may_touch():
    found = plan(["310:320", "every=100,length=10,first=100"], 320.0)
    assert found == (Outage(100, 110), Outage(200, 210), Outage(300, 310), Outage(310, 320))


def test_overlap_between_arguments_is_refused():
    with pytest.raises(ConfigError, match=r"240:300 and 299:310 overlap; join them to 240:310"):
        plan(["299:310", "240:300"], 1000.0)


@pytest.mark.parametrize("text", ["500:600", "every=180,length=60,first=240"])
def test_an_outage_outside_the_recording_is_refused(text):
    with pytest.raises(ConfigError, match="lasts 290 s"):
        plan([text], 290.0)


def test_epochs_in_the_half_open_stretch_are_withheld_position_and_velocity_both():
    gnss = fixes([1000.0, 1009.99, 1010.0, 1015.0, 1019.99, 1020.0, 1030.0])
    outages = [Outage(10.0, 20.0)]
    expected = [False, False, True, True, True, False, False]
    assert withheld(gnss.time, outages, 1000.0).tolist() == expected
    left = withhold(gnss, outages, 1000.0)
    assert left.time.tolist() == [1000.0, 1009.99, 1020.0, 1030.0]
    keep = [0, 1, 5, 6]
    np.testing.assert_array_equal(left.lla, gnss.lla[keep])
    np.testing.assert_array_equal(left.v_n, gnss.v_n[keep])
    assert len(gnss) == 7


def test_no_outages_withhold_nothing():
    assert len(withhold(fixes([1.0, 2.0]), [], 0.0)) == 2
