"""Lines where they should be and as strong as asked, in what an IMU makes of them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gapless.errors import ConfigError
from gapless.simulate import (
    CAR,
    Chassis,
    Engine,
    Gear,
    Growth,
    Harmonic,
    Road,
    Segment,
    Slip,
    Vehicle,
    WheelComb,
    increments,
    speed_bound,
    vibrate,
)
from gapless.simulate.drive import ORIGIN
from gapless.simulate.path import Path
from gapless.units import DEG

LINES = (
    Harmonic(1.0, (1e-3, 2e-3, 3e-3), (0.01, 0.02, 0.03)),
    Harmonic(2.5, (2e-3, 0.0, 1e-3), (0.05, 0.04, 0.0)),
    Harmonic(4.0, (1e-3, 1e-3, 1e-3), (0.02, 0.02, 0.02)),
)
COMB = WheelComb(2.0, LINES)
TYRES = Chassis((COMB,), engine=None, road=None)


def at_speed(speed, duration=20.0):
    return Path.from_segments([Segment(duration)], ORIGIN, speed=speed)


def shaking(path, chassis, rate=100.0, seed=1, vehicle=None):
    """What the chassis adds to the increments, shape (n, 6), and the ends of the intervals."""
    box = vehicle or Vehicle()
    true = increments(path, rate, box)
    shaken = vibrate(true, path, chassis, np.random.default_rng(seed), box)
    return np.hstack([shaken.dtheta - true.dtheta, shaken.dvel - true.dvel]), true.time


def amplitudes(added, time, frequencies):
    """Of the lines at some frequencies, shape (lines, 6), by least squares, and what is left over."""
    angle = 2.0 * np.pi * np.outer(time, frequencies)
    basis = np.hstack([np.cos(angle), np.sin(angle)])
    found = np.linalg.lstsq(basis, added)[0]
    count = len(frequencies)
    return np.hypot(found[:count], found[count:]), np.abs(added - basis @ found).max()


def asked(harmonics=LINES):
    return np.array([[*h.rate, *h.accel] for h in harmonics])


def after_integration(harmonics, frequencies, rate, share=1.0):
    return share * asked(harmonics) * np.abs(np.sinc(np.array(frequencies) / rate))[:, None] / rate


@pytest.mark.parametrize("rate", [25.0, 50.0, 100.0, 200.0])
@pytest.mark.parametrize("speed", [3.0, 10.5, 37.0])
def test_lines_stand_at_their_orders_as_strong_as_asked(speed, rate):
    added, time = shaking(at_speed(speed), TYRES, rate)
    lines = [h.order * speed / 2.0 for h in LINES]
    found, left = amplitudes(added, time, lines)
    share = min(speed / 15.0, 2.0)
    # rounding of a phase of 1e3 rad, and of adding to and taking from 9.8 m/s^2 times dt
    assert_allclose(found, after_integration(LINES, lines, rate, share), rtol=1e-9, atol=1e-14)
    assert left < 1e-13


def test_a_line_above_half_the_rate_is_heard_where_it_folds_to():
    speed = 12.8  # order 2.5 is at 16 Hz; 25 Hz hear it at 9
    line = (Harmonic(2.5, (1e-3,) * 3, (0.1,) * 3),)
    added, _ = shaking(at_speed(speed), replace(TYRES, wheels=(WheelComb(2.0, line),)), 25.0)
    spectrum = np.abs(np.fft.rfft(added[:, 5]))
    assert np.fft.rfftfreq(len(added), 1.0 / 25.0)[spectrum.argmax()] == pytest.approx(9.0)
    # all of the line in one bin of 20 s: N A dt / 2
    expected = len(added) / 2.0 * 0.1 * speed / 15.0 * np.sinc(16.0 / 25.0) / 25.0
    assert spectrum.max() == pytest.approx(expected, rel=1e-9)


def test_slow_increments_are_sums_of_fast_ones():
    path = Path.from_segments([Segment(5.0), Segment(5.0, 3.0), Segment(5.0)], ORIGIN)
    slow, _ = shaking(path, replace(CAR, road=None), 25.0)
    for times, rate in ((2, 50.0), (4, 100.0), (8, 200.0)):
        fast, _ = shaking(path, replace(CAR, road=None), rate)
        assert_allclose(fast.reshape(len(slow), times, 6).sum(axis=1), slow, rtol=0.0, atol=1e-13)


def test_under_acceleration_a_line_is_the_integral_of_its_cosine():
    """Against brute force: a thousand midpoints per interval of A(v) cos(2 pi k s(t) / C)."""
    path = Path.from_segments([Segment(2.0), Segment(6.0, 3.0)], ORIGIN, speed=2.0)
    line = (Harmonic(8.0, (1e-3,) * 3, (0.1,) * 3),)
    added, time = shaking(path, replace(TYRES, wheels=(WheelComb(2.0, line),)), 25.0)
    fine = (np.arange(len(time) * 1000) + 0.5) / 25e3
    speed, _ = path.along(fine)
    angle = 2.0 * np.pi * 8.0 * path.speed.antiderivative(0.0)(fine) / 2.0
    both = np.column_stack([np.cos(angle), np.sin(angle)]) * (np.minimum(speed / 15.0, 2.0) / 25e3)[:, None]
    basis = both.reshape(len(time), 1000, 2).sum(axis=1)
    found, *_ = np.linalg.lstsq(basis, added)
    assert_allclose(np.hypot(*found), [1e-3] * 3 + [0.1] * 3, rtol=1e-3)
    # in 5 ms the phase strays by 2 pi 8 / 2 * 3 * 0.005^2 / 8 = 2.4e-4 rad, that of 0.1 m/s^2 at 25 Hz
    assert np.abs(added - basis @ found).max() < 2.4e-4 * 0.1 * 20.0 / 15.0 / 25.0


def test_phases_are_independent_and_seeded():
    path = at_speed(11.0, 5.0)
    first, again, other = (shaking(path, TYRES, seed=s)[0] for s in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    correlation = np.corrcoef(shaking(path, TYRES, seed=3)[0][:, [0, 3]].T)[0, 1]
    assert abs(correlation) < 0.99
    # a second comb or an engine leaves the first comb's phases as they were
    more = replace(TYRES, wheels=(COMB, WheelComb(2.01, LINES)), engine=Engine())
    rest = replace(TYRES, wheels=(WheelComb(2.0, ()), WheelComb(2.01, LINES)), engine=Engine())
    assert_allclose(shaking(path, more)[0] - shaking(path, rest)[0], first, rtol=0.0, atol=1e-14)


def test_two_circumferences_are_two_combs():
    worn = WheelComb(1.96, LINES)
    added, time = shaking(at_speed(15.0, 60.0), replace(TYRES, wheels=(COMB, worn)))
    lines = [h.order * 15.0 / c for c in (2.0, 1.96) for h in LINES]
    found, left = amplitudes(added, time, lines)
    assert_allclose(found, after_integration(LINES * 2, lines, 100.0), rtol=1e-8, atol=1e-14)
    assert left < 1e-13


def test_slip_moves_the_lines_of_driven_wheels():
    slipping = replace(TYRES, slips=(Slip(12.0, 4.0, 0.0), Slip(4.0, 6.0, 1.2)))
    added, time = shaking(at_speed(10.0), slipping)
    for when, ratio in ((time <= 4.0, 1.0), ((time > 4.0) & (time <= 10.0), 1.2), (time > 16.0, 1.0)):
        lines = [ratio * h.order * 5.0 for h in LINES]
        found, left = amplitudes(added[when], time[when], lines)
        expected = after_integration(LINES, lines, 100.0, ratio * 10.0 / 15.0)
        assert_allclose(found, expected, rtol=1e-8, atol=1e-14)
        assert left < 1e-13
    assert np.abs(added[(time > 12.0) & (time <= 16.0)]).max() < 1e-13  # locked
    free = replace(slipping, wheels=(replace(COMB, driven=False),))
    assert np.array_equal(shaking(at_speed(10.0), free)[0], shaking(at_speed(10.0), TYRES)[0])


@pytest.mark.parametrize(("speed", "ratio"), [(6.0, 7.7), (7.9, 7.7), (8.1, 5.3), (30.0, 3.12)])
def test_a_change_of_gear_moves_the_engine_and_not_the_wheels(speed, ratio):
    firing = (Harmonic(0.7, (1e-3,) * 3, (0.02,) * 3), Harmonic(2.0, (2e-3,) * 3, (0.05,) * 3))
    engine = Engine(firing, growth=Growth(30.0, 0.5))
    added, time = shaking(at_speed(speed), replace(TYRES, engine=engine), 200.0)
    turning = ratio * speed / 2.0
    wheel, motor = [h.order * speed / 2.0 for h in LINES], [h.order * turning for h in firing]
    found, left = amplitudes(added, time, wheel + motor)
    assert left < 1e-12
    expected = after_integration(LINES, wheel, 200.0, min(speed / 15.0, 2.0))
    assert_allclose(found[:3], expected, rtol=1e-7, atol=1e-13)
    grown = np.sqrt(min(turning / 30.0, 2.0))
    assert_allclose(found[3:], after_integration(firing, motor, 200.0, grown), rtol=1e-7)


def test_standing_only_the_engine_is_heard_at_its_idle():
    path = Path.from_segments([Segment(5.0), Segment(5.0, 2.0), Segment(5.0, -2.0), Segment(10.0)], ORIGIN)
    added, time = shaking(path, replace(TYRES, road=Road()))
    rest = (time < 4.0) | (time > 16.0)
    assert np.abs(added[rest]).max() < 1e-12  # a standing path keeps 1e-15 m/s
    assert np.abs(added[~rest]).max() > 1e-4
    engine = Engine((Harmonic(2.0, (1e-3,) * 3, (0.03,) * 3),), idle=12.0)
    idle, time = shaking(at_speed(0.0), replace(CAR, engine=engine))
    found, left = amplitudes(idle, time, [24.0])
    assert_allclose(found, after_integration(engine.harmonics, [24.0], 100.0, 12.0 / 30.0), rtol=1e-9)
    assert left < 1e-12


def test_the_signal_is_a_factor_on_the_wheels_alone():
    path = at_speed(12.0)
    none, one, three = (shaking(path, replace(CAR, signal=s))[0] for s in (0.0, 1.0, 3.0))
    assert_allclose(three - none, 3.0 * (one - none), rtol=0.0, atol=1e-13)
    assert np.array_equal(none, shaking(path, replace(CAR, wheels=()))[0])


def test_a_turned_box_feels_the_car_shake_in_its_own_axes():
    turned = Vehicle(mounting=(0.3, -0.2, 2.0))
    along, _ = shaking(at_speed(12.0), CAR)
    across, _ = shaking(at_speed(12.0), CAR, vehicle=turned)
    assert_allclose(across[:, :3], along[:, :3] @ turned.c_cb, rtol=0.0, atol=1e-13)
    assert_allclose(across[:, 3:], along[:, 3:] @ turned.c_cb, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("rate", [25.0, 100.0])
@pytest.mark.parametrize("speed", [7.5, 15.0])
def test_the_road_is_white_above_its_lowest_frequency(speed, rate):
    road = Road((1e-3, 2e-3, 0.0), (0.02, 0.03, 0.04), Growth(15.0, 2.0), 3.0)
    added, _ = shaking(at_speed(speed, 400.0), Chassis((), None, road), rate)
    power = np.abs(np.fft.rfft(added, axis=0)) ** 2 / len(added)
    frequency = np.fft.rfftfreq(len(added), 1.0 / rate)
    assert power[frequency < 2.99].max() < 1e-15 * power.max()
    # the variance of an increment in white noise is density^2 dt, at every frequency;
    # 2,000 bins in a band of 5 Hz know it to 1 / sqrt(2000) = 2.2 %: four of that
    expected = np.array([*road.rate, *road.accel]) ** 2 / rate * (speed / 15.0) ** 4
    for low in (3.0, 7.0):
        band = (frequency > low) & (frequency < low + 5.0)
        assert_allclose(power[band].mean(axis=0), expected, rtol=0.09, atol=1e-20)


def test_a_log_slower_than_the_road_hears_none_of_it():
    added, _ = shaking(at_speed(12.0), Chassis((), None, Road()), 5.0)
    assert np.abs(added).max() < 1e-12


def test_the_bound_of_one_line_in_one_channel():
    """Rife & Boorstyn (1974): var(w) = 24 s^2 / (A^2 dt^2 N (N^2 - 1)), real tone; v = C w / (2 pi k)."""
    one = Chassis((WheelComb(2.0, (Harmonic(3.0, (0.0, 0.0, 0.0), (0.0, 0.1, 0.0)),)),), None, None)
    noise, rate, count = 0.004, 50.0, 200
    left = 0.1 * np.sinc(3.0 * 15.0 / 2.0 / rate)
    variance = 24.0 * noise**2 * rate / (left**2 / rate**2 * count * (count**2 - 1.0))
    expected = 2.0 / (2.0 * np.pi * 3.0) * np.sqrt(variance)
    assert speed_bound(one, 15.0, 4.0, rate, (1.0, noise)) == pytest.approx(expected, rel=1e-12)
    # for many samples neither their number nor their rate counts, but for what integration takes away
    long = np.sqrt(24.0 * noise**2 / (left**2 * 4.0**3)) / (3.0 * np.pi)
    assert speed_bound(one, 15.0, 4.0, rate, (1.0, noise)) == pytest.approx(long, rel=1e-4)


@pytest.mark.parametrize("rate", [25.0, 100.0])
def test_maximum_likelihood_attains_the_bound(rate):
    """Monte Carlo: white noise on a constant speed, amplitudes and phases unknown to the estimator.

    1,500 trials know a variance to sqrt(2 / 1500) = 3.7 %; four of that. 25 Hz fold two lines of three,
    from 13.75 to 11.25 and from 22 to 3 Hz.
    """
    speed, window, noise = 11.0, 4.0, np.array([0.002 * DEG] * 3 + [0.001] * 3)
    bound = speed_bound(TYRES, speed, window, rate, (noise[0], noise[3]))
    signal, time = shaking(at_speed(speed, window), TYRES, rate)
    rng = np.random.default_rng(5)
    drawn = rng.standard_normal((1500, *signal.shape))
    scaled = signal / (noise / np.sqrt(rate)) + drawn
    tries = speed + bound * np.linspace(-6.0, 6.0, 25)
    held = []
    for v in tries:
        angle = 2.0 * np.pi * np.outer(time, [h.order * v / 2.0 for h in LINES])
        basis, _ = np.linalg.qr(np.hstack([np.cos(angle), np.sin(angle)]))
        held.append(np.sum(np.einsum("nj,tnc->tjc", basis, scaled, optimize=True) ** 2, axis=(1, 2)))
    likelihood = np.array(held)
    best = np.clip(likelihood.argmax(axis=0), 1, len(tries) - 2)
    below, top, above = (likelihood[best + k, np.arange(len(drawn))] for k in (-1, 0, 1))
    error = tries[best] - speed + 0.5 * (tries[1] - tries[0]) * (below - above) / (below - 2.0 * top + above)
    assert np.mean(error**2) / bound**2 == pytest.approx(1.0, abs=0.15)


def test_the_bound_counts_road_signal_and_silence():
    quiet = speed_bound(CAR, 12.0, 4.0, 100.0)
    assert speed_bound(replace(CAR, signal=0.5), 12.0, 4.0, 100.0) == pytest.approx(2.0 * quiet)
    assert speed_bound(CAR, 12.0, 4.0, 100.0, (0.01, 0.1)) > quiet
    assert speed_bound(CAR, 12.0, 8.0, 100.0) == pytest.approx(quiet / 8.0**0.5, rel=1e-4)
    assert speed_bound(replace(CAR, signal=0.0), 12.0, 4.0, 100.0) == np.inf
    # where the first order, at 2.5 Hz, lies below what the road shakes, the sensor alone hides it
    slow, sensor = replace(CAR, wheels=(WheelComb(2.0, LINES[:1]),)), (0.01, 0.1)
    assert speed_bound(slow, 5.0, 4.0, 100.0, sensor) == pytest.approx(
        speed_bound(replace(slow, road=None), 5.0, 4.0, 100.0, sensor)
    )
    with pytest.raises(ConfigError, match="no bound"):
        speed_bound(TYRES, 12.0, 4.0, 100.0)
    with pytest.raises(ConfigError, match="two samples"):
        speed_bound(CAR, 12.0, 0.01, 100.0)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: Harmonic(0.0, (0.0,) * 3, (0.0,) * 3), "order 0; give cycles"),
        (lambda: Harmonic(2.0, (0.0,) * 3, (0.0, -1.0, 0.0)), "harmonic 2: an amplitude is negative"),
        (lambda: Harmonic(2.0, (np.nan,) * 3, (0.0,) * 3), "harmonic 2: an amplitude"),
        (lambda: Growth(0.0), "growth by reference 0"),
        (lambda: Growth(15.0, 0.0), "exponent 0"),
        (lambda: Growth(15.0, 1.0, -1.0), "cap -1"),
        (lambda: WheelComb(0.0), "0 m circumference"),
        (lambda: Engine(circumference=-2.0), "-2 m circumference"),
        (lambda: Engine(idle=0.0), "idles at 0"),
        (lambda: Engine(gears=()), "gears until nothing"),
        (lambda: Engine(gears=(Gear(5.0, 10.0),)), "the last of them inf"),
        (lambda: Engine(gears=(Gear(9.0, 8.0), Gear(5.0, 10.0), Gear(np.inf, 3.0))), "rising speeds"),
        (lambda: Engine(gears=(Gear(np.inf, 0.0),)), "gear ratio"),
        (lambda: Road((-1.0, 0.0, 0.0)), "road noise"),
        (lambda: Road(lowest=-1.0), "road noise"),
        (lambda: Chassis(signal=-0.5), "-0.5 times as loud"),
        (lambda: Chassis(signal=np.nan), "nan times as loud"),
        (lambda: Chassis(slips=(Slip(1.0, 0.0, 1.1),)), "a slip of 0 s from 1 s"),
        (lambda: Chassis(slips=(Slip(1.0, 2.0, -1.0),)), "ratio -1"),
        (lambda: Chassis(slips=(Slip(5.0, 2.0, 1.1), Slip(4.0, 2.0, 1.1))), "slips overlap at 5 s"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(wrong, said):
    with pytest.raises(ConfigError, match=said) as refused:
        wrong()
    assert "\n" not in str(refused.value)
    assert "; " in str(refused.value)
