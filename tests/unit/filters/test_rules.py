"""Each rule's own formula, against the paper's written out or against SciPy."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import chi2

from gapless.filters.adaptation.base import Innovation
from gapless.filters.adaptation.chi_square import ChiSquare, robust_factor
from gapless.filters.adaptation.fading import Fading, FadingTable
from gapless.filters.adaptation.igg3 import Igg3, Igg3Table, weights
from gapless.filters.adaptation.improved_fading import ImprovedFading, ImprovedFadingTable
from gapless.filters.adaptation.sage_husa import SageHusa, SageHusaTable
from gapless.inertial.belief import Belief
from gapless.inertial.layout import Layout

R = np.array([[1.0, 0.3], [0.3, 2.0]])
HPH = np.array([[0.5, -0.1], [-0.1, 0.2]])


def told(z, channel="position", time=0.0, r=R, hph=HPH):
    z = np.asarray(z, float)
    return Innovation(channel, time, z, hph + r, r, float(z @ np.linalg.solve(hph + r, z)))


@pytest.mark.parametrize("size", [1.01, 1.3, 5.0, 1e3])
def test_the_robust_factor_solves_its_equation(size):
    bound = chi2.ppf(0.99, 2)
    z = np.array([1.0, -2.0])
    z = z * np.sqrt(size * bound / told(z).nis)
    root = brentq(lambda b: z @ np.linalg.solve(HPH + b * R, z) - bound, 1.0, 1e6, xtol=1e-12)
    assert robust_factor(z, HPH, R, bound) == pytest.approx(root, rel=1e-6)


def test_chi_square_has_two_thresholds():
    z = np.array([0.6, 0.8]) / np.sqrt(told([0.6, 0.8]).nis)  # nis = 1
    first, second = chi2.ppf([0.99, 0.9999], 2)
    said = [ChiSquare().judge(told(np.sqrt(nis) * z)).r for nis in (0.999 * first, 1.001 * first)]
    assert said[0] is not None
    assert (said[0] == R).all()
    assert said[1] is not None
    assert (np.diag(said[1]) > np.diag(R)).all()
    assert ChiSquare().judge(told(np.sqrt(0.999 * second) * z)).r is not None
    assert ChiSquare().judge(told(np.sqrt(1.001 * second) * z)).r is None


def test_igg3_s_three_parts():
    found = weights(np.array([0.0, 1.5, 1.5 + 1e-9, 3.0, 5.0, 80.0]), 1.5, 5.0)
    middle = 1.5 / 3.0 * (2.0 / 3.5) ** 2
    assert found == pytest.approx([1.0, 1.0, 1.0, middle, 1e-30, 1e-30], rel=1e-6)


def test_igg3_bends_the_axis_that_is_wrong():
    r, rule = np.diag([1.0, 4.0]), Igg3(Igg3Table(window=20))
    rng = np.random.default_rng(0)
    for _ in range(30):
        rule.judge(told(rng.normal(size=2) * np.sqrt(np.diag(r)), r=r, hph=0.2 * r))
    said = rule.judge(told([0.3, 60.0], r=r, hph=0.2 * r)).r
    assert said[0, 0] == 1.0
    assert said[1, 1] > 1e29


def test_sage_husa_is_the_paper_s_recursion():
    rule = SageHusa(SageHusaTable(forget=0.9, prior=0.0, floor=1e-9, limit=1e9))
    rng, r = np.random.default_rng(2), R
    for k in range(1, 40):
        z = rng.multivariate_normal(np.zeros(2), 3.0 * (HPH + R))
        d = (1.0 - 0.9) / (1.0 - 0.9**k)
        r = (1.0 - d) * r + d * (np.outer(z, z) - HPH)
        said = rule.judge(told(z)).r
        if np.linalg.eigvalsh(r).min() > 0.01:
            assert np.allclose(said, r, rtol=1e-9)
    assert np.linalg.eigvalsh(r).min() > 0.01


def test_improved_fading_follows_the_paper_s_signs():
    """S falls by u where sigma^2 grows by m, else it rises, within [S_min, 1]; velocity hears of it."""
    rule, u = ImprovedFading(ImprovedFadingTable(step=0.1, ratio=1.3, least=0.6)), 0.1
    sizes, s, expected = [1.0, 2.0, 2.5, 4.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 1.0], 1.0, []
    for k, size in enumerate(sizes):
        grown = k > 0 and size / sizes[k - 1] >= 1.3
        s = min(max(s - u if grown else s + u, 0.6), 1.0)
        expected.append(s)
    root = np.linalg.cholesky(R)
    for size, s in zip(sizes, expected, strict=True):
        z = root @ np.array([np.sqrt(2.0 * size), 0.0])  # z' R^-1 z / 2 = size
        for said in (rule.judge(told(z)), rule.judge(told([50.0, 50.0], "velocity"))):
            assert said.gain == pytest.approx(1.0 / s, rel=1e-12)
            assert said.noise == pytest.approx(1.0 / s, rel=1e-12)
            assert said.r is R
    assert min(expected) == 0.6


def test_tiny_innovations_are_no_growth():
    rule = ImprovedFading()
    rule.judge(told([1e-9, 0.0]))
    assert rule.judge(told([1e-3, 0.0])).gain == 1.0


def test_fading_counts_positions():
    rule = Fading(FadingTable(factor=1.25))
    assert rule.judge(told([1.0, 1.0])).fade == 1.25
    assert rule.judge(told([1.0, 1.0], "velocity")).fade == 1.0


def test_a_faded_covariance_is_s_times_it_up_to_the_ceiling():
    belief = Belief(Layout())
    a = np.random.default_rng(0).normal(size=(15, 20))
    p = a @ a.T
    belief.P[:] = p
    belief.fade(1.3, np.full(15, np.inf))
    assert np.allclose(belief.P, 1.3 * p, rtol=1e-12)
    ceiling = np.full(15, np.inf)
    ceiling[9:12] = 1.1 * np.diag(p)[9:12]
    ceiling[12:] = 0.5 * np.diag(p)[12:]
    belief.P[:] = p
    belief.fade(1.3, ceiling)
    found = belief.P.copy()
    assert np.allclose(found[:9, :9], 1.3 * p[:9, :9], rtol=1e-12)
    assert np.allclose(np.diag(found)[9:12], ceiling[9:12], rtol=1e-12)
    assert np.array_equal(found[12:, 12:], p[12:, 12:])
    assert np.linalg.eigvalsh(found - p).min() > -1e-9  # what is added is a covariance
