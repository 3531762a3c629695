"""A box that is knocked over is told from a car that brakes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gapless import attitude
from gapless.units import DEG
from gapless.witnesses.jolt import KNOWN, LENGTH, WINDOW, Jolts, about, between

G, TICK, NOISE = 9.81, 0.1, 0.15
C_NB = attitude.to_matrix(attitude.from_euler(np.array([3.0, -5.0, 140.0]) * DEG))
"""A box that sits askew in a car that drives southeast."""


def felt(accelerations, turn=None, c=C_NB, seed=0):
    """Forces in the box of accelerations in n, by one that was turned (`turn`: b of now to b of before)."""
    force = np.asarray(accelerations) - [0.0, 0.0, G]
    force = force + NOISE * np.random.default_rng(seed).standard_normal(force.shape)
    return (force @ c) if turn is None else (force @ c) @ turn


def first(jolts, forces, c=C_NB, tilt=1.0 * DEG):
    """The first jolt that is found, and after how many seconds."""
    for k, force in enumerate(forces):
        found = jolts.feel(force, c, tilt, TICK)
        if found is not None:
            return found, TICK * (k + 1)
    return None


def known():
    """A minute of steady driving."""
    jolts = Jolts()
    assert first(jolts, felt(np.zeros((600, 3)))) is None
    return jolts


@pytest.mark.parametrize("angle", [22.0, 35.0, 60.0, 90.0])
@pytest.mark.parametrize("bearing", [0.0, 50.0, 90.0, 200.0, 290.0])
def test_a_box_that_tips_is_found_and_turned_back(angle, bearing):
    """Within 1.5 s, for the window of a second must all lie after it, and it must not lean further still.

    The turn takes the force back to the vertical that it had within what noise leaves of a mean of ten: 0.3
    deg each way.
    """
    level = np.array([np.cos(bearing * DEG), np.sin(bearing * DEG), 0.0])
    turn = about(C_NB.T @ level, angle * DEG)
    found, after = first(known(), felt(np.zeros((30, 3)), turn))
    assert after <= 1.5 + 1e-9
    assert found.since == pytest.approx(WINDOW * TICK)
    # the vertical as it is felt now, taken to the axes of before
    down = found.turn @ (turn.T @ C_NB[2])
    assert np.arccos(min(down @ C_NB[2], 1.0)) < 1.0 * DEG
    assert found.angle == pytest.approx(angle * DEG, abs=1.5 * DEG)
    # what was integrated wrongly: the force as felt less what it was, in the axes of before
    gained = (turn.T - np.eye(3)) @ (C_NB.T @ [0.0, 0.0, -G])
    assert np.linalg.norm(found.gained - gained) < 0.3


@given(
    st.lists(
        st.tuples(st.floats(0.0, 5.0), st.floats(0.0, 2.0 * np.pi), st.integers(1, 60)),
        min_size=1,
        max_size=6,
    )
)
@settings(max_examples=30)
def test_brakes_and_corners_are_none(stretches):
    """Up to 5 m/s^2 any way, for as long as it lasts: the force leans by 27 deg, but is longer, too."""
    level = [np.full((n, 3), [size * np.cos(way), size * np.sin(way), 0.0]) for size, way, n in stretches]
    assert first(known(), felt(np.concatenate(level))) is None


def test_bumps_are_none():
    """Of 3 g, up and down again within a tick or over two, while the car brakes."""
    bumps = np.zeros((200, 3))
    bumps[:, 0] = -4.0
    bumps[::7, 2], bumps[1::7, 2] = -12.0, 12.0
    assert first(known(), felt(bumps)) is None


@pytest.mark.parametrize("grade", [-15.0, 15.0])
def test_hills_are_none(grade):
    """The gyros tell of them; a filter that follows feels an upright force."""
    jolts = known()
    for share in np.linspace(0.0, 1.0, 60):
        c = C_NB @ attitude.to_matrix(attitude.from_euler(np.array([0.0, share * grade, 0.0]) * DEG))
        assert first(jolts, felt(np.zeros((1, 3)), c=c, seed=int(60 * share)), c) is None


def test_a_box_that_is_turned_about_the_vertical_is_none():
    """Nothing leans; `Askew` sees that."""
    assert first(known(), felt(np.zeros((50, 3)), about(C_NB[2], 60.0 * DEG))) is None


def test_a_filter_in_doubt_of_the_vertical_finds_none():
    """By 12 deg; or one that has not driven yet, or began anew just now."""
    turn = about(C_NB.T @ [1.0, 0.0, 0.0], 35.0 * DEG)
    tipped = felt(np.zeros((12, 3)), turn)
    assert first(known(), tipped, tilt=12.0 * DEG) is None
    assert first(Jolts(), tipped) is None
    began = known()
    assert first(began, tipped[: WINDOW - 1]) is None
    began.forget()
    assert first(began, felt(np.zeros((50, 3)))) is None


def test_no_number_is_no_jolt():
    """And is forgotten after a second."""
    jolts = known()
    assert first(jolts, np.full((2 * WINDOW, 3), np.nan)) is None
    assert first(jolts, felt(np.zeros((2 * WINDOW, 3)))) is None
    assert np.isfinite(jolts.memory[LENGTH])
    assert first(jolts, felt(np.zeros((30, 3)), about(C_NB.T @ [1.0, 0.0, 0.0], 0.8))) is not None


def test_a_scale_of_the_accelerometers_is_learned():
    """Three per cent too long a force would pass for a brake, or hide one."""
    jolts = Jolts()
    assert first(jolts, 1.03 * felt(np.zeros((KNOWN + 100, 3)))) is None
    assert jolts.memory[LENGTH] == pytest.approx(1.03 * G, abs=0.1)
    tipped = 1.03 * felt(np.zeros((30, 3)), about(C_NB.T @ [0.0, 1.0, 0.0], 0.5))
    assert first(jolts, tipped) is not None


def test_a_copy_goes_on_alone():
    jolts = known()
    before = jolts.memory.copy()
    twin = jolts.copy()
    first(twin, felt(np.ones((50, 3)), about(C_NB[0], 1.0)))
    assert np.array_equal(jolts.memory, before)
    assert not np.array_equal(twin.memory, before)


@given(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_between_is_the_rotation_from_one_to_the_other(parts):
    a, b = np.array(parts).reshape(2, 3) + np.array([[0.0, 0.0, 1.5], [0.0, -1.5, 0.0]])
    turn = between(a, b)
    assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert np.allclose(turn @ a / np.linalg.norm(a), b / np.linalg.norm(b), atol=1e-9)


@pytest.mark.parametrize("a", [[1.0, 0.0, 0.0], [0.0, 0.0, -2.0], [1.0, -1.0, 0.5]])
def test_between_opposites_is_half_a_turn(a):
    turn = between(np.array(a), -np.array(a))
    assert np.allclose(turn @ a, -np.array(a))
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_about_is_the_rotation_vector():
    axis = np.array([1.0, -2.0, 2.0]) / 3.0
    expected = attitude.to_matrix(attitude.from_rotation_vector(0.7 * axis))
    assert np.allclose(about(axis, 0.7), expected, atol=1e-12)
