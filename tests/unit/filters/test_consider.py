"""The wander's effect on an estimate, against the same filter's joint covariance and Monte Carlo."""

import numpy as np
import pytest

from gapless.filters.consider import Wander

TAU, STEP, SIGMA = 20.0, 1.0, np.array([1.0, 2.0, 3.0])
DRIFT = np.diag([0.02, 0.03, 0.05])
R = np.array([[2.0, 0.3, 0.0], [0.3, 3.0, -0.2], [0.0, -0.2, 4.0]])


def gains(count):
    """Gain and covariance after each update of a filter that takes R for white."""
    p = 25.0 * np.eye(3)
    for _ in range(count):
        p = p + DRIFT
        k = p @ np.linalg.inv(p + R)
        p = (np.eye(3) - k) @ p
        yield k, p


def test_it_is_the_joint_covariance_of_error_and_wander():
    """The textbook way: six states, the last three of them unseen by the filter."""
    wander, decay = Wander(TAU), np.exp(-STEP / TAU)
    joint = np.zeros((6, 6))
    joint[3:, 3:] = np.eye(3)
    h = np.hstack([np.eye(3), np.diag(SIGMA)])
    for n, (k, p) in enumerate(gains(200)):
        step = np.diag([1.0, 1.0, 1.0, decay, decay, decay])
        joint = step @ joint @ step.T
        joint[3:, 3:] += (1.0 - decay**2) * np.eye(3)
        fix = np.eye(6) - np.vstack([k, np.zeros((3, 3))]) @ h
        joint = fix @ joint @ fix.T
        wander.hear(STEP * n, p, R, SIGMA)
        # the gain is recovered as P R^-1: rounding of two inverses
        assert np.allclose(wander.response, joint[:3, :3], rtol=1e-9, atol=1e-12)
        assert np.allclose(wander.shared, joint[:3, 3:], rtol=1e-9, atol=1e-12)


def test_it_is_what_happens():
    rng, decay, drives = np.random.default_rng(3), np.exp(-STEP / TAU), 4000
    error, w = np.zeros((drives, 3)), rng.standard_normal((drives, 3))
    wander = Wander(TAU)
    for n, (k, p) in enumerate(gains(60)):
        w = decay * w + np.sqrt(1.0 - decay**2) * rng.standard_normal(w.shape)
        error -= (error + SIGMA * w) @ k.T
        wander.hear(STEP * n, p, R, SIGMA)
    # a variance from 4000 draws is good to sqrt(2 / 4000) = 2.2 %, four of them
    assert np.allclose(np.cov(error.T).diagonal(), wander.response.diagonal(), rtol=0.09)


def test_a_lasting_error_passes_whole_and_a_quick_one_is_averaged_away():
    late = {}
    for tau in (1e6, 1e-3):
        wander = Wander(tau)
        for n, (_, p) in enumerate(gains(400)):
            wander.hear(STEP * n, p, R, SIGMA)
        late[tau] = np.sqrt(wander.response.diagonal())
    assert np.allclose(late[1e6], SIGMA, rtol=0.01)
    assert np.all(late[1e-3] < 0.35 * SIGMA)


def test_a_silence_ends_what_is_shared_but_not_the_error():
    wander, p = Wander(TAU), 0.5 * np.eye(3)
    for n in range(30):
        wander.hear(STEP * n, p, R, SIGMA)
    before = wander.copy()
    wander.hear(1e4, 1e-12 * np.eye(3), R, SIGMA)
    assert np.allclose(wander.response, before.response, atol=1e-6)
    assert np.abs(wander.shared).max() < 1e-6
    assert before.time == pytest.approx(29.0)


def cross(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def antenna(reach, count, r, turning=False):
    """H, K and P after each update of a filter with an attitude; its fixes are an antenna's."""
    p = np.diag([25.0] * 3 + [0.02] * 3)
    for n in range(count):
        course = 0.4 * n if turning else 0.3
        arm = reach * np.array([np.cos(course), np.sin(course), -0.4])
        h = np.hstack([np.eye(3), -cross(arm)])
        p = p + np.diag([*DRIFT.diagonal(), 1e-6, 1e-6, 1e-5])
        k = p @ h.T @ np.linalg.inv(h @ p @ h.T + r)
        p = (np.eye(6) - k @ h) @ p
        yield h, k, p


@pytest.mark.parametrize("sd", [0.01, 0.1, 1.0, 10.0])
@pytest.mark.parametrize("reach", [0.0, 1.0, 3.0])
def test_an_antenna_away_from_the_box_is_followed_exactly(reach, sd):
    """Nine states, the last three of them unseen: what the wander does to the place that the fixes show."""
    wander, decay, r = Wander(TAU), np.exp(-STEP / TAU), sd * sd * np.eye(3)
    slow = 0.6 * sd * np.ones(3)
    joint = np.zeros((9, 9))
    joint[6:, 6:] = np.eye(3)
    for n, (h, k, p) in enumerate(antenna(reach, 100, r)):
        joint[6:] *= decay
        joint[:, 6:] *= decay
        joint[6:, 6:] += (1.0 - decay**2) * np.eye(3)
        fix = np.eye(9) - np.vstack([k, np.zeros((3, 3))]) @ np.hstack([h, np.diag(slow)])
        joint = fix @ joint @ fix.T
        wander.hear(STEP * n, h @ p @ h.T, r, slow)
        # the gain is had as H P H' R^-1: P of 25 m^2 against R of 1e-4 leaves 1e-9 of rounding
        assert np.allclose(wander.response, h @ joint[:6, :6] @ h.T, rtol=1e-6, atol=1e-9 * sd * sd)


@pytest.mark.parametrize("sd", [0.01, 0.1, 1.0, 10.0])
@pytest.mark.parametrize("reach", [0.0, 1.0, 3.0])
def test_it_stays_below_the_wander_itself(reach, sd):
    """However the car turns: I - H K lengthens nothing, and what lasts can pass whole but not more."""
    wander, r, slow = Wander(TAU), sd * sd * np.eye(3), 0.6 * sd * np.ones(3)
    for n, (h, _, p) in enumerate(antenna(reach, 600, r, turning=True)):
        wander.hear(STEP * n, h @ p @ h.T, r, slow)
        assert np.linalg.eigvalsh(wander.response).max() <= (0.6 * sd) ** 2 * (1.0 + 1e-9)
