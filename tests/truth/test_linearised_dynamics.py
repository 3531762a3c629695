"""The error dynamics against finite differences of the nonlinear mechanisation.

truth = estimate (+) error, as `inertial.layout` says: the perturbed state is integrated on the same
increments and the difference to the nominal is what Phi says, in every column, in fast motion.
"""

import numpy as np
import pytest
from scipy.linalg import expm
from strapdown import Run

from gapless import attitude, earth
from gapless.inertial.dynamics import transition
from gapless.inertial.layout import NAV, ROW
from gapless.inertial.mechanise import local_earth, mechanise
from gapless.trip.recording import Imu

EXTRAS = ("gyro_scale", "accel_scale", "gravity")
STEPS, DT, SPEED = 200, 1e-3, 290.0
SIZES = np.repeat([1e4, 10.0, 1e-3, 1e-2, 0.1, 1e-2, 1e-2, 0.1], 3)
"""Perturbation of each state: far above rounding; what central differences leave is of third order."""


def increments() -> Imu:
    """A fast aircraft in a hard, rolling turn."""
    rate, force = np.array([0.3, -0.2, 0.5]), np.array([3.0, 6.0, -14.0])
    ones = np.ones((STEPS, 1))
    return Imu(DT * np.arange(1, STEPS + 1), np.full(STEPS, DT), ones * rate * DT, ones * force * DT)


def start() -> Run:
    run = Run([0.8, 0.3, 3000.0], [180.0, 220.0, 60.0], [0.4, 0.1, -0.9], EXTRAS, open_loop=True)
    run.x[10:16] = [5e-3, -3e-3, 2e-3, 0.05, -0.04, 0.02]
    run.x[16:22] = [4e-3, -2e-3, 3e-3, -2e-3, 5e-3, 1e-3]
    run.x[22:25] = [1e-3, -1e-3, 5e-4]
    return run


def add(x: np.ndarray, dx: np.ndarray) -> np.ndarray:
    """The error convention, written once more and independently of the filter's injection."""
    r_m, r_n = earth.radii(np.sin(x[0]))
    new = x.copy()
    new[:3] += dx[:3] / [r_m + x[2], (r_n + x[2]) * np.cos(x[0]), -1.0]
    new[3:6] += dx[3:6]
    new[6:10] = attitude.multiply(attitude.from_rotation_vector(dx[6:9]), x[6:10])
    new[10:] += dx[9:]
    return new


