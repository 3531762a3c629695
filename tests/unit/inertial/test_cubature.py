"""Cubature moments against a few lines of textbook, and against Taylor's where P is small."""

import numpy as np
import pytest

from gapless import attitude, earth
from gapless.inertial import propagate as at
from gapless.inertial.belief import Belief, inject
from gapless.inertial.cubature import propagate_points, spread
from gapless.inertial.layout import NAV, ROW, Layout
from gapless.inertial.points import factor, linearised, scatter
from gapless.inertial.propagate import propagate
from gapless.measurements.base import Observation
from gapless.measurements.spread import regress

RATE, PERIOD = 100.0, 0.05
EXTRAS = ("gyro_scale", "accel_scale", "gravity", "lever_arm")
SD = {
    "position": 2.0,
    "velocity": 0.3,
    "attitude": 0.02,
    "gyro_bias": 1e-3,
    "accel_bias": 0.05,
    "gyro_scale": 2e-3,
    "accel_scale": 3e-3,
    "gravity": 5e-4,
    "lever_arm": 0.5,
}


def cubature(function, mean, p):
    """Mean, covariance, cross-covariance of function(x), x ~ N(mean, p): the textbook's loop."""
    n = len(mean)
    root = np.linalg.cholesky(p) * np.sqrt(n)
    points = np.array([mean + s * c for c in root.T for s in (1.0, -1.0)])
    values = np.array([function(x) for x in points])
    y, dx = values - values.mean(0), points - mean
    return values.mean(0), y.T @ y / len(y), dx.T @ y / len(y)


def random_covariance(n, seed, size=1.0):
    a = np.random.default_rng(seed).normal(size=(n, n + 2))
    return size * (a @ a.T / n + 0.1 * np.eye(n))


