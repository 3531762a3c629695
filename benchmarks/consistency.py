"""Whether the filter's covariance tells the truth: NEES, NIS and outage ellipses over simulated drives.

    python benchmarks/consistency.py [--grade consumer] [--drives 50] [--constraints]

The receiver's errors are what the filter takes them for (white, stated deviations true, clock offset
zero and given) and the filter's sensor is the simulated one, so every figure has a known
distribution: NEES and NIS averaged over independent drives are chi-square with drives x dimension
degrees of freedom, and 95 % of the outages end inside their 95 % ellipse.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from msgspec.structs import replace

from gapless import attitude, earth
from gapless.evaluation.statistics import chi_square_quantile, consistency, nees
from gapless.fold.feed import events
from gapless.fold.navigator import Navigator
from gapless.sensors import Grade
from gapless.sensors import grade as named_grade
from gapless.simulate import Receiver, simulate
from gapless.systems.build import settings
from gapless.systems.library import load
from gapless.systems.recipe import Clock, Mounting, System
from gapless.trip.events import ImuBlock
from gapless.trip.recording import Recording

Array = np.ndarray
PARTS = {"position": slice(0, 3), "velocity": slice(3, 6), "attitude": slice(6, 9)}
RECEIVER = Receiver(position_correlated=(0.0, 0.0, 0.0), position_white=(1.0, 1.0, 2.0))
EPOCHS = 30.0
"""Seconds between the epochs of one drive that are looked at."""
FIRST, LENGTH, OUTAGES = 120.0, 60.0, 10
"""Outages of a drive [s]: each is flown by a fork, so the drive itself loses nothing."""


@dataclass
class Drive:
    """What one drive showed; rows are epochs, the first of them the end of alignment."""

    error: Array
    covariance: Array
    nis: dict[str, Array] = field(default_factory=dict)
    outage_error: Array = field(default_factory=lambda: np.zeros((0, 2)))
    outage_covariance: Array = field(default_factory=lambda: np.zeros((0, 2, 2)))


def system(grade: str, constraints: bool = False) -> System:
    """A recipe that takes the receiver at its word and has nothing to decide."""
    base = load("constraints" if constraints else "ins")
    gnss = replace(
        base.gnss,
        wander=0.0,
        position_floor=0.0,
        velocity_floor=0.0,
        position_correlation=0.0,
        velocity_correlation=0.0,
        jitter=0.0,
    )
    return replace(
        base,
        imu=replace(base.imu, grade=grade),
        gnss=gnss,
        clock=Clock(0.0, 0.0, 0.0),
        mounting=Mounting(0.0, 0.0, 1.0, 1.0),
        nonholonomic=replace(base.nonholonomic, axle=0.0),
    )


def error(navigator: Navigator, truth: Recording) -> Array:
    """The dx of truth = estimate (+) dx: position [m], velocity [m/s], rotation vector in NED [rad]."""
    reference, x = truth.reference, navigator.belief.estimate()
    assert reference is not None
    k = int(np.argmin(np.abs(reference.time - navigator.time)))
    assert abs(reference.time[k] - navigator.time) < 1e-6
    q = attitude.multiply(attitude.from_euler(reference.euler[k]), x[6:10] * [1.0, -1.0, -1.0, -1.0])
    place = earth.lla_to_ned(reference.lla[k], x[:3])
    return np.concatenate([place, reference.v_n[k] - x[3:6], 2.0 * q[1:] * np.sign(q[0])])


def until(navigator: Navigator, log: Recording, start: float, end: float) -> None:
    """Everything that arrives in (start, end], readings of both ends' instants with their samples."""
    for event in events(log, {}, start + 5e-3, end + 5e-3):
        navigator.step(event)


def epochs(navigator: Navigator, log: Recording) -> Iterator[float]:
    """Drive on from second to second: yields the end of alignment, then every `EPOCHS`."""
    aligned, before = False, -np.inf
    for now in np.arange(1.0, np.floor(log.imu.time[-1]) + 1.0):
        until(navigator, log, before, now)
        before = now
        if navigator.aligned and (not aligned or now % EPOCHS == 0.0):
            aligned = True
            yield float(now)


