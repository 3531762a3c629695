"""The adjoint smoother fed with what cubature points say is the textbook's cubature smoother (CRTS).

With the R of the variational rule it is the variational one (VB-ACKS): both are written out here.
"""

import numpy as np
import pytest

from gapless.filters.adaptation.base import Innovation
from gapless.filters.adaptation.registry import Chain, chain
from gapless.filters.adaptation.variational import Variational, VariationalTable
from gapless.filters.smoother import Adjoint, Correction
from gapless.filters.update import assess, correct
from gapless.inertial.points import factor, linearised, scatter

N, ROW, STEPS, DT = 4, 32, 60, 0.5
Q = np.diag([0.01, 0.01, 0.004, 0.02])
R = np.array([[0.3, 0.1], [0.1, 0.5]])
FORGET, PRIOR, TURNS = 0.95, 10.0, 4


def move(x):
    """A car of place, heading and speed: far from linear at these deviations."""
    east, north, heading, speed = x
    return np.array(
        [east + DT * speed * np.sin(heading), north + DT * speed * np.cos(heading), heading + 0.1, speed]
    )


def place(x):
    return x[:2]


def ranges(x):
    """To two beacons."""
    return np.array([np.hypot(x[0] - 20.0, x[1] + 5.0), np.hypot(x[0] + 8.0, x[1] - 15.0)])


def simulated(see, seed):
    rng = np.random.default_rng(seed)
    x, z = np.array([0.0, 0.0, 0.3, 3.0]), []
    for _ in range(STEPS):
        x = move(x) + np.sqrt(np.diag(Q)) * rng.normal(size=N)
        z.append(see(x) + np.linalg.cholesky(3.0 * R) @ rng.normal(size=2))
    return np.array(z)


START = np.array([0.5, -0.5, 0.1, 2.5]), np.diag([1.0, 1.0, 0.15, 0.5])


# --- the textbook ---------------------------------------------------------------------------------


def points(x, p):
    root = np.sqrt(N) * np.linalg.cholesky(p)
    return np.concatenate([x + root.T, x - root.T])


def moments(values, around):
    mean = values.mean(0)
    return mean, (values - mean).T @ (values - mean) / len(values), around.T @ (values - mean) / len(values)


def update(x, p, z, see, r):
    at = points(x, p)
    expected, pzz, pxz = moments(np.array([see(a) for a in at]), at - x)
    s = pzz + r
    gain = pxz @ np.linalg.inv(s)
    return x + gain @ (z - expected), p - gain @ s @ gain.T


def textbook(z, see, adapt):
    """Filter forwards (Särkkä and Hartikainen 2013 for R), then Rauch, Tung and Striebel's gain backwards."""
    x, p = START
    d, nu, v, way = 2, PRIOR + 3.0, PRIOR * R, []
    for seen in z:
        at = points(x, p)
        ahead, spread, cross = moments(np.array([move(a) for a in at]), at - x)
        predicted = spread + Q
        r = R
        if adapt:
            nu = FORGET * (nu - d - 1.0) + d + 1.0 + 1.0
            before = FORGET * v
            v = before
            for _ in range(TURNS):
                r = v / (nu - d - 1.0)
                xj, pj = update(ahead, predicted, seen, see, r)
                off = seen - np.array([see(a) for a in points(xj, pj)])
                v = before + off.T @ off / len(off)
        x, p = update(ahead, predicted, seen, see, r)
        way.append((x, p, ahead, predicted, cross))
    smoothed = [way[-1][:2]]
    for k in range(len(way) - 2, -1, -1):
        (x, p, *_), (_, _, ahead, predicted, cross) = way[k], way[k + 1]
        xs, ps = smoothed[-1]
        gain = cross @ np.linalg.inv(predicted)
        smoothed.append((x + gain @ (xs - ahead), p + gain @ (ps - predicted) @ gain.T))
    return smoothed[::-1]


# --- ours -----------------------------------------------------------------------------------------


def regressed(function, x, p):
    low = factor(p.ravel(), N, N)
    root = np.sqrt(N) * low
    pair = np.array([[function(x + s * c) for c in root.T] for s in (1.0, -1.0)])
    mean, extra = scatter(0.5 * (pair[0] + pair[1]))
    return mean, linearised(0.5 * (pair[0] - pair[1]), low), extra


def ours(z, see, rule):
    x, p = START
    way, filtered = [], []
    for k, seen in enumerate(z):
        x, phi, extra = regressed(move, x, p)
        p = phi @ p @ phi.T + extra + Q
        way.append(phi)
        expected, h, extra = regressed(see, x, p)
        flat = np.zeros((ROW, ROW))
        flat[:N, :N] = p
        flat = flat.ravel()
        innovation, stated = seen - expected, R + extra
        nis, s, hp = assess(flat, ROW, N, innovation, h, stated)
        r = rule.judge(Innovation("position", float(k), innovation, s, stated, nis)).r
        s = s + (r - stated)
        way.append(Correction(h, hp.T @ np.linalg.inv(s), s, innovation))
        x = x + correct(flat, ROW, N, innovation, h, r, s, hp, 1.0)
        p = flat.reshape(ROW, ROW)[:N, :N].copy()
        way.append(len(filtered))
        filtered.append((x, p))
    adjoint, found = Adjoint(N), {}
    for entry in reversed(way):
        if isinstance(entry, Correction):
            adjoint.through_correction(entry)
        elif isinstance(entry, int):
            dx, smaller = adjoint.smooth(filtered[entry][1])
            found[entry] = filtered[entry][0] + dx, smaller
        else:
            adjoint.through_step(entry)
    return [found[k] for k in range(len(z))]


def agree(found, expected):
    """To what 60 steps of both leave of 16 digits."""
    for (x, p), (xs, ps) in zip(found, expected, strict=True):
        assert np.allclose(x, xs, rtol=1e-8, atol=1e-8)
        assert np.allclose(p, ps, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("see", [place, ranges])
@pytest.mark.parametrize("seed", range(3))
def test_crts(see, seed):
    z = simulated(see, seed)
    agree(ours(z, see, Chain()), textbook(z, see, adapt=False))


@pytest.mark.parametrize("seed", range(3))
def test_vb_acks(seed):
    z = simulated(place, seed)
    rule = Variational(VariationalTable(forget=FORGET, prior=PRIOR, iterations=TURNS, limit=1e9))
    expected = textbook(z, place, adapt=True)
    agree(ours(z, place, rule), expected)
    plain = textbook(z, place, adapt=False)
    # R is three times what is stated, and the rule has noticed: it states more
    assert expected[40][1][0, 0] > 1.2 * plain[40][1][0, 0]


def test_the_default_rule_is_the_variational_one_but_for_its_limit():
    z = simulated(place, 0)
    table = VariationalTable(forget=FORGET, prior=PRIOR, iterations=TURNS)
    agree(
        ours(z, place, chain("gnss", ["variational"], {"variational": table})), textbook(z, place, adapt=True)
    )
