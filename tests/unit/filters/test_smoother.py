"""The adjoint smoother against batch least squares, where both are exact."""

import numpy as np
import pytest

from gapless.filters.smoother import ROUNDING, Adjoint, Correction
from gapless.filters.update import assess, correct

N, ROW, STEPS = 5, 32, 40


class Linear:
    """A linear system, filtered by the functions of the navigator; some steps see nothing, some states have
    no noise, and one step forgets a state."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.phi = [np.eye(N) + 0.2 * rng.normal(size=(N, N)) for _ in range(STEPS)]
        root = [rng.normal(size=(N, 3)) * 0.3 for _ in range(STEPS)]
        self.q = [a @ a.T for a in root]
        self.phi[17][2] = 0.0
        self.q[17] = self.q[17] + 4.0 * np.outer(np.eye(N)[2], np.eye(N)[2])
        self.h = [rng.normal(size=(int(rng.integers(1, 4)), N)) if k % 3 else None for k in range(STEPS)]
        self.r = [None if h is None else np.diag(rng.uniform(0.1, 2.0, len(h))) for h in self.h]
        a = rng.normal(size=(N, N))
        self.mean, self.p0 = rng.normal(size=N), a @ a.T + 0.1 * np.eye(N)
        self.z = [None if h is None else rng.normal(size=len(h)) * 3.0 for h in self.h]

    def filter(self):
        """Estimates and covariances after each step's update, and what a smoother needs of the way."""
        x, p, way, found = self.mean.copy(), self.p0.copy(), [], []
        for phi, q, h, r, z in zip(self.phi, self.q, self.h, self.r, self.z, strict=True):
            x, p = phi @ x, phi @ p @ phi.T + q
            way.append(phi)
            if h is not None:
                flat = np.zeros((ROW, ROW))
                flat[:N, :N] = p
                flat = flat.ravel()
                _, s, hp = assess(flat, ROW, N, z - h @ x, h, r)
                way.append(Correction(h, hp.T @ np.linalg.inv(s), s, z - h @ x))
                x = x + correct(flat, ROW, N, z - h @ x, h, r, s, hp, 1.0)
                p = flat.reshape(ROW, ROW)[:N, :N].copy()
            found.append((x, p))
            way.append(len(found) - 1)
        return found, way

    def batch(self):
        """Everything at once: the Gaussian posterior of all states."""
        size = N * STEPS
        f = np.eye(size)
        for k in range(1, STEPS):
            f[k * N : (k + 1) * N, (k - 1) * N : k * N] = -self.phi[k]
        noise = np.zeros((size, size))
        noise[:N, :N] = self.phi[0] @ self.p0 @ self.phi[0].T + self.q[0]
        for k in range(1, STEPS):
            noise[k * N : (k + 1) * N, k * N : (k + 1) * N] = self.q[k]
        push = np.zeros(size)
        push[:N] = self.phi[0] @ self.mean
        back = np.linalg.inv(f)
        mean, prior = back @ push, back @ noise @ back.T
        seen = [k for k in range(STEPS) if self.h[k] is not None]
        h = np.zeros((sum(len(self.h[k]) for k in seen), size))
        r, z, row = np.zeros((len(h), len(h))), np.zeros(len(h)), 0
        for k in seen:
            m = len(self.h[k])
            h[row : row + m, k * N : (k + 1) * N] = self.h[k]
            r[row : row + m, row : row + m], z[row : row + m] = self.r[k], self.z[k]
            row += m
        gain = np.linalg.solve(h @ prior @ h.T + r, h @ prior).T
        return mean + gain @ (z - h @ mean), prior - gain @ h @ prior


@pytest.mark.parametrize("seed", range(5))
def test_it_is_batch_least_squares(seed):
    system = Linear(seed)
    filtered, way = system.filter()
    mean, covariance = system.batch()
    adjoint = Adjoint(N)
    size = np.abs(covariance).max()
    for entry in reversed(way):
        if isinstance(entry, Correction):
            adjoint.through_correction(entry)
        elif isinstance(entry, int):
            x, p = filtered[entry]
            dx, smaller = adjoint.smooth(p)
            part = slice(entry * N, (entry + 1) * N)
            # both lose some digits of 16 where 40 steps grow states a hundredfold
            assert np.allclose(x + dx, mean[part], rtol=1e-9, atol=1e-9 * np.abs(mean).max())
            assert np.allclose(smaller, covariance[part, part], rtol=1e-9, atol=1e-9 * size)
        else:
            adjoint.through_step(entry)


def test_the_last_moment_is_the_filter_s():
    filtered, _ = Linear(1).filter()
    dx, p = Adjoint(N).smooth(filtered[-1][1])
    assert not dx.any()
    assert np.allclose(p, filtered[-1][1], rtol=1e-15)


def test_what_rounding_leaves_is_stated_as_no_less():
    """A fix of a centimetre after a silence that made 200 m of it, its information wrong by 5e-9."""
    p = np.diag([200.0**2, 1.0])
    back = Adjoint(2)
    back.matrix = np.diag([(1.0 + 5e-9) / (200.0**2 + 0.01**2), 0.0])
    _, smaller = back.smooth(p)
    assert smaller[0, 0] == pytest.approx(ROUNDING * 200.0**2)  # the difference is -1e-4 m^2
    assert smaller[1, 1] == 1.0