def subtract(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The dx that takes b to a, to first order."""
    r_m, r_n = earth.radii(np.sin(b[0]))
    q = attitude.multiply(a[6:10], b[6:10] * [1.0, -1.0, -1.0, -1.0])
    position = (a[:3] - b[:3]) * [r_m + b[2], (r_n + b[2]) * np.cos(b[0]), -1.0]
    return np.concatenate([position, a[3:6] - b[3:6], 2.0 * q[1:] / q[0], a[10:] - b[10:]])


@pytest.fixture(scope="module")
def differences() -> np.ndarray:
    """Phi of the whole interval by central differences."""
    imu, nominal = increments(), start()
    columns = []
    after = nominal.copy()
    after.go(imu)
    for j, size in enumerate(SIZES):
        ends = []
        for sign in (1.0, -1.0):
            run = nominal.copy()
            run.x = add(nominal.x, sign * size * np.eye(24)[j])
            run.go(imu)
            ends.append(subtract(run.x, after.x))
        columns.append((ends[0] - ends[1]) / (2.0 * size))
    return np.column_stack(columns)


@pytest.fixture(scope="module")
def steps() -> np.ndarray:
    """Phi of each sample, from the plain Python functions that the kernel compiles."""
    imu, run = increments(), start()
    x, every = run.x, []
    lat, lon, h, v, q = x[0], x[1], x[2], tuple(x[3:6]), tuple(x[6:10])
    before, before_v, dt0 = (0.0,) * 3, (0.0,) * 3, 0.0
    for k in range(STEPS):
        c, local = tuple(attitude.to_matrix(q).ravel()), local_earth(lat, h, v, DT)
        w = tuple(imu.dtheta[k] * (1.0 + x[16:19]) - x[10:13] * DT)
        f = tuple(imu.dvel[k] * (1.0 + x[19:22]) - x[13:16] * DT)
        v0, dg = v, tuple(x[22:25])
        lat, lon, h, v, q, f_n = mechanise(lat, lon, h, v, q, c, local, dg, w, f, before, before_v, dt0, DT)
        before, before_v, dt0 = w, f, DT
        rows, tail = np.zeros(NAV * ROW), np.ones(ROW)
        transition(
            v0, local, f_n, c, imu.dtheta[k], imu.dvel[k], DT, (0.0, 0.0), run.layout.offsets, rows, tail
        )
        phi = np.diag(tail[:24])
        phi[:NAV] = rows.reshape(NAV, ROW)[:, :24]
        every.append(phi)
    return np.array(every)


def product(steps: np.ndarray) -> np.ndarray:
    total = np.eye(24)
    for phi in steps:
        total = phi @ total
    return total


def tolerance(steps: np.ndarray) -> np.ndarray:
    """What linearisation at each sample's start leaves, entry by entry.

    With A = sum |F| dt, the product of I + F dt falls short of exp by A^2 exp(A) / (2 STEPS), and F is
    taken at each sample's start: half of what it changes, added up. Both are doubled. F leaves out,
    knowingly, that radii change with latitude (by less than 3 e^2 R a radian, all of it in the first
    column) and the third figure of gravity's change with height (0.4 %) and latitude (0.6 %).
    Central differences leave size^2 / 6 of a rotation. A latitude is rounded to 7e-10 m, 200 times.
    """
    a = np.abs(steps - np.eye(24)).sum(axis=0)
    late = np.abs(np.diff(steps, axis=0)).sum(axis=0)
    left_out = np.zeros((24, 24))
    left_out[:, :3] = 0.01 * a[:, :3]
    turn = SPEED / earth.SEMI_MAJOR
    rates = np.repeat([turn, turn * turn, turn / earth.SEMI_MAJOR], 3)
    left_out[:NAV, 0] += 3.0 * earth.ECCENTRICITY_2 * rates * STEPS * DT
    third = np.zeros((24, 24))
    third[:, 6:9] = (np.eye(24) + a)[:, 6:9] * SIZES[6] ** 2 / 6.0
    rounding = np.where(np.arange(24) < 2, 2e-8, 1e-13)[:, None] / SIZES
    grown = expm(a)
    return 2.0 * (a @ a @ grown) / STEPS + grown @ (late + left_out + third) @ grown + rounding


def test_kernel_and_plain_python_have_the_same_phi(steps):
    imu = increments()
    for j in range(24):
        run = start()
        run.error[j] = 1.0
        run.go(imu)
        # The same formulas in another order of summation: 200 steps of rounding.
        np.testing.assert_allclose(run.error[:24], product(steps)[:, j], rtol=1e-10, atol=1e-13)


def test_every_column_agrees_with_finite_differences(steps, differences):
    excess = np.abs(product(steps) - differences) / tolerance(steps)
    worst = np.unravel_index(excess.argmax(), excess.shape)
    assert excess.max() < 1.0, f"row, column {worst}: {excess.max():.2f} of the tolerance"


def test_a_wrong_coefficient_is_noticed(steps, differences):
    """Each entry of F in turn, made wrong by a quarter or left out."""
    limit, blind = tolerance(steps), []
    unit = np.eye(24)
    entries = np.argwhere(np.abs(steps - unit).max(axis=0) > 0.0)
    assert len(entries) > 70
    for i, j in entries:
        for factor in (0.0, 1.25):
            wrong = steps.copy()
            wrong[:, i, j] = unit[i, j] + factor * (steps[:, i, j] - unit[i, j])
            if (np.abs(product(wrong) - differences) < limit).all():
                blind.append((int(i), int(j), factor))
    assert not blind


def test_covariance_and_error_go_through_phi(steps):
    """Dense products with decaying biases, against the kernel's blocks."""
    decay = np.array([0.0] * 5 + [0.2, 0.5])  # 1/s; no noise
    steps = steps.copy()
    for axis in range(9, 15):
        steps[:, axis, axis] = 1.0 - DT * decay[5 if axis < 12 else 6]
    rng = np.random.default_rng(2)
    root, error = rng.normal(size=(24, 24)), rng.normal(size=24)
    run = start()
    run.noise, run.P[:], run.error[:] = decay, root @ root.T, error
    run.go(increments())
    phi = product(steps)
    expected = phi @ root @ root.T @ phi.T
    # Sums of 24 products, 200 times.
    np.testing.assert_allclose(run.P, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())
    np.testing.assert_allclose(run.error, phi @ error, rtol=1e-10, atol=1e-12 * np.abs(phi @ error).max())
