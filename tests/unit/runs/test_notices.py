"""What was noticed on the way: said once, with its times and how; and nothing of what goes well."""

import numpy as np
import pytest

import gapless as gp
from gapless.fold.journal import Journal, Knock
from gapless.inertial.layout import Layout
from gapless.runs.leans import leans
from gapless.runs.notices import MOST, Evidence, grouped, noticed
from gapless.runs.verdict import judge
from gapless.simulate.faults import base, plant
from gapless.trip.recording import Gnss, Imu, Odometer, Recording, Trajectory
from gapless.trip.solution import Decision, Innovations, Notice
from gapless.units import DEG

START, SECONDS, SPEED = 1000.0, 400, 10.0
FAULT, UNTIL = 120.0, 150.0


def made(
    rulings=(), speed=None, lla=None, nis=None, knocks=(), alignments=(), moves=(), roll=None, keep=None
):
    """A drive north at 10 m/s with readings once a second, and what a journal might hold of it."""
    t = START + np.arange(SECONDS + 0.0)
    n = len(t)
    path = np.tile([0.8, 0.2, 100.0], (n, 1))
    path[:, 0] += SPEED * np.arange(n) / 6.37e6
    v_n = np.tile([SPEED, 0.0, 0.0], (n, 1))
    euler = np.zeros((n, 3))
    euler[:, 0] = 0.0 if roll is None else roll
    own = Trajectory(t, path, v_n, euler, np.ones((n, 9)), np.zeros(n), np.full(n, "gnss"))
    said = v_n if speed is None else np.column_stack([speed, np.zeros((n, 2))])
    noise = 1e-9 * np.random.default_rng(1).standard_normal((2, n, 3))  # bits that do not repeat by chance
    lla = path + noise[0] if lla is None else lla
    said = said + noise[1] if speed is None else said
    gnss = Gnss(t, lla, np.ones((n, 3)), said, np.full((n, 3), 0.1), np.ones(n, int))
    imu = Imu(t, np.ones(n), np.zeros((n, 3)), np.zeros((n, 3)))
    log = Recording("made", imu, gnss, Odometer(t, said[:, 0]))
    keep = np.ones(n, bool) if keep is None else keep
    told = {}
    for channel, value in (("position", lla), ("velocity", said), ("odometer", said[:, :1])):
        own_rulings = [(a - START, r) for a, c, r in rulings if c == channel]
        mute = np.zeros(n, bool)
        for at, ruling in own_rulings:
            mute[int(at) :] = ruling == "silence"
        z = (value - {"position": path, "velocity": v_n, "odometer": v_n[:, :1]}[channel]) * 1.0
        z[:, :2] *= 6.37e6 if channel == "position" else 1.0
        size = np.full(n, float(z.shape[1])) if nis is None or channel != "velocity" else nis
        told[channel] = Innovations(
            t[keep], z[keep], np.ones(z.shape)[keep], size[keep], np.where(mute, np.inf, 1.0)[keep]
        )
    journal = Journal(Layout(()))
    journal.rulings, journal.knocks, journal.moves = list(rulings), list(knocks), list(moves)
    journal.alignments = [(START, "course"), *alignments]
    return Evidence(journal, told, own, log, {})


def mute(channel="position", begin=FAULT, end=UNTIL):
    """Silenced for a while."""
    return [(START + begin, channel, "silence"), (START + end, channel, "use")]


def spoilt(column, what):
    """A column of values in the span of the fault, and as they were outside it."""
    column = column.copy()
    column[int(FAULT) : int(UNTIL)] = what(column)
    return column


