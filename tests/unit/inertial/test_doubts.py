"""Doubts that a belief is given, by what an update then makes of them."""

import numpy as np

from gapless.attitude import from_euler, matrix
from gapless.inertial.belief import Belief
from gapless.inertial.doubts import GRAVITY, reseated, tipped
from gapless.inertial.layout import Layout
from gapless.witnesses.jolt import about

SINCE, FORCE = 3.0, 2.4


def sure(*states):
    b = Belief(Layout(states))
    b.x[6:10] = from_euler([0.02, -0.05, 0.8])
    b.P[:] = np.diag(np.full(b.layout.n, 1e-6))
    return b


def test_a_force_that_was_none_is_undone_by_the_velocity_that_came_of_it():
    """A box tilted by 2.4 m/s^2 of gravity for 3 s: velocity, way and tilt, as they came."""
    for axis, tilt, by in ((0, 7, -1.0), (1, 6, 1.0)):
        b = sure("mounting")
        tipped(b, FORCE * SINCE, SINCE)
        h = np.zeros((1, b.layout.n))
        h[0, 3 + axis] = 1.0
        gain = b.P @ h.T / (h @ b.P @ h.T + 1e-4)
        dx = (gain * FORCE * SINCE).ravel()
        assert np.isclose(dx[3 + axis], FORCE * SINCE, rtol=1e-3)
        assert np.isclose(dx[axis], 0.5 * FORCE * SINCE**2, rtol=1e-3)
        # psi x f with f = (0, 0, -g): north -g psi_E, east g psi_N
        assert np.isclose(dx[tilt], by * FORCE / GRAVITY, rtol=1e-3)


def test_a_box_that_was_reseated_feels_what_it_felt():
    """The same biases and attitude, told in the axes of before."""
    b = sure("mounting")
    b.block("accel_bias")[:] = [0.1, -0.2, 0.3]
    b.P[9:15, 9:15] = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    turn, c, spread = about(np.array([0.0, 0.6, 0.8]), 0.7), b.C_nb.copy(), b.P[12:15, 12:15].copy()
    force = c @ (np.array([0.3, 0.1, -9.8]) - b.block("accel_bias"))
    reseated(b, turn, np.zeros(b.layout.n))
    again = matrix(b.q_nb) @ (turn @ np.array([0.3, 0.1, -9.8]) - b.block("accel_bias"))
    np.testing.assert_allclose(again, force, atol=1e-12)
    np.testing.assert_allclose(b.P[12:15, 12:15], turn @ spread @ turn.T, atol=1e-12)
