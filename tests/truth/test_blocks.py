"""What a sample leaves for the next lives in the state: however a block is cut, the bits are the same."""

import numpy as np
import pytest
from strapdown import Run, circuit

from gapless.inertial import propagate as at
from gapless.inertial.increments import split
from gapless.simulate.motion import Vehicle, increments, trajectory
from gapless.trip.recording import Imu

BOX = Vehicle(imu=(1.2, 0.3, -0.6), mounting=(0.05, -0.08, 0.6))
NOISE = np.array([1e-8, 1e-4, 1e-12, 1e-8, 1e-4, 1.0 / 3600.0, 1.0 / 1800.0])
EXTRAS = ("gyro_scale", "accel_scale", "gravity", "mounting")


@pytest.fixture(scope="module")
def imu() -> Imu:
    return increments(circuit(60.0), 200.0, BOX)


def start(extras=EXTRAS, noise=NOISE, open_loop=True) -> Run:
    truth = trajectory(circuit(60.0), np.array([0.0]), BOX)
    run = Run(truth.lla[0], truth.v_n[0], truth.euler[0], extras, noise, open_loop)
    run.P[:] = np.diag(np.linspace(0.1, 2.0, run.layout.n))
    run.error[: run.layout.n if open_loop else 0] = 1e-3
    return run


def cut(run: Run, imu: Imu, pieces: list[int], last: int) -> list[int]:
    """Run to `last` in pieces of these lengths, over and over; where the ticks fell."""
    k, ticks, turn, end = 0, [], 0, 0
    while k < last:
        end = min(last, end + pieces[turn % len(pieces)])
        turn += 1
        while k < end:
            k = run.go(imu, k, end, period=0.03, tick=0.1)
            if run.memory[at.TICK_DT] >= 0.1 - 1e-7:
                ticks.append(k)
                run.memory[at.TICK_DT :] = 0.0
    return ticks


@pytest.mark.parametrize("pieces", [[1], [1234], [7, 1, 40]])
def test_cutting_gives_the_same_bits(imu, pieces):
    whole, parts = start(), start()
    last = 4003
    assert cut(whole, imu, [last], last) == cut(parts, imu, pieces, last) == list(range(20, 4001, 20))
    for name in ("x", "memory", "p", "error"):
        assert np.array_equal(getattr(whole, name), getattr(parts, name)), name
    assert whole.memory[at.COV_DT] > 0.0  # the covariance is in the middle of its period: the cut mattered


def test_flush_brings_the_covariance_up_to_the_sample(imu):
    """At every sample and with one flush: the same time covered, so the same bias variance."""
    run = start(extras=(), open_loop=False)
    run.go(imu, 0, 4, period=0.03, flush=True)
    assert run.memory[at.COV_DT] == 0.0
    assert run.P[0, 0] > 0.1


def test_optional_states_of_an_open_loop_error_stay(imu):
    """Feed-forward: constant states keep their value bit for bit, and drive what they drive."""
    run = start(noise=np.zeros(7))
    before = run.error.copy()
    run.error[:15] = 0.0
    run.go(imu, 0, 4000)
    assert np.array_equal(run.error[15 : run.layout.n], before[15 : run.layout.n])
    assert np.all(run.error[:9] != 0.0)


def test_optional_states_cost_the_core_nothing(imu):
    """With their variance zero, the core's covariance is that of a filter without them."""
    plain, rich = start(extras=(), open_loop=False), start(open_loop=False)
    plain.P[:] = np.diag(np.linspace(0.1, 2.0, 15))
    rich.P[:] = 0.0
    rich.P[:15, :15] = plain.P
    plain.go(imu, 0, 1000)
    rich.go(imu, 0, 1000)
    assert np.array_equal(plain.x[:16], rich.x[:16])
    # Adding a product with zero may fuse or round otherwise: 1000 steps of 1e-16.
    np.testing.assert_allclose(rich.P[:15, :15], plain.P, rtol=1e-12, atol=1e-14)


def divided(imu: Imu, share: float) -> Imu:
    """Every sample but the first cut in two, `share` of it first."""
    rows = [(imu.time[0], imu.dt[0], imu.dtheta[0], imu.dvel[0])]
    for k in range(1, len(imu.time)):
        before, now = float(rows[-1][1]), float(imu.dt[k])
        part = share * now
        first = [
            split(new[k], old, before, now, part)
            for new, old in ((imu.dtheta, rows[-1][2]), (imu.dvel, rows[-1][3]))
        ]
        rows.append((imu.time[k] - now + part, part, *first))
        rows.append((imu.time[k], now - part, imu.dtheta[k] - first[0], imu.dvel[k] - first[1]))
    time, dt, dtheta, dvel = (np.array(c) for c in zip(*rows, strict=True))
    return Imu(time, dt, dtheta, dvel)


@pytest.mark.parametrize("share", [0.3, 0.5, 0.8])
def test_a_cut_sample_navigates_like_the_whole_one(share):
    """Rates linear in time, over samples small enough for third order to vanish."""
    dt, n = 1e-3, 20
    edges = dt * np.arange(n + 1)
    rate, ramp = (
        np.array([[0.2, -0.3, 0.4], [2.0, 3.0, -12.0]]),
        np.array([[1.0, 0.5, -0.8], [4.0, -3.0, 2.0]]),
    )
    mid = 0.5 * (edges[1:] + edges[:-1])
    increment = [(rate[i] + np.outer(mid, ramp[i])) * dt for i in (0, 1)]
    imu = Imu(edges[1:], np.full(n, dt), *increment)
    ends = []
    for log in (imu, divided(imu, share)):
        run = Run([0.7, 0.1, 50.0], [20.0, -10.0, 1.0], [0.1, -0.2, 1.0])
        run.go(log, period=1e9)
        ends.append(run)
    # Both follow linear rates to second order. Of third order are w (w' dt^2) (w dt) = 2e-10 x 1e-3 rad
    # and f w w' dt^4 = 6e-12 m/s a sample, each with a factor of a twelfth or less, 20 times.
    assert np.linalg.norm(ends[0].turn_from(ends[1].x[6:10])) < 1e-12
    np.testing.assert_allclose(ends[0].x[3:6], ends[1].x[3:6], rtol=0.0, atol=1e-11)


def test_covariance_stays_symmetric_and_positive_definite():
    """Thirty minutes at every sample without an observation."""
    path = circuit(1800.0)
    imu = increments(path, 200.0, BOX)
    run = start(extras=("gyro_scale",), open_loop=False)
    run.P[:] = np.diag(np.repeat([1.0, 0.01, 1e-4, 1e-8, 1e-4, 1e-6], 3))
    run.go(imu)
    scale = np.sqrt(np.diag(run.P))
    correlation = run.P / np.outer(scale, scale)
    # Rounding of 360,000 steps: 6e2 (random walk) x 1e-16, with room for what the dynamics amplify.
    assert np.abs(correlation - correlation.T).max() < 1e-11
    lowest = np.linalg.eigvalsh(correlation + correlation.T)[0]
    print(f"asymmetry {np.abs(correlation - correlation.T).max():.1e}, smallest eigenvalue {lowest / 2:.1e}")
    assert lowest > 0.0
