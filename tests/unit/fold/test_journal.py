"""The journal: angles' deviations against Monte Carlo, and no moment written twice."""

import numpy as np
import pytest

from gapless import attitude
from gapless.fold.journal import Journal
from gapless.inertial.belief import Belief
from gapless.inertial.layout import Layout
from gapless.units import DEG

LAYOUT = Layout(("gyro_scale",))
NOTHING = np.zeros((3, 3))


def belief(euler, seed=0):
    b = Belief(LAYOUT)
    b.x[:3], b.x[3:6], b.x[6:10] = (0.6, 0.2, 50.0), (5.0, -3.0, 0.2), attitude.from_euler(euler)
    root = np.random.default_rng(seed).normal(size=(LAYOUT.n, LAYOUT.n))
    root[6:9] *= 0.3 * DEG
    b.P[:] = root @ root.T
    return b


@pytest.mark.parametrize("euler", [(0.0, 0.0, 0.5), (0.2, -0.3, 2.0), (-0.4, 1.1, -2.5)])
def test_angles_have_the_deviations_of_the_rotations_they_come_from(euler):
    journal, b = Journal(LAYOUT), belief(euler)
    journal.row(1.0, b, NOTHING, "gnss")
    said = journal.trajectory().sd[0]
    rng = np.random.default_rng(5)
    phi = rng.multivariate_normal(np.zeros(3), b.P[6:9, 6:9], 20_000)
    drawn = attitude.to_euler(
        np.array([attitude.multiply(attitude.from_rotation_vector(p), b.x[6:10]) for p in phi])
    )
    spread = np.std(attitude.wrap(drawn - np.array(euler)), axis=0)
    # 20,000 draws know a deviation to 0.5 %; steep pitch bends the angles by 1 % at these sizes.
    np.testing.assert_allclose(said[6:9], spread, rtol=0.03)
    np.testing.assert_allclose(said[:6], np.sqrt(np.diag(b.P)[:6]), rtol=1e-12)
    assert journal.trajectory().horizontal[0] == b.P[0, 1]


def test_a_moment_is_written_once():
    journal, first, second = Journal(LAYOUT), belief((0.0, 0.0, 0.0)), belief((0.1, 0.0, 0.0), 1)
    for t, b in ((1.0, first), (1.1, first), (1.0, second), (1.1, second), (1.2, second)):
        journal.row(t, b, NOTHING, "ins")
        journal.innovation("position", t, b.x[:3].copy(), np.eye(3), 1.0, 1.0)
    t = journal.trajectory()
    assert t.time.tolist() == [1.0, 1.1, 1.2]
    np.testing.assert_allclose(t.euler[:, 0], [0.0, 0.0, 0.1], atol=1e-15)
    assert journal.innovations()["position"].time.tolist() == [1.0, 1.1, 1.2]


def test_what_is_written_does_not_change():
    journal, b = Journal(LAYOUT), belief((0.0, 0.0, 0.0))
    journal.row(1.0, b, NOTHING, "gnss")
    b.x[:] = 0.0
    b.p[:] = 0.0
    assert journal.trajectory().lla[0, 0] == 0.6
    assert journal.trajectory().sd[0, 0] > 0.0


def test_rewinding_forgets_and_a_follower_begins_empty():
    journal, b = Journal(LAYOUT), belief((0.0, 0.0, 0.0))
    journal.row(1.0, b, NOTHING, "gnss")
    mark = journal.mark()
    journal.row(1.1, b, NOTHING, "ins")
    journal.innovation("velocity", 1.1, np.zeros(3), np.eye(3), 1.0, 1.0)
    journal.align(1.1, "again")
    follower = Journal(LAYOUT)
    follower.after(journal)
    journal.rewind(mark)
    assert journal.trajectory().time.tolist() == [1.0]
    assert journal.innovations() == {}
    assert journal.alignments == []
    for t in (1.1, 1.2):
        follower.row(t, b, NOTHING, "ins")
        journal.row(t, b, NOTHING, "ins")
    assert follower.times == [1.2]
    assert journal.times == [1.0, 1.1, 1.2]


def test_blocks_come_by_name():
    journal, b = Journal(LAYOUT), belief((0.0, 0.0, 0.0))
    b.block("gyro_scale")[:] = 0.01, 0.02, 0.03
    journal.row(1.0, b, NOTHING, "gnss")
    states, sds = journal.blocks()
    assert set(states) == {"gyro_bias", "accel_bias", "gyro_scale"}
    np.testing.assert_array_equal(states["gyro_scale"], [[0.01, 0.02, 0.03]])
    np.testing.assert_allclose(sds["gyro_scale"][0], np.sqrt(np.diag(b.P)[15:18]))
    assert sds["gyro_scale"].shape == (1, 3)


def test_an_open_loop_error_is_in_the_rows():
    b = Belief(LAYOUT, open_loop=True)
    b.error[3:6] = 1.0, 2.0, 3.0
    journal = Journal(LAYOUT)
    journal.row(0.5, b, NOTHING, "ins")
    np.testing.assert_array_equal(journal.trajectory().v_n[0], [1.0, 2.0, 3.0])
    assert np.array_equal(b.v_n, np.zeros(3))


def test_what_fixes_share_and_what_no_motion_shows_are_stated_on_top():
    layout = Layout(("mounting",))
    b = Belief(layout)
    b.P[:] = np.diag(np.linspace(0.1, 0.9, layout.n)) ** 2
    b.x[6] = 1.0
    shared = np.array([[0.5, 0.2, 0.0], [0.2, 0.8, 0.0], [0.0, 0.0, 2.0]])
    plain, honest = Journal(layout), Journal(layout, 0.3 * DEG)
    plain.row(1.0, b, NOTHING, "gnss")
    honest.row(1.0, b, shared, "gnss")
    before, after = (np.square(j.trajectory().sd[0]) for j in (plain, honest))
    assert np.allclose(after[:3] - before[:3], np.diag(shared))
    assert honest.trajectory().horizontal[0] == pytest.approx(0.2)
    assert np.array_equal(after[3:6], before[3:6])
    assert np.allclose(after[6:9] - before[6:9], (0.3 * DEG) ** 2)  # level: angles are rotations
    grown = np.square(honest.blocks()[1]["mounting"]) - np.square(plain.blocks()[1]["mounting"])
    assert np.allclose(grown, (0.3 * DEG) ** 2)
    assert np.array_equal(honest.blocks()[1]["gyro_bias"], plain.blocks()[1]["gyro_bias"])
