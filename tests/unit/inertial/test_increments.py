"""Coning, sculling and cutting a sample, against closed forms and quadrature."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gapless.inertial.increments import coning, sculling, split, two_sample


def test_two_sample_is_the_classical_twelfth():
    assert two_sample(0.01, 0.01) == pytest.approx(1.0 / 12.0, rel=1e-15)
    assert two_sample(0.0, 0.01) == 0.0


def ramp(offset, slope, start, end):
    """Integral of a linear rate."""
    return np.asarray(offset) * (end - start) + 0.5 * np.asarray(slope) * (end**2 - start**2)


OMEGA, OMEGA_DOT = [0.5, -0.8, 1.0], [3.0, 2.0, -4.0]
FORCE, FORCE_DOT = [2.0, 4.0, -10.0], [20.0, -30.0, 10.0]


def integrate(end, steps=2000):
    """C(end) from the body axes at 0 and the integral of C f in those axes, by fine steps."""
    edges = np.linspace(0.0, end, steps + 1)
    rotation, velocity = Rotation.identity(), np.zeros(3)
    for a, b in pairwise(edges):
        dtheta = ramp(OMEGA, OMEGA_DOT, a, b)
        half = rotation * Rotation.from_rotvec(0.5 * dtheta)
        velocity = velocity + half.apply(ramp(FORCE, FORCE_DOT, a, b))
        rotation = rotation * Rotation.from_rotvec(dtheta)
    return rotation, velocity


@pytest.mark.parametrize("before", [0.005, 0.01, 0.003])
def test_linear_rates_over_unequal_intervals(before):
    now = 0.005
    theta, theta0 = ramp(OMEGA, OMEGA_DOT, 0.0, now), ramp(OMEGA, OMEGA_DOT, -before, 0.0)
    dv, dv0 = ramp(FORCE, FORCE_DOT, 0.0, now), ramp(FORCE, FORCE_DOT, -before, 0.0)
    factor = two_sample(before, now)
    rotation, velocity = integrate(now)
    # Next after omega x omega' dt^3 / 12 (3e-8) is omega (omega omega') dt^4 (2e-9 / 100); likewise for
    # the velocity, f omega omega' dt^4 = 2e-8 / 10. Leaving the correction out costs 3e-8 and 1e-6.
    np.testing.assert_allclose(coning(theta, theta0, factor), rotation.as_rotvec(), rtol=0.0, atol=2e-10)
    np.testing.assert_allclose(sculling(theta, dv, theta0, dv0, factor), velocity, rtol=0.0, atol=5e-9)
    assert np.abs(theta - rotation.as_rotvec()).max() > 1e-8
    assert np.abs(dv + 0.5 * np.cross(theta, dv) - velocity).max() > 5e-8


def test_constant_rates_need_no_previous_sample():
    dt = 0.01
    theta, dv = np.array(OMEGA) * dt, np.array(FORCE) * dt
    expected = sum(Rotation.from_rotvec(theta * t).apply(dv) for t in (np.arange(4000) + 0.5) / 4000) / 4000
    # Fourth order: theta^3 dv / 24 = 1e-8; the third alone is 3e-6.
    got = sculling(tuple(theta), tuple(dv), (0.0,) * 3, (0.0,) * 3, 0.0)
    np.testing.assert_allclose(got, expected, rtol=0.0, atol=2e-8)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.99])
def test_split_of_a_linear_rate_is_exact(share):
    before, now = 0.008, 0.005
    whole, previous = ramp(OMEGA, OMEGA_DOT, 0.0, now), ramp(OMEGA, OMEGA_DOT, -before, 0.0)
    first = split(whole, previous, before, now, share * now)
    expected = ramp(OMEGA, OMEGA_DOT, 0.0, share * now)
    np.testing.assert_allclose(first, expected, rtol=1e-12)  # a handful of roundings
    rest = whole - first
    # The rest is the difference, so the sum is the whole but for the rounding of one addition.
    np.testing.assert_array_max_ulp(first + rest, whole, maxulp=1)
    np.testing.assert_allclose(rest, ramp(OMEGA, OMEGA_DOT, share * now, now), rtol=1e-11)


def test_split_without_a_previous_sample_is_proportional():
    np.testing.assert_array_equal(
        split(np.array([1.0, 2.0, -4.0]), np.zeros(3), 0.0, 0.01, 0.0025), [0.25, 0.5, -1.0]
    )
