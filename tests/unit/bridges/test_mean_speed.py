"""The mean speed of a window, against speeds that are computed again with the errors taken away."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gapless import attitude
from gapless.bridges.mean_speed import mean_speed
from gapless.inertial.belief import Belief
from gapless.inertial.layout import Layout
from gapless.inertial.trail import GRAVITY

WINDOW, DT = 4.0, 0.1
TIMES = DT * np.arange(41)
DOWN = np.array([0.0, 0.0, GRAVITY])
BOX = Rotation.from_euler("ZYX", [0.4, 0.1, -0.2])
"""How the box is turned in the car: its axes are not the car's."""


def course(turn, gain):
    """Attitudes of the box, and what it feels, of a car that turns and gains speed."""
    heading = 0.7 + turn * TIMES
    c = [Rotation.from_euler("Z", h) * BOX for h in heading]
    v = (9.0 + gain * TIMES)[:, None] * np.column_stack([np.cos(heading), np.sin(heading), 0.0 * heading])
    return c, v, [r.inv().apply(a - DOWN) for r, a in zip(c, np.gradient(v, DT, axis=0), strict=True)]


def speeds(now, c, felt, phi, bias):
    """Lengths of the velocity on the way to the present one, felt with other errors."""
    turned = Rotation.from_rotvec(phi)
    a = np.array([(turned * r).apply(f - bias) + DOWN for r, f in zip(c, felt, strict=True)])
    steps = 0.5 * (a[1:] + a[:-1]) * DT
    v = now - np.vstack([steps[::-1].cumsum(axis=0)[::-1], np.zeros(3)])
    return np.linalg.norm(v, axis=1), v


@pytest.mark.parametrize(("turn", "gain"), [(0.0, 0.0), (0.0, 1.5), (0.05, -1.0), (-0.1, 0.5)])
def test_errors_move_the_mean_as_stated(turn, gain):
    c, v, felt = course(turn, gain)
    own, path = speeds(v[-1], c, felt, np.zeros(3), np.zeros(3))
    belief = Belief(Layout(), trail=WINDOW)
    belief.x[3:6], belief.x[6:10] = v[-1], attitude.from_matrix(c[-1].as_matrix())
    for t, row in zip(TIMES, path, strict=True):
        belief.trail.mark(t, row)
    h = mean_speed(belief, WINDOW)
    for k in range(9):
        dx = np.zeros(15)
        dx[(3, 4, 5, 6, 7, 8, 12, 13, 14)[k]] = 1e-3
        there, _ = speeds(v[-1] + dx[3:6], c, felt, dx[6:9], dx[12:15])
        # Second order in 1e-3, of what gravity gains in 4 s: 40 m/s x 1e-6. The box's attitude is taken to
        # be the present one for the bias alone: 4 s x turn of at most 2 s x 1e-3 at most.
        turned = abs(turn) * WINDOW * 2e-3 if k >= 6 else 0.0
        assert (there - own).mean() == pytest.approx((h @ dx).item(), abs=4e-5 + turned)


def test_a_tilt_is_seen_through_what_gravity_feigns():
    belief = Belief(Layout(), trail=WINDOW)
    belief.x[3:7] = 10.0, 0.0, 0.0, 1.0
    for t in TIMES:
        belief.trail.mark(t, np.array([10.0, 0.0, 0.0]))
    h = mean_speed(belief, WINDOW)
    # Nose up by phi: phi x g too much along the road, for 2 s on average.
    assert abs(h[0, 7]) == pytest.approx(2.0 * GRAVITY, rel=1e-12)
    assert h[0, [3, 6, 8]] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
