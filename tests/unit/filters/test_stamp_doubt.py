"""The response to stamps that are off is that of a filter that is fed with them."""

from __future__ import annotations

import numpy as np
import pytest

from gapless.filters.stamp_doubt import SURE, Doubt, StampDoubt
from gapless.filters.whiten import whiten
from gapless.inertial.layout import ROW


def fed(v, gain, theta=1.0, wobble=None):
    """Error of a position that follows velocities of stamps off by theta and is corrected by such fixes."""
    error, before = np.zeros(3), None
    for k, now in enumerate(v):
        late = theta if wobble is None else wobble[k]
        if wobble is None and before is not None:
            error = error + (now - before) * late
        error = (1.0 - gain) * error + gain * now * late
        before = now
    return error


def heard(v, gain, lasting=10.0):
    p = np.zeros((ROW, ROW))
    p[:3, :3] = gain * np.eye(3)
    one = StampDoubt()
    for k, now in enumerate(v):
        one.hear(float(k), p.ravel(), ROW, np.eye(3), now, lasting)
    return one


V = np.cumsum(np.random.default_rng(3).standard_normal((60, 3)), axis=0)


def test_common_offset():
    # the first fix finds no velocity before it: the error begins with the gain, in both
    found = heard(V, 0.2)
    assert found.constant[0] == pytest.approx(fed(V, 0.2), rel=1e-9)
    assert found.stated(Doubt(0.1)) == pytest.approx(0.01 * np.outer(found.constant[0], found.constant[0]))
    assert not found.stated(SURE).any()


def test_wobble_is_the_mean_square_of_many():
    rng, decay = np.random.default_rng(4), np.exp(-0.1)
    errors = []
    for _ in range(2000):
        w = [rng.standard_normal()]
        for _ in V[1:]:
            w.append(decay * w[-1] + np.sqrt(1.0 - decay**2) * rng.standard_normal())
        errors.append(fed(V, 0.2, wobble=w))
    stated = heard(V, 0.2).stated(Doubt(wobble=1.0))
    # 2000 draws know a variance to 3 %
    assert np.mean(np.square(errors), axis=0) == pytest.approx(stated.diagonal(), rel=0.12)


def test_copies_are_independent():
    one = heard(V[:5], 0.2)
    other, before = one.copy(), one.constant.copy()
    other.hear(9.0, np.eye(ROW).ravel(), ROW, np.eye(3), V[6], 10.0)
    assert np.array_equal(one.constant, before)


def test_whitening_is_that_of_a_cholesky_factor():
    t = np.array([0.0, 1.0, 2.5, 3.0, 7.0])
    noise = np.array([1.0, 1.0, 4.0, 1.0, 1.0])
    slow = 4.0 * np.exp(-np.abs(t[:, None] - t) / 60.0) + 0.09 * np.minimum(t[:, None], t)
    whole = slow + np.diag(noise)
    y = np.random.default_rng(1).standard_normal((5, 2))
    white, log_det = whiten(t, noise, 2.0, 60.0, 0.3, y)
    assert white == pytest.approx(np.linalg.solve(np.linalg.cholesky(whole), y), rel=1e-9)
    assert log_det == pytest.approx(np.linalg.slogdet(whole)[1], rel=1e-9)
