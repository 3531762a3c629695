"""Faults that are planted: each changes what it says, where it says, and the same each time."""

from dataclasses import fields

import numpy as np
import pytest

from gapless.errors import ConfigError
from gapless.simulate.faults import FAULTS, Planted, base, plant
from gapless.trip.motion import offset_ned

AT = 130.0
SECONDS = 240.0
TOUCHES = {
    "receiver": {"gnss"},
    "odometer": {"odometer"},
    "imu": {"imu"},
    "clock": {"gnss"},
    "arm": {"gnss", "lever_arm"},
    "drive": set(),
}
"""What a fault of each sensor may change in a recording."""
TRUTH = {"moves", "moves-up", "box-turned", "box-tipped", "box-knocked-over"}
"""Kinds after which truth is another: that of a new frame, or of a box that was turned."""


@pytest.fixture(scope="module")
def drives():
    return {of: base(of, SECONDS, 3, odometer=True) for of in {f.drive for f in FAULTS.values()}}


@pytest.fixture(scope="module")
def planted(drives):
    return {k: plant([k], drives[f.drive], [AT], 7) for k, f in FAULTS.items()}


def same(a, b):
    """Whether two parts of a recording have the same bits."""
    if type(a) is not type(b):
        return False
    if hasattr(a, "__dataclass_fields__"):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    return np.array_equal(a, b, equal_nan=a.dtype.kind == "f") if isinstance(a, np.ndarray) else a == b


def parts_that_differ(a, b):
    return {f.name for f in fields(a) if not same(getattr(a, f.name), getattr(b, f.name))}


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_changes_its_sensor_and_nothing_else(kind, drives, planted):
    fault = FAULTS[kind]
    changed = parts_that_differ(drives[fault.drive], planted[kind].faulted)
    if fault.sensor == "drive":
        assert not changed
    elif fault.sensor == "arm":
        assert changed == {"gnss", "lever_arm"}
        assert (planted[kind].faulted.lever_arm is None) == (kind == "arm-untold")
    else:
        allowed = TOUCHES[fault.sensor] | ({"reference"} if kind in TRUTH else set())
        assert TOUCHES[fault.sensor] <= changed <= allowed


@pytest.mark.parametrize("kind", FAULTS)
def test_outside_its_span_nothing_is_changed(kind, drives, planted):
    clean, faulted, (start, end) = drives[FAULTS[kind].drive], planted[kind].faulted, planted[kind].spans[0]
    if FAULTS[kind].sensor == "imu" and kind not in ("clips", "imu-pauses"):
        end = np.inf  # what ends there is the change; what it led to stays
    if kind == "imu-pauses":
        end += planted[kind].sizes[0]
    parts = ["imu", "gnss", "odometer"]
    if FAULTS[kind].sensor == "clock":  # stamps that moved cross the edge
        parts, kept = ["imu", "odometer"], clean.gnss.time < start
        assert same(clean.gnss.take(kept), faulted.gnss.take(slice(0, int(kept.sum()))))
    for a, b in ((-np.inf, start), (end + 1e-9, np.inf)):
        for part in parts:
            assert same(getattr(clean, part).slice(a, b), getattr(faulted, part).slice(a, b)), part


@pytest.mark.parametrize("kind", FAULTS)
def test_the_seed_is_the_fault(kind, drives, planted):
    drive = drives[FAULTS[kind].drive]
    again = plant([kind], drive, [AT], 7)
    assert not parts_that_differ(again.faulted, planted[kind].faulted)
    assert not parts_that_differ(again.spared, planted[kind].spared)
    assert (again.spans, again.sizes) == (planted[kind].spans, planted[kind].sizes)
    other, (low, high) = plant([kind], drive, [AT], 8), FAULTS[kind].size
    assert low <= again.sizes[0] <= high
    if low < high:
        assert other.sizes != again.sizes


@pytest.mark.parametrize("kind", FAULTS)
def test_what_it_is_compared_with_is_free_of_it(kind, drives, planted):
    fault, clean, spared = FAULTS[kind], drives[FAULTS[kind].drive], planted[kind].spared
    start, end = planted[kind].spans[0]
    if fault.sensor == "receiver" and kind not in ("moves", "moves-up"):
        assert parts_that_differ(clean, spared) == {"gnss"}
        kept = np.isin(clean.gnss.time, spared.gnss.time)
        assert same(clean.gnss.take(kept), spared.gnss)
        assert np.all((clean.gnss.time[~kept] >= start) & (clean.gnss.time[~kept] < end))
        assert (~kept).sum() > 0
    elif fault.sensor == "odometer":
        assert parts_that_differ(clean, spared) == {"odometer"}
        assert spared.odometer is None
    elif fault.sensor in ("imu", "drive"):
        assert spared.start >= (end if np.isfinite(end) else start)
        assert same(spared.imu, planted[kind].faulted.imu.slice(spared.start, np.inf))
    elif fault.sensor == "arm":
        assert parts_that_differ(spared, planted[kind].faulted) == {"lever_arm"}
    else:
        assert not parts_that_differ(clean, spared)


