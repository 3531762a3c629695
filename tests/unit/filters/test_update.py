"""The update against the textbook in dense numpy (Joseph form, any gain), and its statistics."""

import numpy as np
import pytest

from gapless.filters.update import assess, cholesky, correct

ROW = 32


def problem(n, m, seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-3.0, 2.0, n)[:, None]
    h, noise = rng.normal(size=(m, n)), rng.normal(size=(m, m))
    return root @ root.T, h, noise @ noise.T + 0.1 * np.eye(m), rng.normal(size=m)


def stored(p):
    """Flat, rows of fixed length, and what lies outside poisoned."""
    flat = np.full(ROW * ROW, np.nan)
    flat.reshape(ROW, ROW)[: len(p), : len(p)] = p
    return flat


def go(p, z, h, r, gain=1.0):
    flat, n = stored(p), len(p)
    nis, s, hp = assess(flat, ROW, n, z, h, r)
    dx = correct(flat, ROW, n, z, h, r, s, hp, gain)
    return nis, s, dx, flat.reshape(ROW, ROW)[:n, :n]


@pytest.mark.parametrize(("n", "m"), [(15, 1), (15, 3), (21, 2), (32, 6)])
@pytest.mark.parametrize("gain", [1.0, 0.6])
def test_update_is_the_joseph_form(n, m, gain):
    for seed in range(5):
        p, h, r, z = problem(n, m, seed)
        nis, s, dx, after = go(p, z, h, r, gain)
        exact = h @ p @ h.T + r
        k = gain * np.linalg.solve(exact, h @ p).T
        left = np.eye(n) - k @ h
        joseph = left @ p @ left.T + k @ r @ k.T
        scale = np.sqrt(np.outer(np.diag(p), np.diag(p)))
        # 32 products of numbers that cancel, with the condition of S: 1e-16 x 32 x 1e4.
        np.testing.assert_allclose(s, exact, rtol=1e-11, atol=1e-12 * np.abs(exact).max())
        np.testing.assert_allclose(nis, z @ np.linalg.solve(exact, z), rtol=1e-10)
        np.testing.assert_allclose(dx, k @ z, rtol=0.0, atol=1e-9 * np.sqrt(np.diag(p)).max())
        np.testing.assert_allclose(after / scale, joseph / scale, rtol=0.0, atol=1e-9)


def test_covariance_stays_symmetric_and_positive_definite():
    """Two thousand updates, each a thousand times sharper than the prior."""
    p, _, _, _ = problem(15, 3, 7)
    p /= np.sqrt(np.outer(np.diag(p), np.diag(p)))
    rng = np.random.default_rng(1)
    for _ in range(2000):
        h = rng.normal(size=(3, 15))
        _, _, _, p = go(p, np.zeros(3), h, 1e-6 * np.eye(3))
        p = p + np.diag(np.full(15, 1e-4))
    assert np.array_equal(p, p.T)
    assert np.linalg.eigvalsh(p)[0] > 0.0


def test_the_last_observation_of_two_may_come_first():
    """Independent observations commute, as the information they add does."""
    p, h, r, z = problem(15, 4, 3)
    r = np.diag(np.diag(r))
    ends = []
    for first, then in ((slice(0, 2), slice(2, 4)), (slice(2, 4), slice(0, 2))):
        _, _, dx, after = go(p, z[first], h[first], r[first, first])
        _, _, more, after = go(after, z[then] - h[then] @ dx, h[then], r[then, then])
        ends.append((dx + more, after))
    size = np.sqrt(np.diag(p))
    np.testing.assert_allclose(ends[0][0] / size, ends[1][0] / size, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(
        ends[0][1] / np.outer(size, size), ends[1][1] / np.outer(size, size), atol=1e-9
    )


def test_cholesky():
    _, _, r, _ = problem(15, 6, 5)
    np.testing.assert_allclose(cholesky(r), np.linalg.cholesky(r), rtol=1e-12, atol=1e-14)
    assert np.isnan(cholesky(np.array([[1.0, 2.0], [2.0, 1.0]]))).any()


def test_nis_is_chi_square():
    """Innovations drawn from S: mean m, variance 2 m; 4000 of them, five deviations of the mean."""
    p, h, r, _ = problem(15, 3, 11)
    rng = np.random.default_rng(0)
    draw = rng.normal(size=(4000, 3)) @ np.linalg.cholesky(h @ p @ h.T + r).T
    nis = np.array([assess(stored(p), ROW, 15, z, h, r)[0] for z in draw])
    assert abs(nis.mean() - 3.0) < 5.0 * np.sqrt(6.0 / 4000.0)
