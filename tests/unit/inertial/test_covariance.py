"""Process noise, by hand."""

import numpy as np

from gapless.inertial.covariance import add_noise
from gapless.inertial.layout import ROW


def test_noise_of_one_interval():
    noise = np.array([4e-6, 9e-4, 1e-10, 1e-7, 1e-4])
    p, dt = np.zeros(ROW * ROW), 0.05
    add_noise(noise, (0.03, -0.04, 0.0), dt, p)
    q = p.reshape(ROW, ROW)
    # The turn is 0.05 rad in 0.05 s: 0.05^2 / 0.05 times the variance of its proportional error.
    expected = np.repeat([0.0, 9e-4 * dt, 4e-6 * dt + 1e-4 * 0.05, 1e-10 * dt, 1e-7 * dt], 3)
    np.testing.assert_allclose(np.diag(q)[:15], expected, rtol=1e-14)
    # Velocity white noise integrated once more: E[dp dv] = S dt^2 / 2.
    np.testing.assert_allclose(np.diag(q, 3)[:3], 9e-4 * dt**2 / 2.0, rtol=1e-14)
    assert np.array_equal(q, q.T)
    assert np.count_nonzero(q) == 12 + 6