def drive(seed: int, grade: str | Grade, duration: float, recipe: System, outages: bool = False) -> Drive:
    """Simulate, navigate, and compare with the truth."""
    log = simulate("urban", grade, duration, seed, receiver=RECEIVER)
    navigator = Navigator(settings(recipe, log, {}, (np.zeros(2), np.radians([1.0, 1.0]))))
    errors, covariances, ends = [], [], []
    askew = named_grade(grade).misalignment_sd if isinstance(grade, str) else grade.misalignment_sd
    for now in epochs(navigator, log):
        errors.append(error(navigator, log))
        # the filter's attitude is that of the sensitive axes, the truth's that of the box
        box = np.diag(np.repeat([0.0, 0.5 * askew**2], [6, 3]))
        covariances.append(navigator.belief.P[:9, :9] + box)
        if outages and now >= FIRST and (now - FIRST) % LENGTH == 0.0 and len(ends) < OUTAGES:
            ends.append(outage(navigator, log, now))
    result = Drive(np.array(errors), np.array(covariances))
    result.nis = {name: i.nis for name, i in navigator.journal.innovations().items()}
    if ends:
        result.outage_error, result.outage_covariance = (np.array(c) for c in zip(*ends, strict=True))
    return result


def outage(navigator: Navigator, log: Recording, now: float) -> tuple[Array, Array]:
    """Horizontal error and covariance at the end of an outage that a fork drives through."""
    fork = navigator.fork()
    for event in events(log, {}, now + 5e-3, now + LENGTH + 5e-3):
        if isinstance(event, ImuBlock):
            fork.step(event)
    return error(fork, log)[:2], fork.belief.P[:2, :2].copy()


def lines(drives: list[Drive]) -> Iterator[str]:
    """The figures of many drives of one kind."""
    count, n = len(drives), min(len(d.error) for d in drives)
    yield f"{count} drives; averages over them have their 95 % band in brackets"
    for name, part in PARTS.items():
        each = np.array([nees(d.error[:n, part], d.covariance[:n, part, part]) for d in drives])
        low, high = (chi_square_quantile(p, 3 * count) / count for p in (0.025, 0.975))
        mean = each.mean(axis=0)
        outside = int(np.sum((mean[1:] < low) | (mean[1:] > high)))
        yield (
            f"NEES {name:9} at alignment {mean[0]:.2f}, then {mean[1:].mean():.2f} on average, "
            f"{outside} of {n - 1} epochs outside [{low:.2f}, {high:.2f}]: "
            + " ".join(f"{m:.2f}" for m in mean[1:])
        )
    for name in sorted({name for d in drives for name in d.nis}):
        values = np.concatenate([d.nis[name] for d in drives if name in d.nis])
        dof = {"nonholonomic": 2, "zero_velocity": 6, "odometer": 1}.get(name, 3)
        c = consistency(values, dof)
        yield f"NIS {name:10} {c.mean:.3f} of {dof}, [{c.lower:.3f}, {c.upper:.3f}], {c.count} readings"
    ends = np.concatenate([d.outage_error for d in drives])
    if len(ends):
        value = nees(ends, np.concatenate([d.outage_covariance for d in drives]))
        inside = float(np.mean(value < chi_square_quantile(0.95, 2)))
        far = float(np.sqrt(np.mean(np.sum(ends**2, axis=1))))
        yield f"{len(ends)} outages of {LENGTH:g} s, {100.0 * inside:.1f} % end in their 95 % ellipse;"
        yield f"  NEES {value.mean():.2f} of 2, horizontal error at the end {far:.1f} m RMS"


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--grade", default="consumer")
    parser.add_argument("--drives", type=int, default=50)
    parser.add_argument("--first", type=int, default=1, help="seed of the first drive")
    parser.add_argument("--constraints", action="store_true")
    chosen = parser.parse_args()
    duration = FIRST + LENGTH * OUTAGES + 15.0
    recipe = system(chosen.grade, chosen.constraints)
    one = partial(drive, grade=chosen.grade, duration=duration, recipe=recipe, outages=True)
    with ProcessPoolExecutor(2) as pool:
        drives = list(pool.map(one, range(chosen.first, chosen.first + chosen.drives)))
    print("\n".join(lines(drives)))


if __name__ == "__main__":
    main()