FREE = made().recording.gnss.lla
LIES = {
    "repeated itself to the bit": spoilt(FREE, lambda lla: lla[int(FAULT)]),
    "stood while the car drove": spoilt(
        FREE, lambda lla: lla[int(FAULT)] + 1e-8 * np.sin(lla[120:150] * 1e9)
    ),
    "lay 22 m aside": spoilt(FREE, lambda lla: lla[120:150] + np.array([0.0, 22.0 / 6.37e6, 0.0])),
    "height was off by 30 m": spoilt(FREE, lambda lla: lla[120:150] + np.array([0.0, 0.0, 30.0])),
    "strayed by up to 60 m": spoilt(
        FREE, lambda lla: lla[120:150] + np.linspace(0.0, 60.0, 30)[:, None] * [0.0, 1.0 / 6.37e6, 0.0]
    ),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_position_that_was_not_believed_is_named_by_its_lie(lie):
    (notice,) = noticed(made(mute(), lla=LIES[lie]))
    assert lie in notice.text
    assert "position not believed from 120 to 150 s" in notice.text
    assert "30 s; used again since" in notice.text
    assert (notice.start, notice.end, notice.lasting, notice.kind) == (120.0, 150.0, 30.0, "silenced")


@pytest.mark.parametrize("channel", ["velocity", "odometer"])
def test_a_speed_of_zero_and_one_that_lasts_to_the_end(channel):
    still = np.where(np.arange(SECONDS) < FAULT, SPEED, 0.0)
    (notice,) = noticed(made([(START + FAULT, channel, "silence")], speed=still))
    assert f"{channel} not believed from 120 s on: it said zero while the car drove" in notice.text
    assert "280 s; to the end" in notice.text


def test_spikes_are_not_told_and_short_pauses_part_nothing():
    assert noticed(made(mute(end=FAULT + 2.0))) == ()
    (notice,) = noticed(made([*mute(end=130.0), *mute(begin=132.0, end=140.0)]))
    assert notice.lasting == 18.0
    assert (notice.start, notice.end) == (120.0, 140.0)


def test_silence_of_an_outage_is_no_disbelief():
    seconds = np.arange(SECONDS)
    (notice,) = noticed(made(mute(end=205.0), keep=(seconds < 130) | (seconds >= 204)))
    assert (notice.start, notice.end) == (120.0, 130.0)


def test_a_filter_that_begins_anew_was_what_was_wrong():
    found = noticed(made(mute(), alignments=[(START + 149.0, "course; anew, for the filter was beyond")]))
    assert [n.kind for n in found] == ["silenced", "anew"]
    assert "it was the filter that was wrong" in found[0].text


def test_fixes_that_were_believed_have_a_new_place():
    lla = FREE.copy()
    lla[200:, 1] += 22.0 / 6.37e6
    rulings = [(START + 200.0, "position", "believe"), (START + 201.0, "position", "use")]
    (notice,) = noticed(made(rulings, lla=lla))
    assert notice.text == "from 200 s on the fixes' new place was believed, 22 m aside"
    away = np.arange(SECONDS)
    assert noticed(made(rulings, lla=lla, keep=(away < 150) | (away > 195))) == ()  # back from an outage


def test_small_beliefs_of_a_channel_are_one_notice():
    rulings = [
        (START + t + k, "velocity", r) for t in (50, 60, 200) for k, r in enumerate(("believe", "use"))
    ]
    (notice,) = noticed(made(rulings, speed=np.full(SECONDS, SPEED + 0.5)))
    assert (
        "velocities were believed against the filter 2 times from 50 to 200 s, at most 0.5 m/s" in notice.text
    )


def test_what_moved_is_one_incident():
    (box,) = noticed(
        made(knocks=[Knock(START + t, a * DEG, None) for t, a in ((50.0, 3), (60.0, -25), (65.0, 9))])
    )
    assert "turned by about 25 deg at 60 s" in box.text
    (zero,) = noticed(made(moves=[(START + 50.0, "gyro", 1.4 * DEG), (START + 60.0, "gyro", 0.3 * DEG)]))
    assert "a gyro's zero had moved by 1.4 deg/s when the car stood at 50 s" in zero.text
    (force,) = noticed(made(moves=[(START + 50.0, "force", 2.4)]))
    assert "accelerometers not believed at 50 s: a force of 2.4 m/s2" in force.text


def test_a_box_whose_gyros_felt_it_turn_leans_for_good():
    roll = np.where(np.arange(SECONDS) < 200, 0.0, 40.0 * DEG)
    (notice,) = noticed(made(roll=roll))
    assert notice.kind == "leaned"
    assert "about 40 deg" in notice.text
    assert abs(notice.start - 200.0) <= 2.0  # rows once a second, two of them between the means
    road = np.where(np.arange(SECONDS) % 100 < 50, 0.0, 10.0 * DEG)
    assert leans(made(roll=road).trajectory) == []


def test_innovations_that_are_too_large_for_long():
    nis = np.full(SECONDS, 3.0)
    nis[100:190] = 27.0
    (notice,) = noticed(made(nis=nis))
    assert (
        "velocities disagree with the filter by more than they state from 100 to 190 s (NIS 9)" in notice.text
    )
    nis[130:190] = 3.0
    nis[::10] = 500.0  # spikes: each window has one
    nis[::10][1::3] = 3.0
    assert all(n.lasting >= 60.0 for n in noticed(made(nis=nis)))


def test_many_are_grouped():
    many = tuple(
        Notice(20.0 * k, 20.0 * k + k, "position", f"no {k}", "silenced", float(k)) for k in range(1, 13)
    )
    found = grouped(many)
    assert len(found) == MOST
    assert found[-1].text == "and 5 more between 20 and 105 s (position)"
    assert [n.text for n in found[:-1]] == [f"no {k}" for k in range(6, 13)]
    assert grouped(many[:MOST]) == many[:MOST]


def verdict(evidence, clock=0.01):
    decisions = [Decision("clock offset, position", 0.0, "s", "data", "", clock)]
    return judge(
        noticed(evidence),
        decisions,
        evidence.recording.gnss,
        evidence.trajectory,
        ("position", "nonholonomic"),
    )


def test_verdicts_judge():
    assert verdict(made()) == ""
    said = verdict(made(mute(), lla=LIES["lay 22 m aside"]))
    assert said == (
        "Disturbed: position was not believed for 30 s; "
        "what is stated in that time rests on inertial sensors and constraints."
    )
    assert verdict(made(mute("odometer"))).endswith("rests on the other sensors.")
    nis = np.where(np.arange(SECONDS) < 100, 3.0, 27.0)
    assert verdict(made(nis=nis)).startswith("Inconsistent: velocity disagrees")
    vague = verdict(made(), clock=0.2)
    assert vague.startswith(
        "Vague: the receiver's clock is known to 0.20 s only, in which the car drives 2.0 m"
    )
    assert verdict(made(), clock=0.1) == ""  # 1 m of driving beside fixes that state 1.4


@pytest.fixture(scope="module")
def drive():
    return base("urban", 150.0, 21, odometer=True)


def test_nothing_is_noticed_of_a_drive_without_faults(drive):
    solution = gp.fuse(drive, outages=[gp.Outage(100.0, 125.0)])
    assert solution.notices == ()


@pytest.mark.parametrize(
    ("kind", "channel", "words"),
    [
        ("stands", "position", "repeated itself"),
        ("odometer-stands", "odometer", "said zero"),
        ("box-tipped", "imu", "turned by about"),
    ],
)
def test_a_fault_is_noticed_when_it_was(drive, kind, channel, words):
    planted = plant([kind], drive, [90.0], 21)
    solution = gp.fuse(planted.faulted)
    (notice,) = (n for n in solution.notices if n.channel == channel)
    assert words in notice.text
    # within the 2 s after which a copy is called one, and the while that a box takes to fall
    assert abs(notice.start - (planted.start - solution.start)) < 4.0
    assert solution.verdict.startswith("Disturbed: ")