def changed_rows(planted: Planted, drive):
    a, b = drive.gnss, planted.faulted.gnss
    return (a.time >= planted.start) & (a.time < planted.spans[0][1]), a, b


def test_a_receiver_that_repeats_itself_does_so_to_the_bit(drives, planted):
    rows, clean, faulted = changed_rows(planted["repeats"], drives["any"])
    last = int(np.argmax(rows)) - 1
    assert rows.sum() >= 5
    for column in ("lla", "v_n"):
        assert np.array_equal(
            getattr(faulted, column)[rows], np.tile(getattr(clean, column)[last], (rows.sum(), 1))
        )
    assert np.hypot(*clean.v_n[last, :2]) > 4.0  # while it drives, at 5 m/s or so


def test_a_jump_is_as_far_as_it_says(drives, planted):
    for kind, horizontally in (("jumps", True), ("jumps-up", False), ("moves", True), ("moves-up", False)):
        rows, clean, faulted = changed_rows(planted[kind], drives["any"])
        off = offset_ned(faulted.lla[rows], clean.lla[rows])
        size = np.hypot(off[:, 0], off[:, 1]) if horizontally else np.abs(off[:, 2])
        # radii of curvature at the middle or at one end: a millionth
        assert np.allclose(size, planted[kind].sizes[0], rtol=1e-5)
        assert np.allclose(np.abs(off).sum(), np.abs(off[:, :2] if horizontally else off[:, 2]).sum())


def test_one_that_coasts_goes_straight_on_at_its_last_velocity(drives, planted):
    rows, clean, faulted = changed_rows(planted["coasts"], drives["any"])
    last = int(np.argmax(rows)) - 1
    way = offset_ned(faulted.lla[rows], np.tile(clean.lla[last], (rows.sum(), 1)))
    straight = (clean.time[rows] - clean.time[last])[:, None] * clean.v_n[last]
    assert np.allclose(way, straight, rtol=1e-4, atol=1e-6)  # the radii of curvature change on the way


def test_an_unsigned_odometer_differs_in_reverse_alone(drives, planted):
    clean, faulted = drives["dead ends"].odometer.speed, planted["odometer-unsigned"].faulted.odometer.speed
    assert clean.min() < -1.0
    assert np.array_equal(faulted, np.abs(clean))


def test_a_box_that_is_turned_feels_gravity_elsewhere(drives, planted):
    p = planted["box-knocked-over"]
    before, after = (x.imu.slice(200.0, 230.0) for x in (drives["any"], p.faulted))
    f, turned = (np.mean(i.dvel / i.dt[:, None], axis=0) for i in (before, after))
    assert np.isclose(np.linalg.norm(f), np.linalg.norm(turned), rtol=1e-9)
    cos = (f[1:] @ turned[1:]) / np.linalg.norm(f[1:]) / np.linalg.norm(turned[1:])
    assert np.isclose(np.degrees(np.arccos(cos)), p.sizes[0], atol=1e-6)


def test_truth_turns_with_the_box(drives, planted):
    """Gravity, by the truth's attitude, is where the turned accelerometers feel it."""
    from gapless import attitude

    p = planted["box-tipped"]
    k = np.searchsorted(p.faulted.reference.time, 220.0)
    for log in (drives["any"], p.faulted):
        c_nb = attitude.to_matrix(attitude.from_euler(log.reference.euler[k]))
        i = log.imu.slice(219.0, 221.0)
        f_n = c_nb @ np.mean(i.dvel / i.dt[:, None], axis=0)
        assert abs(f_n[2] + 9.8) < 1.0  # what a car accelerates, vibrates and its sensor errs by


def test_pairs_are_planted_one_upon_the_other(drives):
    p = plant(["repeats", "gyro-leaps"], drives["any"], [AT, 180.0], 7)
    assert p.kind == "repeats + gyro-leaps"
    assert parts_that_differ(drives["any"], p.faulted) == {"gnss", "imu"}
    assert p.spared.start >= 180.0
    assert (p.start, len(p.spans), len(p.sizes)) == (p.spans[0][0], 2, 2)
    alone = plant(["gyro-leaps"], drives["any"], [180.0], 7)
    assert same(p.faulted.imu, alone.faulted.imu)


def test_an_unknown_kind_names_the_known_ones(drives):
    with pytest.raises(ConfigError, match=r"no fault 'gremlin'.*repeats"):
        plant(["gremlin"], drives["any"], [AT], 1)