@pytest.mark.parametrize("seed", range(3))
def test_pairs_give_the_textbook_s_moments(seed):
    """On a nonlinear toy: the same mean, covariance and gain matrix, to rounding."""
    n, p, mean = 5, random_covariance(5, seed), np.linspace(-1.0, 1.0, 5)
    toy = lambda x: np.array([np.sin(x[0]) * x[1], np.exp(0.3 * x[2]), x[3] ** 2 + x[4]])  # noqa: E731
    low = factor(p.ravel(), n, n)
    assert np.allclose(low @ low.T, p, rtol=1e-12, atol=1e-14)
    pairs = np.array([[toy(mean + s * np.sqrt(n) * c) for c in low.T] for s in (1.0, -1.0)])
    half, middle = 0.5 * (pairs[0] - pairs[1]), 0.5 * (pairs[0] + pairs[1])
    y, extra = scatter(middle)
    h = linearised(half, low)
    expected, covariance, cross = cubature(toy, mean, p)
    assert np.allclose(y, expected, rtol=1e-12)
    assert np.allclose(h, np.linalg.solve(p, cross).T, rtol=1e-9, atol=1e-11)
    assert np.allclose(h @ p @ h.T + extra, covariance, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_a_linear_function_is_met_exactly(seed):
    n, p = 6, random_covariance(6, seed)
    a = np.random.default_rng(seed).normal(size=(4, n))
    low = factor(p.ravel(), n, n)
    half = np.sqrt(n) * (a @ low).T
    assert np.allclose(linearised(half, low), a, rtol=1e-10, atol=1e-12)
    assert not scatter(np.zeros((n, 4)))[1].any()


def test_a_singular_covariance_has_a_factor():
    """A state that is known, and one that is a sum of others."""
    p = random_covariance(4, 1)
    p[2], p[:, 2] = 0.0, 0.0
    mix = np.eye(5, 4)
    mix[4] = [1.0, -2.0, 0.0, 0.5]
    p = mix @ p @ mix.T
    low = factor(p.ravel(), 5, 5)
    assert np.allclose(low @ low.T, p, rtol=1e-12, atol=1e-12)
    assert not low[:, 2].any()
    assert not low[:, 4].any()
    assert np.isfinite(linearised(np.sqrt(5) * low.T.copy(), low)).all()


def start(scale, extras=EXTRAS, seed=2):
    """A car in a turn, its covariance of every correlation, times scale^2."""
    layout = Layout(extras)
    x = np.zeros(layout.n + 1)
    x[:3], x[3:6] = (0.56, 2.07, 30.0), (12.0, -5.0, 0.3)
    x[6:10] = attitude.from_euler(np.array([0.03, -0.05, 0.9]))
    x[10:16] = [1e-3, -2e-3, 1e-3, 0.05, -0.02, 0.1]
    sd = np.concatenate([np.full(b.stop - b.start, SD[name]) for name, b in layout.blocks.items()])
    p = np.zeros((ROW, ROW))
    p[: layout.n, : layout.n] = scale**2 * random_covariance(layout.n, seed) * np.outer(sd, sd)
    return layout, x, p.ravel()


def increments(n, seed=0):
    rng = np.random.default_rng(seed)
    rates = np.array([0.02, -0.03, 0.25]) + 0.02 * rng.normal(size=(n, 3))
    forces = np.array([1.0, 2.5, -9.7]) + 0.3 * rng.normal(size=(n, 3))
    return np.arange(1, n + 1) / RATE, np.full(n, 1.0 / RATE), rates / RATE, forces / RATE


def carried(function, layout, x, p, n=20, noise=None):
    x, p, memory = x.copy(), p.copy(), np.zeros(at.MEMORY_SIZE)
    noise = np.zeros(7) if noise is None else noise
    scratch = np.zeros((2, ROW * ROW))
    state = (x, memory, layout.width, p, scratch, np.zeros(0), layout.offsets, noise)
    assert function(*state, *increments(n), 0, n, PERIOD, 1e9, True) == n
    phi = np.diag(scratch[1][NAV * ROW :][: layout.n])
    phi[:NAV] = scratch[1][: NAV * ROW].reshape(NAV, ROW)[:, : layout.n]
    return x, p.reshape(ROW, ROW)[: layout.n, : layout.n], phi


@pytest.mark.parametrize("extras", [(), ("gravity",), EXTRAS])
def test_taylor_is_the_limit_for_a_small_covariance(extras):
    """What is left is Taylor's own: a step changes Phi by F dt of some 0.04, and F^2 dt^2 / 2 is left out."""
    layout, x, p = start(1e-2, extras)
    noise = np.array([1e-8, 1e-5, 1e-12, 1e-9, 1e-6, 0.0, 0.0])
    one, other = (carried(f, layout, x, p, noise=noise) for f in (propagate, propagate_points))
    sd = np.sqrt(np.diag(one[1]))
    unit = sd[:, None] / sd  # Phi in deviations
    assert 0.03 < np.abs((one[2] - np.eye(layout.n)) / unit).max() < 0.05
    assert np.abs((other[2] - one[2]) / unit).max() < 1e-3
    assert np.abs((other[1] - one[1]) / np.outer(sd, sd)).max() < 1e-3
    # the mean shifts by half a variance of attitude (2e-4 rad)^2 times 10 m/s^2 over 0.2 s
    assert 0.0 < np.abs(other[0] - one[0])[3:6].max() < 1e-6


def test_one_step_is_a_cubature_of_the_strapdown():
    """Mean and covariance of a step against the textbook's loop over the mechanisation."""
    layout, x, p = start(1.0)
    n, steps = layout.n, 5
    time, dt, dtheta, dvel = increments(steps)
    full = p.reshape(ROW, ROW)[:n, :n]

    def outcome(dx):
        """Nominal state after the step of a car that is dx away, sample by sample."""
        moved = x.copy()
        inject(moved, dx)
        memory, scratch = np.zeros(at.MEMORY_SIZE), np.zeros((2, ROW * ROW))
        rest = (np.zeros(ROW * ROW), scratch, np.zeros(0), layout.offsets, np.zeros(7))
        propagate(moved, memory, layout.width, *rest, time, dt, dtheta, dvel, 0, steps, 1.0, 1e9, False)
        return moved

    centre = outcome(np.zeros(n))

    def error(dx):
        moved = outcome(dx)
        turn = attitude.to_matrix(moved[6:10]) @ attitude.to_matrix(centre[6:10]).T
        angle = np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0))
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        rotation = axis * (angle / (2.0 * np.sin(angle)) if angle > 1e-9 else 0.5)
        return np.concatenate(
            [
                earth.lla_to_ned(moved[:3], centre[:3]),
                moved[3:6] - centre[3:6],
                rotation,
                moved[10:] - centre[10:],
            ]
        )

    shift, covariance, cross = cubature(error, np.zeros(n), full)
    found_x, found_p, phi = carried(propagate_points, layout, x, p, steps)
    sd = np.sqrt(np.diag(covariance))
    # one step against five: coning of 1e-6 rad on angles of 0.05 rad; metres by mean radii against north's
    assert np.abs((found_p - covariance) / np.outer(sd, sd)).max() < 1e-4
    assert np.allclose(found_x[3:6] - centre[3:6], shift[3:6], atol=1e-4 * sd[3:6].max())
    assert np.abs(shift[3:6]).max() > 1e-5  # there is something to find
    expected = np.linalg.solve(full, cross).T
    assert np.abs((phi - expected) * sd / sd[:, None]).max() < 1e-3


