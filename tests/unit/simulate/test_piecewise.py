import numpy as np
from numpy.testing import assert_allclose

from gapless.simulate.piecewise import staircase

STAIRS = staircase([4.0, 1.0, 6.0, 5.0], [0.0, 2.0, -1.0, -1.0], 1.5)


def test_levels_hold_between_the_corners():
    assert_allclose(STAIRS(np.array([0.0, 3.4, 4.5, 5.6, 10.0, 16.0])), [0, 0, 2, -1, -1, -1], atol=1e-12)


def test_a_rounded_corner_keeps_the_integral_of_the_sharp_steps():
    assert_allclose(STAIRS.antiderivative(3.0)(16.0), 3.0 + 2.0 * 1.0 - 11.0, rtol=1e-14)


def test_derivatives_up_to_the_third_are_continuous_at_every_knot():
    f = STAIRS
    for _ in range(4):
        inner = f.knots[1:-1]
        # the fourth derivative is below 1e4 here, so 1e-9 s to either side move the third by 1e-5
        assert_allclose(f(inner - 1e-9), f(inner + 1e-9), atol=3e-5)
        f = f.derivative()


def test_derivative_undoes_antiderivative():
    t = np.linspace(0.0, 16.0, 500)
    assert_allclose(STAIRS.antiderivative(1.0).derivative()(t), STAIRS(t), atol=1e-12)


def test_antiderivative_agrees_with_quadrature():
    t, w = np.polynomial.legendre.leggauss(200)
    # 200 nodes over corners of bounded fourth derivative: good to 1e-6
    assert_allclose(np.sum(w * 8.0 * STAIRS(8.0 * (t + 1.0))), STAIRS.antiderivative(0.0)(16.0), atol=1e-5)
