"""Changes of velocity that are felt from another side than they are seen."""

import math

import numpy as np
import pytest

from gapless.units import DEG
from gapless.witnesses.askew import ANGLE, MEMORY, Askew, pointed


def rotated(v, angle):
    """Clockwise, from north to east."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1]])


def heard(angle, n=12, noise=0.15, scale=1.0, seed=0, size=3.0):
    """Changes of a town, as felt and as said by a receiver, one a second."""
    rng, askew = np.random.default_rng(seed), Askew()
    for k in range(n):
        felt = rotated(np.array([size, 0.0]), rng.uniform(0.0, 2.0 * np.pi))
        said = scale * rotated(felt, angle) + noise * rng.standard_normal(2)
        askew.hear(float(k), said, felt)
    return askew


@pytest.mark.parametrize("angle", [-170.0, -60.0, 15.0, 35.0, 90.0, 178.0])
def test_the_angle_is_found(angle):
    """Of twelve changes of 3 m/s with 0.15 m/s of noise: to 0.8 deg, three of which are allowed."""
    off = math.remainder(heard(angle * DEG).angle - angle * DEG, 2.0 * math.pi)
    assert abs(off) < 2.5 * DEG


@pytest.mark.parametrize("angle", [-10.0, 0.0, 10.0])
def test_little_is_left_to_the_filter(angle):
    assert abs(angle * DEG) < ANGLE
    assert heard(angle * DEG).angle == 0.0


@pytest.mark.parametrize(
    "askew",
    [
        heard(0.6, n=2),
        heard(0.6, size=0.5, noise=0.02),
        heard(0.6, noise=3.0),
        heard(0.6, scale=2.0),
        heard(0.6, scale=0.5),
    ],
    ids=["too few", "too small", "no one angle", "too long", "too short"],
)
def test_what_is_not_clear_is_nothing(askew):
    assert askew.angle == 0.0


def test_it_forgets():
    """A heading that was put right shows no more: after twice the memory the last seconds outweigh it."""
    askew, rng = heard(0.6), np.random.default_rng(1)
    for k in range(int(2.0 * MEMORY)):
        felt = rotated(np.array([3.0, 0.0]), rng.uniform(0.0, 6.3))
        askew.hear(20.0 + k, felt, felt)
    assert askew.angle == 0.0
    again = heard(0.6)
    again.forget()
    assert again.angle == 0.0


def test_a_copy_goes_on_alone():
    askew = heard(0.6)
    sums, time = askew.sums.copy(), askew.time
    askew.copy().hear(30.0, np.array([5.0, 0.0]), np.array([-5.0, 0.0]))
    assert np.array_equal(askew.sums, sums)
    assert askew.time == time


@pytest.mark.parametrize(
    ("course", "ahead", "angle", "is_so"),
    [
        (10.0, 10.0, 35.0, True),
        (10.0, 45.0, 35.0, False),
        (-179.0, 179.0, 35.0, True),
        (10.0, 30.0, -35.0, False),
        (10.0, 20.0, -35.0, True),
    ],
)
def test_a_box_is_turned_if_the_car_points_along_its_course(course, ahead, angle, is_so):
    assert pointed(course * DEG, ahead * DEG, angle * DEG) == is_so