def test_a_heading_that_may_be_anything_stays_so():
    """Points beyond half a turn are told from those within."""
    layout, x, p = start(1e-3, ())
    wide = p.reshape(ROW, ROW)
    wide[8, :], wide[:, 8] = 0.0, 0.0
    wide[8, 8] = np.radians(100.0) ** 2
    _, after, _ = carried(propagate_points, layout, x, wide.ravel())
    assert np.sqrt(after[8, 8]) == pytest.approx(np.radians(100.0), rel=1e-6)


def test_an_observation_over_a_belief_is_the_textbook_s():
    """Range to a beacon: z, S and gain of a cubature filter."""
    layout = Layout(())
    belief = Belief(layout)
    _, x, p = start(1.0, ())
    belief.x[:], belief.p[:] = x, p
    beacon = np.array([6.0, -3.0, 1.0])
    here = x[:3].copy()

    def predicted(lla):
        return np.linalg.norm(earth.lla_to_ned(lla, here) - beacon)

    reading, r = 7.0, np.array([[0.04]])
    asked = lambda b: Observation(np.array([reading - predicted(b.lla)]), np.zeros((1, 15)), r)  # noqa: E731
    found = regress(belief, asked)

    def by_error(dx):
        moved = x.copy()
        inject(moved, dx)
        return np.array([predicted(moved[:3])])

    z, pzz, pxz = cubature(by_error, np.zeros(15), belief.P)
    s = found.H @ belief.P @ found.H.T + found.R
    assert found.z == pytest.approx(reading - z, rel=1e-9)
    assert s == pytest.approx(pzz + r, rel=1e-9)
    gain = belief.P @ found.H.T / s
    assert np.allclose(gain, pxz / (pzz + r), rtol=1e-7, atol=1e-12 * np.abs(gain).max())
    assert found.R[0, 0] > 1.5 * r[0, 0]  # far from linear at this distance
    assert (belief.x == x).all()


def test_spread_is_what_it_says():
    """Halves are odd in the factor, middles even."""
    layout, x, p = start(1.0)
    low = factor(p, ROW, layout.n)
    w, f = (0.001, -0.002, 0.01), (0.05, 0.1, -0.49)
    one, other = spread(x, low, layout.offsets, w, f, 0.05), spread(x, -low, layout.offsets, w, f, 0.05)
    assert np.allclose(one[0], -other[0], rtol=1e-12)
    assert np.allclose(one[1], other[1], rtol=1e-12)
